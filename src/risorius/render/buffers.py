"""What each pixel sees: surface, face, depth and place on the face."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from risorius._check import FloatArray, IntArray
from risorius.render.bands import in_bands
from risorius.render.camera import Camera, picture_size
from risorius.render.kernels.raster import fill
from risorius.render.scene import Float32Array, Scene, gather
from risorius.render.surface import Surface

__all__ = ["Buffers", "buffers", "nearest", "transparent_layers"]

# Two layers closer than this share of their depth count as one.
_LAYER_GAP = 1e-6
_NO_BOUND: Float32Array = np.zeros((1, 1), np.float32)


@dataclass(frozen=True, eq=False)
class Buffers:
    """The nearest surface at the centre of each pixel.

    Parameters
    ----------
    depth : (h, w) float64
        Depth along the view [mm], infinite where nothing is seen.
    surface, face : (h, w) int32
        Index of the surface and of its face, -1 where nothing is seen.
    bary : (h, w, 3) float64
        Place on the face, zero where nothing is seen.
    """

    depth: FloatArray
    surface: IntArray
    face: IntArray
    bary: FloatArray


def buffers(surfaces: Sequence[Surface], camera: Camera, size: tuple[int, int]) -> Buffers:
    """Return what each pixel of a picture of `size` = (width, height) sees.

    Opacity plays no part: a transparent surface hides what is behind it.
    """
    scene = gather(surfaces, camera, picture_size(size))
    _, found = nearest(scene, 0, scene.face_count)
    seen = found >= 0
    row, column = np.nonzero(seen)
    height, width = found.shape
    sample = np.stack(
        [column - (0.5 * width - 0.5), row - (0.5 * height - 0.5), np.ones(len(row))], axis=1
    )
    hit = found[seen]
    shares = np.einsum("pck,pk->pc", scene.edges[hit].reshape(-1, 3, 3), sample)
    whole = shares.sum(axis=1)

    depth = np.full(found.shape, np.inf)
    depth[seen] = scene.volume[hit] / whole
    bary = np.zeros((*found.shape, 3))
    bary[seen] = shares / whole[:, None]
    surface, face = np.full_like(found, -1), np.full_like(found, -1)
    own = scene.face_surface[hit]
    surface[seen] = scene.order[own]
    face[seen] = hit - scene.first_face[own]
    return Buffers(depth, surface, face, bary)


def nearest(scene: Scene, first: int, last: int) -> tuple[Float32Array, IntArray]:
    """Return inverse depth and index of the nearest of the faces first..last - 1, (h, w)."""
    width, height = scene.size
    inverse_depth = np.zeros((height, width), np.float32)
    face = np.full((height, width), -1, np.int32)
    limit = np.full((1, 1), 1.0 / scene.near, np.float32)
    in_bands(
        fill,
        range(height),
        *(first, last, scene.edges, scene.volume, scene.box),
        *(limit, _NO_BOUND, False, inverse_depth, face),
    )
    return inverse_depth, face


def transparent_layers(scene: Scene, behind: Float32Array, count: int) -> tuple[IntArray, range]:
    """Return up to `count` transparent layers (k, h, w), nearest first, and the rows they fill.

    Each layer is the nearest one behind the layer before and in front of `behind` (depth
    peeling), so the order is right whatever the order of the triangles. Entries are faces or
    -1; a pixel may reach beyond the rows returned, so that they are -1 in others as well.
    """
    width, height = scene.size
    first, last = scene.opaque_face_count, scene.face_count
    rows = _rows_of(scene.box[first:last])
    layers: list[IntArray] = []
    ceiling = np.full((height, width), 1.0 / scene.near, np.float32)
    while len(rows) and len(layers) < count:
        inverse_depth = np.zeros((height, width), np.float32)
        face = np.full((height, width), -1, np.int32)
        in_bands(
            fill,
            rows,
            *(first, last, scene.edges, scene.volume, scene.box),
            *(ceiling, behind, True, inverse_depth, face),
        )
        filled = inverse_depth[rows.start : rows.stop]
        if not filled.any():
            break
        layers.append(face)
        ceiling = inverse_depth
        filled *= np.float32(1.0 - _LAYER_GAP)
    return np.stack(layers) if layers else np.zeros((0, height, width), np.int32), rows


def _rows_of(box: IntArray) -> range:
    shown = box[(box[:, 0] <= box[:, 1]) & (box[:, 2] <= box[:, 3])]
    return range(int(shown[:, 2].min()), int(shown[:, 3].max()) + 1) if len(shown) else range(0)
