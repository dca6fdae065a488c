"""Pairs of triangles of one mesh that pass through each other."""

from __future__ import annotations

import numpy as np
from numba import njit

__all__ = ["intersecting_pairs"]


@njit(cache=True)
def _segment_hits(p, q, a, b, c):
    """Whether the open segment p-q passes through the triangle a, b, c."""
    u, v = b - a, c - a
    normal = np.cross(u, v)
    side_p, side_q = np.dot(normal, p - a), np.dot(normal, q - a)
    if side_p * side_q >= 0.0:
        return False
    t = side_p / (side_p - side_q)
    point = p + t * (q - p)
    return (
        np.dot(np.cross(b - a, point - a), normal) > 0
        and np.dot(np.cross(c - b, point - b), normal) > 0
        and np.dot(np.cross(a - c, point - c), normal) > 0
    )


@njit(cache=True)
def _edges_hit(positions, f, g):
    for k in range(3):
        i, j = f[k], f[(k + 1) % 3]
        if i == g[0] or i == g[1] or i == g[2] or j == g[0] or j == g[1] or j == g[2]:
            continue
        a, b, c = positions[g[0]], positions[g[1]], positions[g[2]]
        if _segment_hits(positions[i], positions[j], a, b, c):
            return True
    return False


@njit(cache=True)
def _sweep(positions, faces, low, high, order, found):
    count = 0
    n = len(order)
    for i in range(n):
        a = order[i]
        for j in range(i + 1, n):
            b = order[j]
            if low[b, 0] > high[a, 0]:
                break
            if (
                low[b, 1] > high[a, 1]
                or low[a, 1] > high[b, 1]
                or low[b, 2] > high[a, 2]
                or low[a, 2] > high[b, 2]
            ):
                continue
            f, g = faces[a], faces[b]
            if _edges_hit(positions, f, g) or _edges_hit(positions, g, f):
                if count < len(found):
                    found[count, 0], found[count, 1] = a, b
                count += 1
    return count


def intersecting_pairs(positions, faces):
    """Return (k, 2) indices of triangles that cross, at most 10000 pairs."""
    corner = positions[faces]
    low, high = corner.min(axis=1), corner.max(axis=1)
    order = np.argsort(low[:, 0], kind="stable")
    found = np.zeros((10000, 2), np.int64)
    count = _sweep(positions, np.ascontiguousarray(faces), low, high, order, found)
    return found[: min(count, len(found))]
