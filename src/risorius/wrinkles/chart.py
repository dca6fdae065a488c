"""The texture coordinates of a skin: which tile, where, and how tangents lie on it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from risorius._check import BoolArray, FloatArray, IntArray
from risorius.errors import MeshError
from risorius.head.part import Part
from risorius.mesh.normals import face_areas, vertex_normals
from risorius.rig.rig import Rig
from risorius.wrinkles.refine import Patch

__all__ = ["Chart", "chart_of", "source_triangles"]


@dataclass(frozen=True, eq=False)
class Chart:
    """Texture coordinates of the faces of a welded skin.

    Parameters
    ----------
    uvs : (m, 3, 2) float64
        Of the corners of each face, moved to the tile 0..1; v runs upwards.
    tile : (2,) tuple of int
        The tile of a larger texture space that the maps are for, (0, 0) mostly.
    inside : (m,) bool
        Faces that have coordinates and lie on this tile.
    tangent, bitangent : (m, 3, 3) float64
        Unit directions of u and v at the corners, as engines take them for normal maps.
    """

    uvs: FloatArray
    tile: tuple[int, int]
    inside: BoolArray
    tangent: FloatArray
    bitangent: FloatArray

    def places(self, patch: Patch, size: int) -> FloatArray:
        """Return (column, row) of the corners (m, 3, 2) of a patch on a texture of `size`."""
        placed = np.einsum("mck,mkd->mcd", patch.corner_shares, self.uvs[patch.coarse_face])
        return np.stack([placed[..., 0] * size, (1.0 - placed[..., 1]) * size], axis=-1)

    def slopes(self, patch: Patch, slope: FloatArray) -> FloatArray:
        """Return gradients (v, 3) along u and v at the corners (m, 3, 2) of a patch."""
        corners = slope[patch.mesh.faces]
        axes = np.stack([self.tangent, self.bitangent], axis=2)[patch.coarse_face]
        local = np.einsum("mck,mkad->mcad", patch.corner_shares, axes)
        return np.einsum("mcad,mcd->mca", local, corners)


def chart_of(rig: Rig, skin: Part, wanted: BoolArray) -> Chart:
    """Return the texture coordinates of a rig's skin.

    Parameters
    ----------
    rig : Rig
    skin : Part
        Its welded skin.
    wanted : (m,) bool
        Faces that are to be shown; where they spread over several tiles (UDIM), the one with
        most of their area is taken.

    Raises
    ------
    MeshError
        If the skin has no texture coordinates.
    """
    faces = skin.mesh.faces
    uvs, known = _of_faces(rig, skin)
    if not known.any():
        raise MeshError(
            "wrinkles: the skin has no texture coordinates, and normal maps lie on them; unwrap "
            "the head first"
        )
    cells = np.floor(uvs.mean(axis=1)).astype(np.int64)
    areas = face_areas(skin.mesh.positions, faces) * (known & wanted)
    distinct, place = np.unique(cells, axis=0, return_inverse=True)
    largest = int(np.bincount(place.ravel(), areas).argmax())
    tile = (int(distinct[largest, 0]), int(distinct[largest, 1]))
    uvs = uvs - np.array(tile, np.float64)
    inside = known & (place.ravel() == largest)
    tangent, bitangent = _tangents(skin, uvs, inside)
    return Chart(uvs, tile, inside, tangent, bitangent)


def source_triangles(rig: Rig, skin: Part) -> IntArray:
    """Return the triangle of the rig's mesh that each face (m,) of the skin is, -1 if none."""
    mesh, faces = rig.mesh, skin.mesh.faces
    welded = skin.from_source(mesh.triangles, vertex_count=mesh.vertex_count)
    usable = np.flatnonzero((welded >= 0).all(axis=1))
    # The same three vertices, perhaps in another order.
    row = _rows(np.sort(welded[usable], axis=1), np.sort(faces, axis=1))
    return np.where(row >= 0, usable[row], -1).astype(np.int32)


def _of_faces(rig: Rig, skin: Part) -> tuple[FloatArray, BoolArray]:
    """Return the coordinates (m, 3, 2) of the welded skin's faces, and which faces have any."""
    mesh, faces = rig.mesh, skin.mesh.faces
    uvs = np.zeros((len(faces), 3, 2))
    if not len(mesh.uv_corners):
        return uvs, np.zeros(len(faces), bool)
    source = source_triangles(rig, skin)
    corners = mesh.uv_corners[mesh.triangle_corners[source]]
    known: BoolArray = (source >= 0) & np.asarray(np.all(corners >= 0, axis=1))
    welded = skin.from_source(mesh.triangles[source[known]], vertex_count=mesh.vertex_count)
    order = (welded[:, None, :] == faces[known][:, :, None]).argmax(axis=2)
    uvs[known] = mesh.uvs[np.take_along_axis(corners[known], order, axis=1)]
    return uvs, known


def _rows(table: IntArray, wanted: IntArray) -> IntArray:
    """Return the row of `table` (t, 3) that equals each of `wanted` (m, 3), -1 without one."""
    both = np.concatenate([table, wanted])
    number = np.unique(both, axis=0, return_inverse=True)[1].ravel()
    row = np.full(int(number.max(initial=-1)) + 1, -1, np.int64)
    row[number[: len(table)][::-1]] = np.arange(len(table))[::-1]
    return row[number[len(table) :]].astype(np.int32)


def _tangents(skin: Part, uvs: FloatArray, inside: BoolArray) -> tuple[FloatArray, FloatArray]:
    points, faces = skin.mesh.positions, skin.mesh.faces
    normals = vertex_normals(points, faces)
    first, second = (points[faces[:, k]] - points[faces[:, 0]] for k in (1, 2))
    du, dv = uvs[:, 1] - uvs[:, 0], uvs[:, 2] - uvs[:, 0]
    area = du[:, 0] * dv[:, 1] - du[:, 1] * dv[:, 0]
    turn = np.where(area < 0.0, -1.0, 1.0)
    along = turn[:, None] * (first * dv[:, 1:] - second * du[:, 1:])
    along[~inside | (area == 0.0)] = 0.0
    # Averaged over the corners that share vertex, coordinates and orientation, as engines do.
    key = np.concatenate(
        [
            faces.reshape(-1, 1).astype(np.float64),
            np.round(uvs.reshape(-1, 2), 9),
            np.repeat(turn, 3)[:, None],
        ],
        axis=1,
    )
    group = np.unique(key, axis=0, return_inverse=True)[1].ravel()
    total = np.zeros((int(group.max(initial=-1)) + 1, 3))
    np.add.at(total, group, np.repeat(along, 3, axis=0))
    tangent = total[group].reshape(-1, 3, 3)
    normal = normals[faces]
    tangent -= np.einsum("mcd,mcd->mc", tangent, normal)[..., None] * normal
    tangent /= np.maximum(np.linalg.norm(tangent, axis=2, keepdims=True), 1e-12)
    across = np.cross(normal, tangent).astype(np.float64)
    bitangent = turn[:, None, None] * across
    return tangent, bitangent
