"""Find triangles of one mesh that pass through each other."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

_SMALL = 2.0


def _near_pairs(positions, faces):
    """Return pairs (k, 2) of faces whose bounding boxes overlap."""
    corners = positions[faces]
    centre = corners.mean(axis=1)
    radius = np.linalg.norm(corners - centre[:, None], axis=2).max(axis=1)
    small = np.flatnonzero(radius <= _SMALL)
    pairs = [small[cKDTree(centre[small]).query_pairs(2 * _SMALL, output_type="ndarray")]]
    tree, widest = cKDTree(centre), radius.max()
    for face in np.flatnonzero(radius > _SMALL):
        near = np.array(tree.query_ball_point(centre[face], radius[face] + widest))
        # two large faces are met twice: keep the meeting with the lower number first
        near = near[(radius[near] <= _SMALL) | (near > face)]
        pairs.append(np.column_stack([np.full(len(near), face), near]))
    first, second = np.vstack(pairs).T
    low, high = corners.min(axis=1), corners.max(axis=1)
    overlap = (low[first] <= high[second]).all(axis=1) & (low[second] <= high[first]).all(axis=1)
    return np.column_stack([first, second])[overlap]


def _pierces(start, end, triangle):
    """Whether the open segments start-end (k, 3) pass through the triangles (k, 3, 3)."""
    a, b, c = triangle[:, 0], triangle[:, 1], triangle[:, 2]
    normal = np.cross(b - a, c - a)
    before, behind = ((p - a) * normal for p in (start, end))
    before, behind = before.sum(axis=1), behind.sum(axis=1)
    through = before * behind < 0
    share = before / np.where(through, before - behind, 1.0)
    point = start + share[:, None] * (end - start)
    for p, q in ((a, b), (b, c), (c, a)):
        through &= (np.cross(q - p, point - p) * normal).sum(axis=1) > 0
    return through


def crossing_faces(positions, faces):
    """Return pairs (k, 2) of faces of which an edge of one passes through the other."""
    pairs = _near_pairs(positions, faces)
    crossing = np.zeros(len(pairs), bool)
    for one, other in (pairs.T, pairs.T[::-1]):
        for k in range(3):
            edge = faces[one][:, [k, (k + 1) % 3]]
            apart = (edge[:, :, None] != faces[other][:, None, :]).all(axis=(1, 2))
            start, end = positions[edge[:, 0]], positions[edge[:, 1]]
            crossing |= apart & _pierces(start, end, positions[faces[other]])
    return pairs[crossing]
