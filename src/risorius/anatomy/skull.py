"""The skull that muscles are drawn on: cranium, mandible and the arches of the teeth."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from importlib.resources import as_file, files
from pathlib import Path

import numpy as np

from risorius import _formats
from risorius._check import BoolArray, FloatArray, IntArray
from risorius.anatomy.bone_landmarks import read_bone_landmarks
from risorius.anatomy.template import builtin_head
from risorius.errors import LandmarkError, MeshError
from risorius.head.head import Head
from risorius.landmarks.landmark_set import LandmarkSet, resolve
from risorius.mesh.core import TriMesh
from risorius.mesh.polygon_mesh import PolygonMesh
from risorius.spatial.hull import convex_hull
from risorius.warp.rbf import RbfWarp
from risorius.warp.similarity import Similarity, fit_similarity

__all__ = ["Skull", "builtin_skull", "dental_arches", "load_skull"]

# Fewest bone landmarks that place a foreign skull.
_FEWEST = 6
# How far its landmarks may lie from the map's, as share of their spread, and below which share of
# that misfit their mirror image is taken for what was meant.
_STRANGE, _MIRRORED = 0.4, 0.6


@dataclass(frozen=True, eq=False)
class Skull:
    """A skull in the canonical frame of the built-in head.

    Parameters
    ----------
    cranium, mandible : TriMesh
    arches : tuple of TriMesh
        Convex hulls of the upper and of the lower teeth; they support lips and cheeks.
    carry : RbfWarp or None
        From the skull that the muscle map was drawn on to this one; None where it is that one.
    """

    cranium: TriMesh
    mandible: TriMesh
    arches: tuple[TriMesh, ...]
    carry: RbfWarp | None = None

    @property
    def surfaces(self) -> dict[str, tuple[TriMesh, ...]]:
        """Meshes that a muscle map knows by name; each arch belongs to its bone."""
        upper, lower = (self.arches[:1], self.arches[1:])
        return {"cranium": (self.cranium, *upper), "mandible": (self.mandible, *lower)}


def dental_arches(head: Head) -> tuple[TriMesh, ...]:
    """Return the convex hulls of the upper and lower teeth, those that `head` has."""
    kinds = ("teeth_upper", "teeth_lower")
    return tuple(
        convex_hull(head.parts[kind].mesh.positions).mesh for kind in kinds if kind in head.parts
    )


@cache
def builtin_skull() -> Skull:
    """Return the skull that ships with risorius, in the built-in head's canonical frame."""
    folder = files("risorius.anatomy").joinpath("assets")
    with as_file(folder) as path:
        mesh, _ = _formats.read_head(path / "skull.obj")
    head = builtin_head()
    # Skull and head are modelled in one space; the head's frame moves it to the eyes.
    bones = [_moved(part, head) for part in _bones(mesh)]
    return Skull(bones[0], bones[1], dental_arches(head))


def load_skull(
    paths: tuple[Path, ...], landmarks: Path, *, marks: Mapping[str, FloatArray]
) -> Skull:
    """Read a skull and place it in the built-in head's frame by its bone landmarks.

    Parameters
    ----------
    paths : tuple of Path
        One file with cranium and mandible, or one file each, in this order.
    landmarks : Path
        Its bone landmarks; see `read_bone_landmarks`.
    marks : mapping of str to (3,) float64
        Bone landmarks of the skull that the muscle map was drawn on, in its space [mm].

    Raises
    ------
    FormatError
        If a file is missing or malformed.
    LandmarkError
        If fewer than six bone landmarks are shared with the map, their left and right are
        exchanged, or they do not lie like those of a skull.
    MeshError
        If one file does not hold two bones.
    """
    meshes = [_formats.read_head(path)[0] for path in paths]
    joined = _joined(meshes)
    own = resolve(read_bone_landmarks(landmarks, meshes), joined)
    bones = _bones(joined) if len(meshes) == 1 else _split(joined, meshes)
    source, target = _shared(own, marks, landmarks)
    place = _placed(source, target, landmarks)
    bones = [TriMesh(place.apply(bone.positions), bone.faces) for bone in bones]
    head = builtin_head()
    carry = RbfWarp.fit(
        head.frame.to_canonical(target), head.frame.to_canonical(place.apply(source))
    )
    bones = [_moved(bone, head) for bone in bones]
    return Skull(bones[0], bones[1], dental_arches(head), carry)


def _shared(
    own: LandmarkSet, marks: Mapping[str, FloatArray], path: Path
) -> tuple[FloatArray, FloatArray]:
    names = [name for name in marks if name in own]
    if len(names) < _FEWEST:
        missing = [name for name in marks if name not in own]
        raise LandmarkError(
            f"{path}: shares {len(names)} bone landmarks with the muscle map, {_FEWEST} are "
            f"needed; add some of {', '.join(missing[:12])}"
        )
    return own.positions(names), np.array([marks[name] for name in names])


def _placed(source: FloatArray, target: FloatArray, path: Path) -> Similarity:
    """Return the similarity from the skull's landmarks (k, 3) to those of the map (k, 3)."""
    size = float(np.linalg.norm(target - target.mean(axis=0), axis=1).max())
    place = fit_similarity(source, target)
    off = _misfit(place, source, target)
    mirrored = source * [-1.0, 1.0, 1.0]
    if _misfit(fit_similarity(mirrored, target), mirrored, target) < _MIRRORED * off:
        raise LandmarkError(
            f"{path}: left and right bone landmarks are exchanged (the sides are the character's "
            "own); exchange _l and _r in the file"
        )
    if off > _STRANGE * size:
        raise LandmarkError(
            f"{path}: bone landmarks lie {off / size:.0%} of the skull's size from where those of "
            f"a skull lie, {_STRANGE:.0%} are allowed; check that names, vertices and the mesh "
            "belong together"
        )
    return place


def _misfit(place: Similarity, source: FloatArray, target: FloatArray) -> float:
    """Return the root mean square distance of placed landmarks from their targets [mm]."""
    return float(np.sqrt(((place.apply(source) - target) ** 2).sum(axis=1).mean()))


def _moved(mesh: TriMesh, head: Head) -> TriMesh:
    return TriMesh(head.frame.to_canonical(mesh.positions), mesh.faces)


def _joined(meshes: list[PolygonMesh]) -> PolygonMesh:
    if len(meshes) == 1:
        return meshes[0]
    shifts = np.cumsum([0] + [mesh.vertex_count for mesh in meshes])
    corners = [mesh.corners + shift for mesh, shift in zip(meshes, shifts)]
    starts = np.cumsum([0] + [len(mesh.corners) for mesh in meshes])
    offsets = [mesh.offsets[:-1] + start for mesh, start in zip(meshes, starts)]
    return PolygonMesh(
        np.concatenate([mesh.positions for mesh in meshes]),
        np.concatenate(corners).astype(np.int32),
        np.concatenate([*offsets, starts[-1:]]).astype(np.int32),
    )


def _split(joined: PolygonMesh, meshes: list[PolygonMesh]) -> list[TriMesh]:
    faces, limit = joined.triangles, meshes[0].vertex_count
    return [
        _compact(joined.positions, faces[(faces < limit).all(axis=1)]),
        _compact(joined.positions, faces[(faces >= limit).all(axis=1)]),
    ]


def _bones(mesh: PolygonMesh) -> list[TriMesh]:
    """Return cranium and mandible, by the names of their objects or groups."""
    for labels in (mesh.objects, mesh.groups):
        jaw = [n for n in labels.names if any(w in n.lower() for w in ("mandib", "jaw"))]
        rest = [n for n in labels.names if any(w in n.lower() for w in ("crani", "skull"))]
        if jaw and rest:
            return [
                _compact(mesh.positions, mesh.triangles[_named(mesh, labels.polygons(name[0]))])
                for name in (rest, jaw)
            ]
    raise MeshError(
        "skull: no objects or groups named like 'cranium' and 'mandible'; name them, or give two "
        "files, cranium first"
    )


def _named(mesh: PolygonMesh, polygons: IntArray) -> BoolArray:
    return np.isin(mesh.triangle_polygon, polygons)


def _compact(positions: FloatArray, faces: IntArray) -> TriMesh:
    used, local = np.unique(faces, return_inverse=True)
    return TriMesh(positions[used], local.reshape(-1, 3).astype(np.int32))
