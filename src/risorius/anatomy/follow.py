"""Parts that lie on the skin (lashes, brows, beard) follow it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from risorius._check import FloatArray, IntArray
from risorius.mesh.core import TriMesh

__all__ = ["Follower", "follow_skin"]


@dataclass(frozen=True, eq=False)
class Follower:
    """Skin `vertices` (k, s) and `weights` (k, s), rows summing to 1, that carry k vertices."""

    vertices: IntArray
    weights: FloatArray

    def displace(self, skin: FloatArray) -> FloatArray:
        """Return the displacement (k, 3) for a displacement (n, 3) of the skin."""
        return np.einsum("ks,ksd->kd", self.weights, skin[self.vertices])


def follow_skin(
    points: FloatArray, skin: TriMesh, *, only: IntArray | None = None, neighbours: int = 4
) -> Follower:
    """Bind `points` (k, 3) to the nearest vertices of the skin, or of `only`, by distance."""
    used = np.unique(skin.faces) if only is None else only
    count = min(neighbours, len(used))
    distance, nearest = cKDTree(skin.positions[used]).query(points, k=count)
    distance = np.asarray(distance).reshape(len(points), count)
    vertices = used[np.asarray(nearest).reshape(len(points), count)].astype(np.int32)
    weights = 1.0 / np.maximum(distance, 1e-6)
    return Follower(vertices, weights / weights.sum(axis=1, keepdims=True))
