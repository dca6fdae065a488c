"""The auricle as a field, in a frame of its own."""

from __future__ import annotations

import numpy as np

from .fields import cut, ellipsoid, tube, union

__all__ = ["add_ear"]

_TRAGUS = np.array([70.0, -20.0, -3.0])
_STAND_OFF, _LEAN, _SIZE = np.radians(28.0), np.radians(12.0), 0.94


def _frame():
    """Rows: back along the auricle, up, away from the head."""
    up = np.array([0.0, np.cos(_LEAN), -np.sin(_LEAN)])
    back = np.array([0.0, -np.sin(_LEAN), -np.cos(_LEAN)])
    back = back * np.cos(_STAND_OFF) + np.array([1.0, 0.0, 0.0]) * np.sin(_STAND_OFF)
    away = np.cross(back, up)
    return np.stack([back, up, away if away[0] > 0 else -away])


def add_ear(points, skin):
    """Join the auricle to the field `skin` (n,) at `points` (n, 3) with x >= 0."""
    q = (points - _TRAGUS) @ _frame().T / _SIZE
    blade = ellipsoid(q, (14, 0, 0.5), (16.5, 29, 3.2))
    ear = union(blade, ellipsoid(q, (7, -26, 0), (8, 9, 3.6)), 8)
    helix = tube(
        q,
        [(6, 2, 2.5, 1.4), (2.4, 9, 2.6, 2.1), (2.8, 18, 2.7, 2.5), (9, 26.2, 3, 2.8),
         (18, 27, 3, 3), (27, 17, 2.5, 3), (29, 2, 2, 2.7), (25, -13, 1.5, 2.3), (15, -23, 1, 2.2)],
        40,
    )  # fmt: skip
    antihelix = tube(
        q,
        [(12, 18, 2.2, 1.8), (18, 10, 3, 2.4), (20, 0, 3, 2.6), (17, -10, 3, 2.6),
         (11, -15, 3.4, 2.8)],
        24,
    )  # fmt: skip
    ear = union(ear, helix, 2.5)
    ear = union(ear, antihelix, 3)
    ear = union(ear, ellipsoid(q, (2, -3, 3), (3.2, 6, 3)), 3)  # tragus
    # the back wall keeps the bowl from piercing the blade, which would add a handle
    ear = union(ear, ellipsoid(q, (9, -4, -6), (11, 18, 8.5)), 6)
    ear = cut(ear, -ellipsoid(q, (9.5, -2, 4.5), (8, 11, 6.5)), 2.5)
    joined = union(skin, ear, 6)
    # the blend refills the bowl: carve it again
    return cut(joined, -ellipsoid(q, (8.5, -3, 5), (6, 8, 7)), 2.5)
