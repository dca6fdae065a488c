"""Head-like meshes of any size to try solvers on: graded, irregular, with holes."""

from __future__ import annotations

import numpy as np
from scipy.spatial import ConvexHull

from risorius._check import BoolArray, FloatArray
from risorius.mesh.core import TriMesh

__all__ = ["trial_head"]

_HALF_AXES = (75.0, 105.0, 90.0)
_EYE, _MOUTH, _NECK = (28.0, 22.0, 11.0, 5.0), (0.0, -45.0, 20.0, 3.0), -93.0


def trial_head(vertex_count: int, *, seed: int = 0) -> TriMesh:
    """Return an ellipsoid with a nose, finer in front, with holes for eyes, mouth and neck [mm].

    The vertex count is met to within a few per cent; vertices have 3 to 10 neighbours.
    """
    mesh = _head(vertex_count, seed)
    return _head(round(vertex_count**2 / mesh.vertex_count), seed)


def _head(count: int, seed: int) -> TriMesh:
    generator = np.random.default_rng(seed)
    index = np.arange(count) + 0.5
    polar, around = np.arccos(1.0 - 2.0 * index / count), np.pi * (1.0 + 5.0**0.5) * index
    sphere = np.stack(
        [np.cos(around) * np.sin(polar), np.sin(around) * np.sin(polar), np.cos(polar)], axis=1
    )
    sphere[:, 2] += 0.35 * (1.0 - sphere[:, 2] ** 2)
    sphere += generator.normal(size=sphere.shape) * 0.125 * np.sqrt(4.0 * np.pi / count)
    sphere /= np.linalg.norm(sphere, axis=1, keepdims=True)
    faces = ConvexHull(sphere).simplices
    corners = sphere[faces]
    flipped = np.linalg.det(corners) < 0.0
    faces[flipped] = faces[flipped][:, [0, 2, 1]]
    faces = faces[np.lexsort(np.sort(faces, axis=1).T[::-1])]
    x, y, z = sphere.T
    nose = 18.0 * np.exp(-((x / 0.13) ** 2) - ((y + 0.05) / 0.22) ** 2) * (z > 0.0)
    positions = sphere * _HALF_AXES + sphere * nose[:, None]
    # Whole vertices go, with all their faces, so that rims do not touch themselves.
    edge = 400.0 / np.sqrt(count)
    faces = faces[~_in_holes(positions, edge)[faces].any(axis=1)]
    used, renumbered = np.unique(faces, return_inverse=True)
    return TriMesh(positions[used], renumbered.reshape(-1, 3).astype(np.int32))


def _in_holes(points: FloatArray, edge: float) -> BoolArray:
    x, y, z = points.T
    hole = y < _NECK
    left, right = _EYE, (-_EYE[0], *_EYE[1:])
    for middle, height, width, depth in (left, right, _MOUTH):
        inside = ((x - middle) / width) ** 2 + ((y - height) / max(depth, 0.6 * edge)) ** 2 < 1.0
        hole |= inside & (z > 0.0)
    return hole
