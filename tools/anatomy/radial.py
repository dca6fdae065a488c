"""A star-shaped surface through given points: |p - centre| = r(direction)."""

from __future__ import annotations

import numpy as np
from numba import njit, prange

__all__ = ["CubicRbf", "StarSurface"]


@njit(parallel=True, cache=True)
def _cubic_kernel(queries, centres, weights, tail, out):
    for i in prange(queries.shape[0]):
        total = tail[0]
        for k in range(3):
            total += tail[k + 1] * queries[i, k]
        for j in range(centres.shape[0]):
            square = 0.0
            for k in range(3):
                square += (queries[i, k] - centres[j, k]) ** 2
            total += weights[j] * square * np.sqrt(square)
        out[i] = total


class CubicRbf:
    """Interpolant ``sum w_j |x - x_j|^3 + affine`` of scattered values.

    Parameters
    ----------
    centres : (n, 3) ndarray
    values : (n,) ndarray
    """

    def __init__(self, centres, values):
        n = len(centres)
        distance = np.linalg.norm(centres[:, None] - centres[None], axis=2)
        matrix = np.zeros((n + 4, n + 4))
        matrix[:n, :n] = distance**3 + 1e-4 * np.eye(n)
        matrix[:n, n] = 1.0
        matrix[:n, n + 1 :] = centres
        matrix[n:, :n] = matrix[:n, n:].T
        solution = np.linalg.solve(matrix, np.concatenate([values, np.zeros(4)]))
        self._centres = np.ascontiguousarray(centres)
        self._weights, self._tail = solution[:n].copy(), solution[n:].copy()

    def __call__(self, queries):
        """Return the values (q,) at `queries` (q, 3)."""
        out = np.empty(len(queries))
        _cubic_kernel(np.ascontiguousarray(queries), self._centres, self._weights, self._tail, out)
        return out


class StarSurface:
    """Radial surface through the rows of a table and their mirror images, with an inset.

    Parameters
    ----------
    centre : (3,) array_like
        A point on the midplane that sees the whole surface [mm].
    rows : (n, 4) array_like
        x, y, z of the surface for x >= 0 and the inset there [mm].
    """

    def __init__(self, centre, rows):
        self._centre = np.asarray(centre, float)
        rows = np.asarray(rows, float)
        mirrored = rows[rows[:, 0] > 1e-6] * [-1, 1, 1, 1]
        rows = np.vstack([rows, mirrored])
        offset = rows[:, :3] - self._centre
        radius = np.linalg.norm(offset, axis=1)
        direction = offset / radius[:, None]
        self._radius = CubicRbf(direction, radius)
        self._inset = CubicRbf(direction, rows[:, 3])

    def __call__(self, points, *, inset=False):
        """Return the radial excess of `points` (n, 3) over the surface or its inset [mm]."""
        offset = points - self._centre
        radius = np.linalg.norm(offset, axis=1) + 1e-9
        direction = offset / radius[:, None]
        surface = self._radius(direction)
        if inset:
            surface = surface - self._inset(direction)
        return radius - surface
