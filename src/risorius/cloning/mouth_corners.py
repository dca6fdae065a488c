"""Places at the corners of the mouth, where several sheets of skin lie on one another.

Closest points jump between the sheets there. So places are compared by where they lie on the
skin as well: how far along it each lip's contact line is, and on which side of it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from risorius._check import FloatArray, IntArray
from risorius.cloning.polyline import line_trust
from risorius.cloning.subject import Subject
from risorius.mesh.core import TriMesh
from risorius.mesh.normals import vertex_normals
from risorius.spatial.triangles import closest_bary

__all__ = ["CornerPlaces", "MouthCorners"]

# The zone around each corner, and the larger one on the source, as shares of the mouth's width.
_ZONE, _SOURCE_ZONE = 0.16, 0.3
# What a millimetre along the skin counts for, compared with one in space.
_SKIN = 0.7
# What a unit of difference between the normals counts for [mm].
_TURN = 1.5
# Faces with the nearest middles that are compared, and query points at a time.
_CANDIDATES, _BLOCK = 96, 512


@dataclass(frozen=True, eq=False)
class CornerPlaces:
    """Places on source faces, as `risorius.spatial.ClosestPoints` has them.

    Parameters
    ----------
    face : (k,) int32
    bary : (k, 3) float64
    distance : (k,) float64
        [mm].
    positions : (k, 3) float64
        [mm].
    """

    face: IntArray
    bary: FloatArray
    distance: FloatArray
    positions: FloatArray


@dataclass(frozen=True, eq=False)
class MouthCorners:
    """Target vertices near the corners of the mouth, source faces near its own, their signatures.

    Parameters
    ----------
    vertices : (k,) int32
        Of the target's skin.
    faces : (f,) int32
        Of the source's skin.
    wanted : (k, 2) float64
        Signature of each vertex: half the distance to the upper line less that to the lower,
        and the distance to the nearer line, negative inside the mouth [mm, of the source].
    given : (v, 2) float64
        The same of every source vertex.
    """

    vertices: IntArray
    faces: IntArray
    wanted: FloatArray
    given: FloatArray

    @staticmethod
    def of(source: Subject, target: Subject) -> MouthCorners:
        """Find the zones; empty where either head's mouth is closed by skin."""
        nothing, none = np.zeros(0, np.int32), np.zeros((0, 2))
        if source.lips is None or target.lips is None:
            return MouthCorners(nothing, nothing, none, none)
        ours, theirs = source.lips.slit, target.lips.slit
        if line_trust((ours.upper, ours.lower), (theirs.upper, theirs.lower)) == 0.0:
            # The corners of a coarse source are larger than the zone.
            return MouthCorners(nothing, nothing, none, none)
        given, wanted = _signature(source), _signature(target)
        near = target.lips.to_corner < _ZONE * target.lips.width
        vertices = np.flatnonzero(near & np.isfinite(wanted).all(axis=1)).astype(np.int32)
        inner = (source.lips.to_corner < _SOURCE_ZONE * source.lips.width) & np.isfinite(given).all(
            axis=1
        )
        faces = np.flatnonzero(inner[source.mesh.faces].all(axis=1)).astype(np.int32)
        if not len(faces):
            vertices = nothing
        return MouthCorners(vertices, faces, wanted[vertices], given)

    def search(
        self, surface: TriMesh, points: FloatArray, normals: FloatArray
    ) -> tuple[IntArray, CornerPlaces]:
        """Return the vertices and their places for target `points` (n, 3) on a moved source."""
        queries, facing = points[self.vertices], normals[self.vertices]
        turns = vertex_normals(surface.positions, surface.faces)[surface.faces[self.faces]]
        faces = surface.faces[self.faces]
        corners, marks = surface.positions[faces], self.given[faces]
        best = np.zeros(len(queries), np.int32)
        bary = np.zeros((len(queries), 3))
        distance, places = np.zeros(len(queries)), np.zeros((len(queries), 3))
        f = min(_CANDIDATES, len(self.faces))
        tree = cKDTree(corners.mean(axis=1)) if f else None
        for start in range(0, len(queries), _BLOCK):
            rows = np.arange(start, min(start + _BLOCK, len(queries)))
            assert tree is not None
            near = np.asarray(tree.query(queries[rows], k=f)[1]).reshape(len(rows), f)
            shares = closest_bary(
                np.repeat(queries[rows], f, axis=0), corners[near].reshape(-1, 3, 3)
            ).reshape(len(rows), f, 3)
            there = np.einsum("qfc,qfcj->qfj", shares, corners[near])
            apart = np.linalg.norm(there - queries[rows, None], axis=2)
            mark = np.einsum("qfc,qfcj->qfj", shares, marks[near])
            astray = np.linalg.norm(mark - self.wanted[rows, None], axis=2)
            turn = np.einsum("qfc,qfcj->qfj", shares, turns[near]) - facing[rows, None]
            turned = np.linalg.norm(turn, axis=2)
            cost = apart**2 + (_SKIN * astray) ** 2 + (_TURN * turned) ** 2
            chosen = cost.argmin(axis=1)
            at = (np.arange(len(rows)), chosen)
            best[rows], bary[rows] = near[at], shares[at]
            distance[rows], places[rows] = apart[at], there[at]
        face = self.faces[best] if f else best
        return self.vertices, CornerPlaces(face, bary, distance, places)


def _signature(subject: Subject) -> FloatArray:
    assert subject.lips is not None
    to_upper, to_lower = subject.to_lines.T
    nearer = np.minimum(to_upper, to_lower)
    with np.errstate(invalid="ignore"):
        across = 0.5 * (to_upper - to_lower)
    return np.stack([across, np.where(subject.cavity == 1, -nearer, nearer)], axis=1)
