"""The parts of a rig as separate polygon meshes, as USD wants them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from risorius._check import FloatArray
from risorius.io.rig_parts import RigNormals, longer_than, polygon_parts
from risorius.io.triangulate import triangulate
from risorius.rig.rig import MorphTarget, Rig

__all__ = ["PartMesh", "PartShape", "part_meshes"]

LongArray = npt.NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class PartShape:
    """What a target does to one part.

    Parameters
    ----------
    name : str
    vertices : (k,) int64
        Vertices of the part that move or whose normal turns.
    deltas, normal_deltas : (k, 3) float64
    """

    name: str
    vertices: LongArray
    deltas: FloatArray
    normal_deltas: FloatArray


@dataclass(frozen=True, eq=False)
class PartMesh:
    """One part with its own vertices.

    Parameters
    ----------
    name, material : str
        The material that most polygons carry, maybe empty.
    positions, normals : (v, 3) float64
    sizes : (m,) int64
        Corners per polygon, at least 3.
    corners : (c,) int64
    uvs : (k, 2) float64
        Empty without texture coordinates.
    uv_corners : (c,) int64
    shapes : tuple of PartShape
        Only those that move this part.
    """

    name: str
    material: str
    positions: FloatArray
    normals: FloatArray
    sizes: LongArray
    corners: LongArray
    uvs: FloatArray
    uv_corners: LongArray
    shapes: tuple[PartShape, ...]


def part_meshes(rig: Rig) -> list[PartMesh]:
    """Return the parts of a rig that have polygons, in the order of their names."""
    mesh = rig.mesh
    names, part = polygon_parts(rig)
    normals = RigNormals(rig, part, triangulate(mesh))
    sizes = np.diff(mesh.offsets).astype(np.int64)
    part = np.where(sizes >= 3, part, -1)
    corner_part = np.repeat(part, sizes)
    drafts: list[tuple[int, LongArray, LongArray, LongArray]] = []
    for index in np.unique(part[part >= 0]).tolist():
        chosen = np.flatnonzero(corner_part == index)
        vertices, first, corners = np.unique(
            mesh.corners[chosen], return_index=True, return_inverse=True
        )
        drafts.append((index, vertices.astype(np.int64), corners, chosen[first]))
    shapes: dict[int, list[PartShape]] = {index: [] for index, *_ in drafts}
    dense = np.zeros((mesh.vertex_count, 3))
    for target in rig.targets:
        dense[target.vertices] = target.deltas
        turned = normals.turned(target)
        for index, vertices, _, first in drafts:
            shape = _shape(target, dense[vertices], turned[normals.of_corner[first]])
            if shape is not None:
                shapes[index].append(shape)
        dense[target.vertices] = 0.0
    return [
        PartMesh(
            names[index],
            _material(rig, part == index),
            mesh.positions[vertices],
            normals.rest[normals.of_corner[first]],
            sizes[part == index],
            corners,
            *_uvs(rig, corner_part == index),
            tuple(shapes[index]),
        )
        for index, vertices, corners, first in drafts
    ]


def _shape(target: MorphTarget, deltas: FloatArray, turned: FloatArray) -> PartShape | None:
    if not longer_than(0.0, deltas).any():
        return None
    rows = np.flatnonzero(longer_than(0.0, deltas) | longer_than(0.0, turned))
    return PartShape(target.name, rows, deltas[rows], turned[rows])


def _material(rig: Rig, polygons: npt.NDArray[np.bool_]) -> str:
    materials = rig.mesh.materials
    if not len(materials.of_polygon):
        return ""
    carried = materials.of_polygon[polygons]
    carried = carried[carried >= 0]
    return materials.names[int(np.bincount(carried).argmax())] if len(carried) else ""


def _uvs(rig: Rig, corners: npt.NDArray[np.bool_]) -> tuple[FloatArray, LongArray]:
    """Return texture coordinates without unused ones; corners that have none share (0, 0)."""
    mesh = rig.mesh
    if not len(mesh.uv_corners) or (mesh.uv_corners[corners] < 0).all():
        return np.zeros((0, 2)), np.zeros(0, np.int64)
    used, place = np.unique(mesh.uv_corners[corners], return_inverse=True)
    return np.where((used >= 0)[:, None], mesh.uvs[used], 0.0), place.astype(np.int64)
