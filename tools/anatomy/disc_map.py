"""Flatten a triangle mesh with one border onto the unit disc without foldovers."""

from __future__ import annotations

import numpy as np
from scipy.sparse import coo_matrix, diags
from scipy.sparse.linalg import splu

from .topology import border_loops

__all__ = ["disc_map", "harmonic_map"]


def _cotangent_weights(positions, faces):
    """Return the symmetric matrix (n, n) of clipped cotangents."""
    rows, columns, weights = [], [], []
    for k in range(3):
        a, b, c = faces[:, k], faces[:, (k + 1) % 3], faces[:, (k + 2) % 3]
        u, v = positions[b] - positions[a], positions[c] - positions[a]
        cotangent = (u * v).sum(axis=1) / (np.linalg.norm(np.cross(u, v), axis=1) + 1e-9)
        rows += [b, c]
        columns += [c, b]
        weights += [np.clip(cotangent, 0.02, 20.0)] * 2
    n = len(positions)
    entries = (np.concatenate(weights), (np.concatenate(rows), np.concatenate(columns)))
    return coo_matrix(entries, (n, n)).tocsr()


def harmonic_map(positions, faces, fixed, fixed_values):
    """Return (n, d) values that are harmonic on the mesh and given on the vertices `fixed`."""
    weights = _cotangent_weights(positions, faces)
    laplacian = (diags(np.asarray(weights.sum(axis=1)).ravel()) - weights).tocsr()
    values = np.zeros((len(positions), fixed_values.shape[1]))
    values[fixed] = fixed_values
    free = np.setdiff1d(np.arange(len(positions)), fixed)
    factor = splu(laplacian[free][:, free].tocsc())
    values[free] = factor.solve(-(laplacian[free][:, fixed] @ fixed_values))
    return values


def disc_map(positions, faces):
    """Return plane coordinates (n, 2) in the unit disc and the border loop."""
    loops = border_loops(faces)
    if len(loops) != 1:
        raise RuntimeError(f"disc map: expected one border, got {[len(loop) for loop in loops]}")
    border = loops[0]
    step = np.linalg.norm(np.roll(positions[border], -1, axis=0) - positions[border], axis=1)
    angle = 2 * np.pi * np.concatenate([[0.0], np.cumsum(step)[:-1]]) / step.sum()
    circle = np.column_stack([np.cos(angle), np.sin(angle)])
    return harmonic_map(positions, faces, border, circle), border
