"""Triangles that turn over, collapse or are stretched."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from risorius._check import BoolArray, FloatArray, IntArray
from risorius.mesh.connectivity import collapsed_faces, edge_faces
from risorius.mesh.core import TriMesh

__all__ = ["TriangleFaults", "TriangleTest"]

# Angle to the neighbours' mean normal beyond which a face is turned over, and up to which it may
# lean at rest to count as lying among them.
_TURNED, _LYING = np.cos(np.radians(120.0)), np.cos(np.radians(60.0))
_COLLAPSED = 0.01
_STRETCHED = 4.0
# Faces smaller than this share of the median face have no area to lose.
_TINY = 1e-3


@dataclass(frozen=True)
class TriangleFaults:
    """Bad triangles of one shape.

    Parameters
    ----------
    inverted : int
        Faces whose normal stands more than 120 degrees off the mean normal of their edge
        neighbours, and at rest less than 60: the comparison with the neighbours takes out the
        local rotation, so that a lid that turns as a whole is not counted.
    collapsed : int
        Faces with less than 1 % of their rest area (those that are tiny at rest are not judged).
    stretched : int
        Faces with an edge longer than 4 times its rest length and longer than the median edge.
    """

    inverted: int = 0
    collapsed: int = 0
    stretched: int = 0

    @property
    def any(self) -> bool:
        """Whether there is any fault."""
        return self.inverted + self.collapsed + self.stretched > 0


class TriangleTest:
    """The faces of one mesh, ready to be judged in many shapes.

    Parameters
    ----------
    mesh : TriMesh
        At rest; seams are welded so that faces know their neighbours.
    """

    def __init__(self, mesh: TriMesh) -> None:
        self.mesh = mesh
        table = edge_faces(mesh.faces)
        pairs = table.faces[table.face_edges]
        own = np.arange(mesh.face_count)[:, None]
        other = np.where(pairs[:, :, 0] == own, pairs[:, :, 1], pairs[:, :, 0])
        # Row -1 of the normals below is a zero: a border has no neighbour.
        other[table.face_edges < 0] = -1
        self._neighbours: IntArray = other.astype(np.int32)
        normals, self._area, self._edges = _shape_of(mesh.positions, mesh.faces)
        self._normals = np.concatenate([normals, np.zeros((1, 3))])
        lying = _among(self._normals, normals, self._neighbours) > _LYING
        sound = ~collapsed_faces(mesh.faces)
        median = float(np.median(self._area[sound])) if sound.any() else 0.0
        self._judged = sound & (self._area > _TINY * median)
        self._lying = lying & self._judged
        self._median_edge = float(np.median(self._edges[sound])) if sound.any() else 0.0

    def faults(self, deltas: FloatArray, groups: list[BoolArray]) -> list[TriangleFaults]:
        """Judge one shape.

        Parameters
        ----------
        deltas : (n, 3) float64
            Displacement of every vertex [unit of the mesh].
        groups : list of (m,) bool
            Sets of faces that are counted apart.
        """
        moving = (deltas != 0.0).any(axis=1)
        rows = np.flatnonzero(moving[self.mesh.faces].any(axis=1))
        if not len(rows):
            return [TriangleFaults() for _ in groups]
        posed = self.mesh.positions + deltas
        normals, area, edges = _shape_of(posed, self.mesh.faces[rows])
        table = self._normals.copy()
        table[rows] = normals
        turned = _among(table, normals, self._neighbours[rows]) < _TURNED
        collapsed = self._judged[rows] & (area < _COLLAPSED * self._area[rows])
        inverted = self._lying[rows] & turned & ~collapsed
        longer = (edges > _STRETCHED * self._edges[rows]) & (edges > self._median_edge)
        stretched = longer.any(axis=1)
        return [
            TriangleFaults(*(int((fault & group[rows]).sum()) for fault in kinds))
            for group in groups
            for kinds in [(inverted, collapsed, stretched)]
        ]


def _among(table: FloatArray, normals: FloatArray, neighbours: IntArray) -> FloatArray:
    """Return the cosine (k,) between normals and the mean of their neighbours in `table`."""
    mean = table[neighbours].sum(axis=1)
    length = np.linalg.norm(mean, axis=1)
    cosine = np.einsum("ij,ij->i", normals, mean)
    return np.where(length > 1e-9, cosine / np.maximum(length, 1e-9), 1.0)


def _shape_of(positions: FloatArray, faces: IntArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return unit normals (k, 3), areas (k,) and edge lengths (k, 3) of faces."""
    corners = positions[faces]
    sides = corners[:, [1, 2, 0]] - corners
    doubled = np.cross(sides[:, 0], sides[:, 1])
    length = np.linalg.norm(doubled, axis=1)
    normals = doubled / np.where(length > 0.0, length, 1.0)[:, None]
    return normals, 0.5 * length, np.linalg.norm(sides, axis=2)
