"""Split a rig into the primitives of a GLB: per part and material, vertices split at UV seams."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from risorius._check import FloatArray, IntArray
from risorius.io.rig_parts import RigNormals, polygon_parts
from risorius.io.triangulate import triangulate
from risorius.mesh.polygon_mesh import PolygonMesh
from risorius.rig.rig import Rig

__all__ = ["Primitive", "Split", "split"]

LongArray = npt.NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Primitive:
    """Vertices and triangles that share part and material.

    Parameters
    ----------
    part : str
    material : str
        Empty where the input names none.
    source : (v,) int64
        Input vertex of each vertex.
    normal : (v,) int64
        Row of the rig's normals of each vertex.
    uvs : (v, 2) float64 or None
        v upwards.
    triangles : (t, 3) int64
    """

    part: str
    material: str
    source: LongArray
    normal: LongArray
    uvs: FloatArray | None
    triangles: LongArray


@dataclass(frozen=True, eq=False)
class Split:
    """A rig as primitives.

    Parameters
    ----------
    primitives : tuple of Primitive
        Those of one part stand together.
    normals : RigNormals
    corners : (c,) int64
        Vertex of every corner of the input's polygons, counted through all primitives.
    """

    primitives: tuple[Primitive, ...]
    normals: RigNormals
    corners: LongArray


def split(rig: Rig) -> Split:
    """Return the primitives of a rig; vertices stand in the input's order inside each."""
    mesh = rig.mesh
    part_names, part = polygon_parts(rig)
    triangles = triangulate(mesh)
    normals = RigNormals(rig, part, triangles)
    material = _or_none(mesh.materials.of_polygon, mesh.polygon_count)
    material_count = len(mesh.materials.names) + 1
    kind = part.astype(np.int64) * material_count + material + 1
    corner_kind = np.repeat(kind, np.diff(mesh.offsets))
    uvs, corner_uv = _distinct_uvs(mesh)
    # One vertex per kind, input vertex and texture coordinate, in this order.
    table = (corner_kind * mesh.vertex_count + mesh.corners) * (len(uvs) + 1) + corner_uv + 1
    _, first, corners = np.unique(table, return_index=True, return_inverse=True)
    vertex_kind = corner_kind[first]
    triangle_kind = corner_kind[triangles[:, 0]]
    primitives: list[Primitive] = []
    for number in np.unique(corner_kind).tolist():
        vertices = np.flatnonzero(vertex_kind == number)
        chosen = first[vertices]
        own_uvs = corner_uv[chosen]
        material_index = number % material_count - 1
        own_triangles = corners[triangles[triangle_kind == number]] - vertices[0]
        primitives.append(
            Primitive(
                part_names[number // material_count],
                mesh.materials.names[material_index] if material_index >= 0 else "",
                mesh.corners[chosen].astype(np.int64),
                normals.of_corner[chosen],
                np.where((own_uvs >= 0)[:, None], uvs[own_uvs], 0.0)
                if (own_uvs >= 0).any()
                else None,
                # Polygons of two corners have none, but a primitive needs one.
                own_triangles if len(own_triangles) else np.zeros((1, 3), np.int64),
            )
        )
    return Split(tuple(primitives), normals, corners)


def _or_none(labels: IntArray, count: int) -> IntArray:
    return labels if len(labels) else np.full(count, -1, np.int32)


def _distinct_uvs(mesh: PolygonMesh) -> tuple[FloatArray, LongArray]:
    """Return texture coordinates without repetition, and the one of each corner or -1."""
    if not len(mesh.uv_corners):
        return np.zeros((0, 2)), np.full(len(mesh.corners), -1, np.int64)
    uvs, place = np.unique(mesh.uvs, axis=0, return_inverse=True)
    return uvs, np.where(mesh.uv_corners >= 0, place.ravel()[mesh.uv_corners], -1)
