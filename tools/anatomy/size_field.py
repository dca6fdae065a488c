"""How long the edges of the skin shall be, place by place."""

from __future__ import annotations

import numpy as np

__all__ = ["edge_length"]


def edge_length(points):
    """Return the wanted edge length (n,) at `points` (n, 3) of the left half [mm]."""
    y, z = points[:, 1], points[:, 2]

    def beyond(centre, radius):
        return np.maximum(np.linalg.norm(points - np.asarray(centre), axis=1) - radius, 0.0)

    growth = 0.15 - 0.07 * np.clip(z / 60.0, 0.0, 1.0)
    forehead = 4.6 + 0.15 * np.maximum(0.0, np.abs(y - 25) - 20) + 0.12 * np.maximum(0.0, 70 - z)
    return np.min(
        [
            np.full(len(points), 9.0),
            3.0 + growth * beyond((0, -68, 92), 32),
            2.0 + growth * beyond((32, 6, 80), 22),
            3.0 + growth * beyond((22, -42, 90), 14),
            2.2 + 0.12 * beyond((6, -38, 102), 15),
            1.7 + 0.15 * beyond((9, -45, 98), 7),
            3.6 + 0.28 * beyond((80, -18, -14), 30),
            forehead,
        ],
        axis=0,
    )
