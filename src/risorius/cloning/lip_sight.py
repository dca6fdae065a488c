"""The gap between the lips as one sees it from the front."""

from __future__ import annotations

import numpy as np

from risorius._check import FloatArray, IntArray
from risorius.head.head import Head
from risorius.mesh.core import TriMesh
from risorius.mesh.lips import LipSides
from risorius.spatial.raycast import Scene

__all__ = ["LIP_PLACES", "LipSight"]

LIP_PLACES = 0.5 - 0.5 * np.cos(np.pi * np.linspace(0.08, 0.92, 25))
"""(25,) where the gap is looked at, shares of the way between the corners, dense near them."""

# Skin around the lips that may stop lines of sight, how far above and below the middle of the
# contact lines they reach, and the step between them, as shares of the mouth's width.
_SKIN, _BAND, _STEP = 0.3, 0.08, 0.004


class LipSight:
    """Parallel lines of sight from the front, square to the line of the corners.

    Parameters
    ----------
    head : Head
    lips : LipSides
        Of this head.
    """

    def __init__(self, head: Head, lips: LipSides) -> None:
        mesh = head.skin.mesh
        self._rest, self._lips = mesh.positions, lips
        left, right = self._rest[list(lips.slit.corners)]
        across = (right - left) * [1.0, 1.0, 0.0]
        self._across = across / np.linalg.norm(across)
        up = np.cross([0.0, 0.0, 1.0], self._across)
        self.up: FloatArray = up if up[1] > 0.0 else -up
        near = (lips.distance < _SKIN * lips.width)[mesh.faces].all(axis=1)
        seen = near & ~lips.inside[mesh.faces].all(axis=1)
        self._vertices, faces = np.unique(mesh.faces[seen], return_inverse=True)
        self._faces: IntArray = faces.reshape(-1, 3).astype(np.int32)
        self._far = 10.0 * lips.width
        self.resolution = _STEP * lips.width

    def gaps(self, moved: FloatArray) -> FloatArray:
        """Return the open height (25,) at each place, at most a sixth of the width [mm]."""
        points = self._rest + moved
        lines = (self._lips.slit.upper, self._lips.slit.lower)
        start, end = self._ends(points)
        aside = start + LIP_PLACES * (end - start)
        middle = np.zeros(len(LIP_PLACES))
        for line in lines:
            place = self.places(points, line)
            order = np.argsort(place, kind="stable")
            middle += 0.5 * np.interp(LIP_PLACES, place[order], (points[line] @ self.up)[order])
        width = self._lips.width
        steps = np.arange(-_BAND, _BAND + 0.5 * _STEP, _STEP) * width
        heights = middle[:, None] + steps
        origins = (
            aside[:, None, None] * self._across
            + heights[..., None] * self.up
            + np.array([0.0, 0.0, float(points[self._vertices, 2].max()) + self._far])
        ).reshape(-1, 3)
        towards = np.broadcast_to([0.0, 0.0, -1.0], origins.shape)
        hit = Scene([TriMesh(points[self._vertices], self._faces)]).cast(origins, towards).hit
        return self.resolution * (~hit).reshape(len(LIP_PLACES), -1).sum(axis=1)

    def places(self, points: FloatArray, line: IntArray) -> FloatArray:
        """Return where (k,) the vertices of a line lie between the corners, 0 left to 1 right."""
        start, end = self._ends(points)
        return (points[line] @ self._across - start) / (end - start)

    def _ends(self, points: FloatArray) -> FloatArray:
        return points[list(self._lips.slit.corners)] @ self._across
