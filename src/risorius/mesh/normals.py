"""Normals and areas of faces and vertices.

Faces without area have no direction: their normal is zero and they add nothing to their
vertices. Vertices of no face get a zero normal. Nothing here returns NaN.
"""

from __future__ import annotations

from typing import Literal

import numpy as np
from scipy.sparse import csr_matrix

from risorius._check import BoolArray, FloatArray, IntArray, one_of

__all__ = [
    "NormalsOperator",
    "Weighting",
    "face_areas",
    "face_normals",
    "vertex_areas",
    "vertex_normals",
]

Weighting = Literal["angle", "area", "uniform"]
_WEIGHTINGS = ("angle", "area", "uniform")


def face_normals(positions: FloatArray, faces: IntArray) -> FloatArray:
    """Return the unit normals (m, 3) of `faces`; zero where a face has no area."""
    return _unit(_doubled(positions[faces]))


def face_areas(positions: FloatArray, faces: IntArray) -> FloatArray:
    """Return the areas (m,) of `faces` [mm^2]."""
    return 0.5 * np.linalg.norm(_doubled(positions[faces]), axis=1)


def vertex_areas(positions: FloatArray, faces: IntArray) -> FloatArray:
    """Return the area (n,) that each vertex stands for: a third of its faces [mm^2]."""
    third = np.repeat(face_areas(positions, faces) / 3.0, 3)
    return np.bincount(faces.ravel(), third, len(positions)).astype(np.float64, copy=False)


def vertex_normals(
    positions: FloatArray, faces: IntArray, *, weighting: Weighting = "angle"
) -> FloatArray:
    """Return the unit vertex normals (n, 3); zero where a vertex has no direction.

    n_v = normalise(sum_f w_vf n_f) over the faces around v, with w_vf the angle of f at v
    (``"angle"``), the area of f (``"area"``) or 1 (``"uniform"``).

    Parameters
    ----------
    positions : (n, 3) float64
        Vertices [mm].
    faces : (m, 3) int32
    weighting : {"angle", "area", "uniform"}
        Angles make the normal independent of how a surface is cut into triangles.

    Notes
    -----
    For many shapes of one mesh build a `NormalsOperator` once.

    References
    ----------
    Thuermer, Wuethrich 1998, "Computing vertex normals from polygonal facets" (angle);
    Fratarcangeli 2008, section 3.1 (uniform).
    """
    return NormalsOperator(faces, len(positions), weighting=weighting)(positions)


class NormalsOperator:
    """Vertex normals of many shapes of one mesh.

    Parameters
    ----------
    faces : (m, 3) int32
    vertex_count : int
    weighting : {"angle", "area", "uniform"}
        See `vertex_normals`.
    """

    def __init__(
        self, faces: IntArray, vertex_count: int, *, weighting: Weighting = "angle"
    ) -> None:
        self.faces = faces
        self.vertex_count = vertex_count
        self.weighting = one_of("weighting", weighting, _WEIGHTINGS)
        corners = faces.ravel()
        # Row v of the matrix lists the corners at v, so that data in corner order sum per vertex.
        order = np.argsort(corners, kind="stable").astype(np.int32)
        indptr = np.zeros(vertex_count + 1, np.int32)
        np.cumsum(np.bincount(corners, minlength=vertex_count), out=indptr[1:])
        self._order = order
        self._indptr = indptr
        self._face_of = order // 3

    def __call__(self, positions: FloatArray) -> FloatArray:
        """Return the unit normals (n, 3) of one shape, or (s, n, 3) of several."""
        if positions.ndim == 3:
            return np.stack([self(shape) for shape in positions]) if len(positions) else positions
        return _unit(self._sums(positions, self.faces, self._order, self._face_of, self._indptr))

    def update(
        self, normals: FloatArray, positions: FloatArray, moved: BoolArray | IntArray
    ) -> FloatArray:
        """Return the normals (n, 3) after only some vertices moved.

        Parameters
        ----------
        normals : (n, 3) float64
            Normals before the motion.
        positions : (n, 3) float64
            Vertices after the motion [mm].
        moved : (n,) bool or (k,) int32
            Mask or indices of all vertices that moved.

        Notes
        -----
        Equal, bit by bit, to the whole computation; cost is that of the faces around the moved
        vertices and their neighbours.
        """
        mask = np.zeros(self.vertex_count, bool)
        mask[moved] = True
        stale = np.zeros(self.vertex_count, bool)
        stale[self.faces[mask[self.faces].any(axis=1)]] = True
        rows = np.flatnonzero(stale)
        needed = np.flatnonzero(stale[self.faces].any(axis=1))
        place = np.zeros(len(self.faces), np.int32)
        place[needed] = np.arange(len(needed))
        counts = np.diff(self._indptr)[rows]
        indptr = np.concatenate([[0], np.cumsum(counts)]).astype(np.int32)
        inside = np.arange(int(indptr[-1])) - np.repeat(indptr[:-1], counts)
        chosen = np.repeat(self._indptr[:-1][rows], counts) + inside
        face_of = place[self._face_of[chosen]]
        order = 3 * face_of + self._order[chosen] % 3
        result = normals.copy()
        result[rows] = _unit(self._sums(positions, self.faces[needed], order, face_of, indptr))
        return result

    def _sums(
        self,
        positions: FloatArray,
        faces: IntArray,
        order: IntArray,
        face_of: IntArray,
        indptr: IntArray,
    ) -> FloatArray:
        corners = positions[faces]
        doubled = _doubled(corners)
        if self.weighting == "area":
            weights = np.ones(len(order))
        else:
            length = np.linalg.norm(doubled, axis=1)
            doubled = _unit(doubled)
            weights = (
                _angles(corners, length).ravel()[order]
                if self.weighting == "angle"
                else np.ones(len(order))
            )
        matrix = csr_matrix((weights, face_of, indptr), shape=(len(indptr) - 1, len(faces)))
        return matrix @ doubled


def _doubled(corners: FloatArray) -> FloatArray:
    """Return the face normals (m, 3) with twice the area as length."""
    first, second = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    result = np.empty_like(first)
    for axis in range(3):
        after, last = (axis + 1) % 3, (axis + 2) % 3
        result[:, axis] = first[:, after] * second[:, last] - first[:, last] * second[:, after]
    return result


def _angles(corners: FloatArray, doubled_area: FloatArray) -> FloatArray:
    """Return the angles (m, 3) at the corners [rad]."""
    sides = corners[:, [1, 2, 0]] - corners
    angles = np.empty((len(corners), 3))
    for corner in range(2):
        dot = -np.einsum("ij,ij->i", sides[:, corner], sides[:, corner - 1])
        angles[:, corner] = np.arctan2(doubled_area, dot)
    angles[:, 2] = np.maximum(np.pi - angles[:, 0] - angles[:, 1], 0.0)
    return angles


def _unit(vectors: FloatArray) -> FloatArray:
    # Scaling by the largest entry first keeps the squares of tiny and huge vectors in range.
    largest = np.abs(vectors).max(axis=1, initial=0.0, keepdims=True)
    scaled = vectors / np.where(largest > 0.0, largest, 1.0)
    length = np.sqrt(np.einsum("ij,ij->i", scaled, scaled))[:, None]
    return scaled / np.where(length > 0.0, length, 1.0)
