"""Bring points onto the skin."""

from __future__ import annotations

import numpy as np

from .skin_field import skin_field

__all__ = ["gradient", "lift", "project", "slide"]


def gradient(points):
    """Return the gradient (n, 3) of the skin field by central differences."""
    step = 0.25
    columns = []
    for axis in range(3):
        offset = np.zeros(3)
        offset[axis] = step
        columns.append((skin_field(points + offset) - skin_field(points - offset)) / (2 * step))
    return np.stack(columns, axis=1)


def project(points, passes=3):
    """Return `points` (n, 3) moved to the skin along its gradient."""
    for _ in range(passes):
        slope = gradient(points)
        step = skin_field(points) / np.maximum((slope**2).sum(axis=1), 0.25)
        points = points - np.clip(step, -2.0, 2.0)[:, None] * slope
    return points


def lift(plane_points):
    """Return the front-most skin points (n, 3) over `plane_points` (n, 2) of the front view."""
    plane_points = np.asarray(plane_points, float)
    step = 0.4
    depth = np.arange(125.0, 40.0, -step)
    columns = np.empty((len(plane_points), len(depth), 3))
    columns[..., :2] = plane_points[:, None]
    columns[..., 2] = depth
    value = skin_field(columns.reshape(-1, 3)).reshape(len(plane_points), -1)
    first = (value < 0).argmax(axis=1)
    row = np.arange(len(plane_points))
    outside, inside = value[row, first - 1], value[row, first]
    return np.column_stack([plane_points, depth[first - 1] - step * outside / (outside - inside)])


def slide(points, targets, share):
    """Return `points` moved by `share` of the way to `targets`, along the skin and on it."""
    step = targets - points
    normal = gradient(points)
    normal /= np.linalg.norm(normal, axis=1)[:, None] + 1e-9
    step = step - (step * normal).sum(axis=1)[:, None] * normal
    return project(points + share * step, 2)
