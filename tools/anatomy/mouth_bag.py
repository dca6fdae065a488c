"""The closed bag behind the lips: it encloses teeth, gums and tongue.

The bag is star-shaped about a point in the mouth. Its rows carry on from the inner lips,
each column turning in its own plane from the front to the back of the mouth.
"""

from __future__ import annotations

import numpy as np
from scipy.interpolate import CubicSpline

__all__ = ["BAG_CENTRE", "bag_radius", "bag_rows"]

BAG_CENTRE = np.array([0.0, -68.5, 52.0])
_RISE, _DROP, _POWER = 22.0, 21.5, 3.6
# plan of the vestibule, midline at the lips to midline behind the tongue: x, z [mm]
_PLAN = np.array(
    [(0, 90), (9, 88.2), (16, 84.6), (21.5, 80), (26, 75.2), (30, 69.5), (34, 60), (37.5, 49),
     (38, 39), (35, 28), (21, 18.5), (0, 15.5)],
    float,
)  # fmt: skip
_TURN_END = np.radians(166.0)
_TURNS = (0.06, 0.14, 0.24, 0.35, 0.47, 0.6, 0.74, 0.88, 1.0)


def _plan_radius(angle):
    """Radius (n,) of the plan at `angle` (n,) from the front [rad]."""
    local = _PLAN - BAG_CENTRE[[0, 2]]
    knots = np.arctan2(local[:, 0], local[:, 1])
    return CubicSpline(knots, np.hypot(*local.T), bc_type="clamped")(np.abs(angle))


def bag_radius(directions):
    """Return the distance (n,) from the centre to the bag along unit `directions` (n, 3) [mm]."""
    level = np.hypot(directions[:, 0], directions[:, 2])
    plan = _plan_radius(np.arctan2(directions[:, 0], directions[:, 2]))
    height = np.where(directions[:, 1] > 0, _RISE, _DROP)
    excess = (level / plan) ** _POWER + (np.abs(directions[:, 1]) / height) ** _POWER
    return excess ** (-1.0 / _POWER)


def bag_rows(inner_lip):
    """Return the rows of the bag that follow the row `inner_lip` (c, 3), front to back."""
    offset = inner_lip - BAG_CENTRE
    start = np.linalg.norm(offset, axis=1)
    azimuth = np.arctan2(offset[:, 1], offset[:, 0])
    # even out the columns towards the back
    even = np.linspace(0.5 * np.pi, -0.5 * np.pi, len(offset))
    first = np.arccos(np.clip(offset[:, 2] / start, -1.0, 1.0))
    rows = []
    for turn in _TURNS:
        polar = first + turn * (_TURN_END - first)
        around = azimuth + min(1.0, 1.5 * turn) * (even - azimuth)
        direction = np.column_stack(
            [np.sin(polar) * np.cos(around), np.sin(polar) * np.sin(around), np.cos(polar)]
        )
        blend = min(1.0, turn / 0.14)
        radius = start + blend * (bag_radius(direction) - start)
        row = BAG_CENTRE + radius[:, None] * direction
        row[[0, -1], 0] = 0.0
        rows.append(row)
    return rows
