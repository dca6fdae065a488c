"""Closest points on a triangle mesh, found among the nearest triangle centres."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

__all__ = ["closest_on_mesh"]

_CORNERS = ((0, 1), (1, 2), (2, 0))


def _plane_weights(corners, points):
    """Return barycentric coordinates (n, 3) of the projection onto each triangle's plane."""
    a = corners[:, 0]
    u, v, w = corners[:, 1] - a, corners[:, 2] - a, points - a
    uu, uv, vv = (u * u).sum(1), (u * v).sum(1), (v * v).sum(1)
    wu, wv = (w * u).sum(1), (w * v).sum(1)
    scale = uu * vv - uv * uv + 1e-12
    s, t = (vv * wu - uv * wv) / scale, (uu * wv - uv * wu) / scale
    return np.column_stack([1 - s - t, s, t])


def _edge_weights(corners, points):
    """Return barycentric coordinates (n, 3) of the closest point on the triangle's edges."""
    best = np.zeros((len(points), 3))
    least = np.full(len(points), np.inf)
    for i, j in _CORNERS:
        edge = corners[:, j] - corners[:, i]
        along = ((points - corners[:, i]) * edge).sum(1) / ((edge * edge).sum(1) + 1e-12)
        along = np.clip(along, 0.0, 1.0)
        square = ((corners[:, i] + along[:, None] * edge - points) ** 2).sum(1)
        closer = square < least
        least[closer] = square[closer]
        best[closer] = 0.0
        best[closer, i], best[closer, j] = 1 - along[closer], along[closer]
    return best


def closest_on_mesh(positions, faces, points):
    """Return face (q,), barycentric coordinates (q, 3) and distance (q,) of the closest points."""
    count = min(24, len(faces))
    _, near = cKDTree(positions[faces].mean(axis=1)).query(points, count)
    face, weights = np.zeros(len(points), int), np.zeros((len(points), 3))
    least = np.full(len(points), np.inf)
    for k in range(count):
        corners = positions[faces[near[:, k]]]
        trial = _plane_weights(corners, points)
        outside = (trial < 0).any(axis=1)
        trial[outside] = _edge_weights(corners[outside], points[outside])
        square = ((np.einsum("ij,ijk->ik", trial, corners) - points) ** 2).sum(axis=1)
        closer = square < least
        least[closer], face[closer] = square[closer], near[closer, k]
        weights[closer] = trial[closer]
    return face, weights, np.sqrt(least)
