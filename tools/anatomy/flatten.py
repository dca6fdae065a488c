"""Unfold a disc-like patch with little distortion (as rigid as possible, local and global steps).

References: Liu, Zhang, Xu, Gotsman, Gortler 2008, "A local/global approach to mesh
parameterization".
"""

from __future__ import annotations

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.linalg import splu

__all__ = ["as_rigid_as_possible", "flat_area"]


def flat_area(uvs, faces):
    """Return twice the signed areas (m,) of `faces` in the plane."""
    corner = uvs[faces]
    u, v = corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]
    return u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]


def _flat_triangles(positions, faces):
    """Return every triangle laid isometrically in the plane (m, 3, 2)."""
    corner = positions[faces]
    u, v = corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]
    length = np.linalg.norm(u, axis=1)
    along = (u * v).sum(axis=1) / length
    across = np.linalg.norm(np.cross(u, v), axis=1) / length
    flat = np.zeros((len(faces), 3, 2))
    flat[:, 1, 0] = length
    flat[:, 2] = np.column_stack([along, across])
    return flat


def _edge_weights(flat):
    """Return cotangents (m, 3) opposite to each corner, kept positive."""
    weights = []
    for k in range(3):
        u, v = flat[:, (k + 1) % 3] - flat[:, k], flat[:, (k + 2) % 3] - flat[:, k]
        cross = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]
        weights.append((u * v).sum(axis=1) / np.maximum(cross, 1e-9))
    return np.clip(np.stack(weights, axis=1), 0.02, 10.0)


def as_rigid_as_possible(positions, faces, uvs, *, on_axis, passes=60):
    """Return uvs (n, 2) near an isometry of the mesh.

    Parameters
    ----------
    positions : (n, 3) ndarray
    faces : (m, 3) int ndarray
    uvs : (n, 2) ndarray
        Start, counter-clockwise.
    on_axis : (k,) int ndarray
        Vertices that stay on u = 0; the first one also keeps its v.
    """
    n = len(positions)
    flat = _flat_triangles(positions, faces)
    weights = _edge_weights(flat)
    matrix = coo_matrix((n, n)).tocsr()
    for k in range(3):
        i, j = faces[:, (k + 1) % 3], faces[:, (k + 2) % 3]
        w = weights[:, k]
        entries = np.concatenate([w, w, -w, -w])
        where = (np.concatenate([i, j, i, j]), np.concatenate([i, j, j, i]))
        matrix = matrix + coo_matrix((entries, where), (n, n)).tocsr()
    free = [np.setdiff1d(np.arange(n), on_axis), np.setdiff1d(np.arange(n), on_axis[:1])]
    factors = [splu(matrix[f][:, f].tocsc()) for f in free]
    pinned = [np.zeros(n), np.zeros(n)]
    pinned[1][on_axis[0]] = uvs[on_axis[0], 1]
    for _ in range(passes):
        right = np.zeros((n, 2))
        covariance = np.zeros((len(faces), 2, 2))
        for k in range(3):
            i, j = (k + 1) % 3, (k + 2) % 3
            now = uvs[faces[:, i]] - uvs[faces[:, j]]
            rest = flat[:, i] - flat[:, j]
            covariance += weights[:, k, None, None] * now[:, :, None] * rest[:, None, :]
        left, _, back = np.linalg.svd(covariance)
        left[:, :, 1] *= np.sign(np.linalg.det(left @ back))[:, None]
        turn = left @ back
        for k in range(3):
            i, j = (k + 1) % 3, (k + 2) % 3
            edge = np.einsum("mij,mj->mi", turn, flat[:, i] - flat[:, j]) * weights[:, k, None]
            for axis in range(2):
                right[:, axis] += np.bincount(faces[:, i], edge[:, axis], n)
                right[:, axis] -= np.bincount(faces[:, j], edge[:, axis], n)
        uvs = np.zeros((n, 2))
        for axis in range(2):
            f = free[axis]
            uvs[:, axis] = pinned[axis]
            uvs[f, axis] = factors[axis].solve((right[:, axis] - matrix @ pinned[axis])[f])
    return uvs
