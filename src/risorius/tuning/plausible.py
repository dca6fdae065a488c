"""Faces that nobody wants to see: skin that turns over, creases or tears."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from risorius._check import FloatArray, IntArray
from risorius.head.head import Head
from risorius.mesh.connectivity import edge_faces

__all__ = ["Plausible"]

# A triangle has turned over when its normal has less than this cosine to where it was; two bend
# when the cosine between them is less by so much than at rest; skin tears when an edge grows by
# this factor and by this share of the skin's height.
_TURNED = 0.2
_BENT = 0.5
_TORN = 2.5
_LONG = 0.01
# Share of the skin in front that may be at fault beyond what the first face has.
_TOLERATED = 0.0005


@dataclass(frozen=True, eq=False)
class Plausible:
    """Judges faces of one head by the skin that is seen from the front.

    Parameters
    ----------
    vertices : (w,) int32
        Input vertex of each skin vertex.
    faces : (m, 3) int32
        Triangles of the skin that look to the front.
    pairs : (e, 2) int32
        Neighbours among these.
    ends : (e, 2) int32
        The edge between them.
    normals : (m, 3) float64
        At rest.
    area : (m,) float64
        Shares of the whole.
    bend : (e,) float64
        Cosine between neighbours at rest.
    length : (e,) float64
        Of the edges at rest [mm].
    long : float
        Growth that may tear [mm].
    allowed : float
        Greatest share of faulty skin.
    """

    vertices: IntArray
    faces: IntArray
    pairs: IntArray
    ends: IntArray
    normals: FloatArray
    area: FloatArray
    bend: FloatArray
    length: FloatArray
    long: float
    allowed: float = _TOLERATED

    @staticmethod
    def of(head: Head, first: FloatArray | None = None) -> Plausible:
        """Return the judge of a head.

        Parameters
        ----------
        head : Head
        first : (n, 3) float64, optional
            The face that tuning begins with; what it has of faults is allowed [mm].
        """
        mesh = head.skin.mesh
        normals, double = _normals(mesh.positions, mesh.faces)
        front = np.flatnonzero((normals[:, 2] > 0.0) & (double > 0.0))
        faces = mesh.faces[front]
        table = edge_faces(faces)
        inner = table.counts == 2
        pairs, ends = table.faces[inner], table.edges[inner]
        kept = normals[front]
        judge = Plausible(
            head.skin.first_source(),
            faces,
            pairs,
            ends,
            kept,
            double[front] / max(double[front].sum(), 1e-300),
            (kept[pairs[:, 0]] * kept[pairs[:, 1]]).sum(axis=1),
            _lengths(mesh.positions, ends),
            _LONG * float(np.ptp(mesh.positions[:, 1])),
        )
        if first is None:
            return judge
        return replace(judge, allowed=_TOLERATED + judge.faults(first))

    def faults(self, positions: FloatArray) -> float:
        """Return the share of the skin in front that is faulty with vertices (n, 3) [mm]."""
        placed = positions[self.vertices]
        normals, _ = _normals(placed, self.faces)
        faulty = (normals * self.normals).sum(axis=1) < _TURNED
        one, other = self.pairs.T
        bent = (normals[one] * normals[other]).sum(axis=1) < self.bend - _BENT
        length = _lengths(placed, self.ends)
        torn = (length > _TORN * self.length) & (length > self.length + self.long)
        for side in (one, other):
            faulty[side[bent | torn]] = True
        return float(self.area[faulty].sum())

    def __call__(self, positions: FloatArray) -> bool:
        """Return whether a face with vertices (n, 3) [mm] may be shown."""
        return self.faults(positions) <= self.allowed


def _normals(positions: FloatArray, faces: IntArray) -> tuple[FloatArray, FloatArray]:
    """Return unit normals (m, 3) and doubled areas (m,)."""
    a, b, c = (positions[faces[:, corner]] for corner in range(3))
    normals = np.cross(b - a, c - a)
    double = np.sqrt((normals * normals).sum(axis=1))
    return normals / np.maximum(double, 1e-300)[:, None], double


def _lengths(positions: FloatArray, ends: IntArray) -> FloatArray:
    apart = positions[ends[:, 0]] - positions[ends[:, 1]]
    return np.sqrt((apart * apart).sum(axis=1))
