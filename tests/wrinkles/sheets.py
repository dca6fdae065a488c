"""Flat sheets for wrinkles."""

from __future__ import annotations

import numpy as np

from risorius._check import FloatArray
from risorius.mesh.core import TriMesh


def sheet(width: float, step: float) -> TriMesh:
    """Return a square of `width` [mm] that faces +z, with edges of `step` along x and y."""
    count = round(width / step) + 1
    x, y = np.meshgrid(np.arange(count) * step, np.arange(count) * step)
    positions = np.stack([x.ravel(), y.ravel(), np.zeros(count * count)], axis=1)
    corner = (np.arange(count - 1)[:, None] * count + np.arange(count - 1)).ravel()
    right, up = corner + 1, corner + count
    faces = np.concatenate(
        [np.stack([corner, right, up + 1], axis=1), np.stack([corner, up + 1, up], axis=1)]
    )
    return TriMesh(positions, faces.astype(np.int32))


def turned(angle: float) -> FloatArray:
    """Return a rotation (3, 3) about an axis of no plane."""
    axis = np.array([1.0, 2.0, -0.5])
    axis /= np.linalg.norm(axis)
    cross = np.cross(np.eye(3), axis).T
    return np.eye(3) - np.sin(angle) * cross.T + (1.0 - np.cos(angle)) * (cross @ cross)
