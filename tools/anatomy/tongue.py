"""The tongue: a closed body swept from its root to its tip."""

from __future__ import annotations

import numpy as np

from .fields import smooth_curve
from .part import Part

__all__ = ["TONGUE_COLUMNS", "TONGUE_ROWS", "tongue_part"]

TONGUE_ROWS, TONGUE_COLUMNS = 14, 16
# root to tip: y, z of the middle, half width, half thickness [mm]
_SPINE = np.array(
    [(-83, 29, 9, 6.5), (-77, 30, 15, 9.5), (-72, 36, 18.5, 9.8), (-69.5, 46, 19, 8.6),
     (-70, 57, 17.5, 7), (-72, 66, 14, 5.2), (-73.6, 72.5, 9, 3.5)],
    float,
)  # fmt: skip
_TIP = (0.0, -74.0, 75.8)


def _rows():
    knots = np.column_stack([np.zeros(len(_SPINE)), _SPINE])
    spine = smooth_curve(knots, TONGUE_ROWS)
    along = np.gradient(spine[:, :3], axis=0)
    normal = np.column_stack([np.zeros(len(spine)), along[:, 2], -along[:, 1]])
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    angle = 2 * np.pi * np.arange(TONGUE_COLUMNS) / TONGUE_COLUMNS
    side, up = np.cos(angle), np.sin(angle)
    # flat back with a shallow groove along the middle
    up = np.where(up > 0, np.abs(up) ** 0.8 - 0.22 * np.exp(-((side / 0.22) ** 2)) * up, up)
    rows = spine[:, None, :3] + up[None, :, None] * normal[:, None] * spine[:, None, 4:5]
    rows[:, :, 0] += side * spine[:, 3:4]
    quarter = TONGUE_COLUMNS // 4
    rows[:, [quarter, 3 * quarter], 0] = 0.0
    return rows


def tongue_part():
    """Return the tongue; its rows run from the root to the tip, which is the last vertex.

    Column 0 is the left border, column ``TONGUE_COLUMNS / 4`` the middle of the back.
    """
    rows = _rows()
    root = rows[0].mean(axis=0) * [0, 1, 1] + [0, -2.0, -3.0]
    positions = np.vstack([rows.reshape(-1, 3), root[None], np.array([_TIP])])
    count = len(positions)
    polygons = []
    for k in range(TONGUE_COLUMNS):
        j = (k + 1) % TONGUE_COLUMNS
        polygons.append((k, count - 2, j))
        for r in range(TONGUE_ROWS - 1):
            a, b = r * TONGUE_COLUMNS, (r + 1) * TONGUE_COLUMNS
            polygons.append((a + k, a + j, b + j, b + k))
        last = (TONGUE_ROWS - 1) * TONGUE_COLUMNS
        polygons.append((last + k, last + j, count - 1))
    labels = ["tongue"] * len(polygons)
    return Part("tongue", _symmetric(positions), polygons, labels, labels)


def _symmetric(positions):
    """Return positions made exactly symmetric under column -> mirrored column."""
    rows = positions[:-2].reshape(TONGUE_ROWS, TONGUE_COLUMNS, 3)
    image = (TONGUE_COLUMNS // 2 - np.arange(TONGUE_COLUMNS)) % TONGUE_COLUMNS
    rows = 0.5 * (rows + rows[:, image] * [-1, 1, 1])
    return np.vstack([rows.reshape(-1, 3), positions[-2:] * [0, 1, 1]])
