"""Dense triangle meshes of implicit surfaces."""

from __future__ import annotations

import numpy as np
from skimage.measure import marching_cubes

from .topology import compact, half_edges, largest_component

__all__ = ["half_surface"]


def _is_outward(field, positions, faces):
    corner = positions[faces[:: max(1, len(faces) // 200)]]
    normal = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    normal /= np.linalg.norm(normal, axis=1)[:, None] + 1e-12
    centre = corner.mean(axis=1)
    return (field(centre + normal) - field(centre - normal)).mean() > 0


def half_surface(field, low, high, step):
    """Return the zero surface of `field` in a box, largest component, faces outward.

    Parameters
    ----------
    field : callable
        (n, 3) points to (n,) values.
    low, high : (3,) array_like
        Corners of the box [mm]; ``low[0]`` is 0 for a half.
    step : float
        Edge of a grid cell [mm].
    """
    counts = np.round((np.asarray(high, float) - low) / step).astype(int) + 1
    axes = [low[k] + step * np.arange(counts[k]) for k in range(3)]
    points = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    positions, faces, _, _ = marching_cubes(field(points).reshape(counts), 0.0, spacing=(step,) * 3)
    positions = positions.astype(float) + low
    if not _is_outward(field, positions, faces):
        faces = faces[:, ::-1]
    # marching cubes leaves coincident vertices where the surface passes through grid points
    key = np.round(positions / 1e-5).astype(np.int64)
    _, first, inverse = np.unique(key, axis=0, return_index=True, return_inverse=True)
    positions, faces = positions[first], inverse.ravel()[faces]
    edges = half_edges(faces)
    distinct = (edges[:, 0] != edges[:, 1]).reshape(3, -1).all(axis=0)
    faces = largest_component(faces[distinct], len(positions))
    positions, faces, _ = compact(positions, faces)
    positions[np.abs(positions[:, 0]) < 1e-6, 0] = 0.0
    return positions, faces
