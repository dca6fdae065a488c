"""Normal maps of wrinkles, and how weights drive them."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.ndimage import distance_transform_edt

from risorius._check import FloatArray
from risorius.anatomy.smooth_step import smooth_step
from risorius.errors import ParameterError
from risorius.rig.rig import Rig
from risorius.wrinkles.chart import Chart, chart_of
from risorius.wrinkles.kernels.paint import paint
from risorius.wrinkles.relief import Relief, Wrinkler

__all__ = [
    "DEFAULT_GROUPS",
    "WrinkleGroup",
    "WrinkleMap",
    "WrinkleSet",
    "parse_group",
    "wrinkle_maps",
]

Texture = npt.NDArray[np.uint8]
Progress = Callable[[int, int, str], None]

_NAME = re.compile(r"\w{1,60}")
_FLAT = (128, 128, 255)
# Texels beside the skin that repeat it, so that none of the flat ground is blended in.
_GUTTER = 6
# Width of the seam between the sides [mm].
_SEAM = 8.0
# More of a patch than this on texels that another part of it covers too is worth a note.
_OVERLAP = 0.05


@dataclass(frozen=True)
class WrinkleGroup:
    """Shapes that wrinkle the skin together.

    Parameters
    ----------
    name : str
    left, right : tuple of str
        Shapes whose weights drive the map on each side; those of the midline stand in both.
    """

    name: str
    left: tuple[str, ...]
    right: tuple[str, ...]

    @property
    def shapes(self) -> tuple[str, ...]:
        """All shapes, each once."""
        return tuple(dict.fromkeys((*self.left, *self.right)))

    @staticmethod
    def of(name: str, shapes: Iterable[str]) -> WrinkleGroup:
        """Return the group of ARKit-like names: ``Left`` and ``Right`` at the end tell the side."""
        listed = tuple(shapes)
        left = tuple(shape for shape in listed if not shape.endswith("Right"))
        right = tuple(shape for shape in listed if not shape.endswith("Left"))
        return WrinkleGroup(name, left, right)


def _both(*stems: str) -> tuple[str, ...]:
    return tuple(f"{stem}{side}" for stem in stems for side in ("Left", "Right"))


DEFAULT_GROUPS: tuple[WrinkleGroup, ...] = (
    WrinkleGroup.of("brow_up", ("browInnerUp", *_both("browOuterUp"))),
    WrinkleGroup.of("brow_down", _both("browDown")),
    WrinkleGroup.of("nose", _both("noseSneer")),
    WrinkleGroup.of("squint", _both("eyeSquint", "cheekSquint")),
    WrinkleGroup.of("smile", _both("mouthSmile")),
    WrinkleGroup.of("pucker", ("mouthPucker",)),
    WrinkleGroup.of("frown", _both("mouthFrown")),
    WrinkleGroup.of("chin", ("mouthShrugLower",)),
)
"""Groups of ARKit's shapes that wrinkle a face."""


def parse_group(text: str) -> WrinkleGroup:
    """Return the group that ``"name=A+B"`` describes.

    Raises
    ------
    ParameterError
        If it is malformed.
    """
    name, equals, rest = (part.strip() for part in text.partition("="))
    shapes = [shape.strip() for shape in rest.split("+")]
    if not equals or not _NAME.fullmatch(name) or not all(shapes):
        raise ParameterError(
            f"map: {text!r} is not of the form name=A+B, with a name of letters, digits and _"
        )
    if len(set(shapes)) < len(shapes):
        raise ParameterError(f"map: {text!r} names a shape twice")
    return WrinkleGroup.of(name, shapes)


@dataclass(frozen=True, eq=False)
class WrinkleMap:
    """One normal map.

    Parameters
    ----------
    group : WrinkleGroup
    relief : Relief
        What the map shows.
    normals : (s, s, 3) uint8
        Tangent-space normal map, +X right, +Y up (OpenGL and glTF); 128, 128, 255 is smooth.
    overlap : float
        Share of the painted texels that several places of the skin use [1].
    """

    group: WrinkleGroup
    relief: Relief
    normals: Texture
    overlap: float


@dataclass(frozen=True, eq=False)
class WrinkleSet:
    """All wrinkle maps of a rig.

    Parameters
    ----------
    wrinkler : Wrinkler
        What made the reliefs.
    maps : tuple of WrinkleMap
    side : (s, s) uint8
        255 on the character's left, 0 on the right, blended at the middle.
    tile : tuple of int
        Tile of the texture space that the maps cover.
    left_out : mapping of str to str
        Groups without a map, with the reason.
    """

    wrinkler: Wrinkler
    maps: tuple[WrinkleMap, ...]
    side: Texture
    tile: tuple[int, int]
    left_out: Mapping[str, str]

    @property
    def size(self) -> int:
        """Width and height of the maps in texels."""
        return len(self.side)


def wrinkle_maps(
    rig: Rig,
    groups: Sequence[WrinkleGroup] = DEFAULT_GROUPS,
    *,
    size: int = 2048,
    depth: float = 1.0,
    spacing: float = 1.0,
    progress: Progress | None = None,
) -> WrinkleSet:
    """Return normal maps of the wrinkles that the shapes of a rig press into its skin.

    Parameters
    ----------
    rig : Rig
        With landmarks and texture coordinates.
    groups : sequence of WrinkleGroup
        Those with shapes that the rig lacks are left out.
    size : int
        Width and height of each map, 64 to 8192 texels.
    depth, spacing : float
        Factors on the depth of wrinkles and on their distance.
    progress : callable, optional
        Called with (done, all, name) before each map.

    Raises
    ------
    LandmarkError
        If the rig has no landmarks, or its lids or lips are not found.
    MeshError
        If the skin has no texture coordinates.
    ParameterError
        If a number is out of range or two groups share a name.
    """
    if not 64 <= size <= 8192:
        raise ParameterError(f"size: {size} texels; give 64 to 8192")
    names = [group.name for group in groups]
    if len(set(names)) < len(names):
        raise ParameterError("wrinkles: two maps share a name")
    wrinkler = Wrinkler(rig)
    known = set(rig.names)
    left_out: dict[str, str] = {}
    reliefs: list[tuple[WrinkleGroup, Relief]] = []
    for done, group in enumerate(groups):
        if progress is not None:
            progress(done, len(groups), group.name)
        missing = [shape for shape in group.shapes if shape not in known]
        if missing:
            left_out[group.name] = f"the rig has no {', '.join(missing)}"
            continue
        weights = dict.fromkeys(group.shapes, 1.0)
        relief = wrinkler.relief(weights, depth=depth, spacing=spacing)
        if relief is None:
            left_out[group.name] = "it presses no skin together"
        else:
            reliefs.append((group, relief))
    wanted = np.zeros(wrinkler.skin.mesh.face_count, bool)
    for _, relief in reliefs:
        wanted[relief.patch.coarse_face] = True
    chart = chart_of(rig, wrinkler.skin, wanted)
    maps = tuple(_map(group, relief, chart, size) for group, relief in reliefs)
    return WrinkleSet(wrinkler, maps, _side(wrinkler, chart, size), chart.tile, left_out)


def _map(group: WrinkleGroup, relief: Relief, chart: Chart, size: int) -> WrinkleMap:
    patch = relief.patch
    shown = chart.inside[patch.coarse_face]
    image = np.zeros((size, size, 2))
    painted = np.zeros((size, size), np.int32)
    places = chart.places(patch, size)[shown]
    paint(places, chart.slopes(patch, relief.slope)[shown], image, painted)
    # Neighbours share the texels on their common side, so only the area tells an overlap.
    (ax, ay), (bx, by) = (places[:, k].T - places[:, 0].T for k in (1, 2))
    area = 0.5 * float(np.abs(ax * by - ay * bx).sum())
    covered = int((painted > 0).sum())
    overlap = max(1.0 - covered / area, 0.0) if area > 0.0 else 0.0
    image = _widened(image, painted > 0)
    normal = np.concatenate([-image, np.ones((size, size, 1))], axis=2)
    normal /= np.linalg.norm(normal, axis=2, keepdims=True)
    texture = np.rint(127.5 + 127.5 * normal).astype(np.uint8)
    flat = (image == 0.0).all(axis=2)
    texture[flat] = _FLAT
    return WrinkleMap(group, relief, texture, overlap if overlap > _OVERLAP else 0.0)


def _side(wrinkler: Wrinkler, chart: Chart, size: int) -> Texture:
    mesh = wrinkler.skin.mesh
    share = smooth_step(0.5 + mesh.positions[:, 0] / _SEAM)
    image = np.full((size, size, 1), 0.5)
    painted = np.zeros((size, size), np.int32)
    uvs = chart.uvs[chart.inside]
    places = np.stack([uvs[..., 0] * size, (1.0 - uvs[..., 1]) * size], axis=-1)
    paint(places, share[mesh.faces[chart.inside]][..., None], image, painted)
    return np.rint(255.0 * _widened(image, painted > 0)[..., 0]).astype(np.uint8)


def _widened(image: FloatArray, painted: npt.NDArray[np.bool_]) -> FloatArray:
    """Repeat the painted texels into a gutter beside them."""
    if not painted.any():
        return image
    distance, nearest = distance_transform_edt(~painted, return_indices=True)
    gutter = (distance > 0.0) & (distance <= _GUTTER)
    result = image.copy()
    result[gutter] = image[nearest[0][gutter], nearest[1][gutter]]
    return result
