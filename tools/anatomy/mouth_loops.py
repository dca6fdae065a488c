"""Rows around the mouth: lips, vermilion border, skin around it, inner lips and mouth bag."""

from __future__ import annotations

import numpy as np

from .loops import Loops
from .mouth_bag import bag_rows
from .projecting import lift
from .table import MOUTH_HALF_WIDTH, STOMION_Y

__all__ = ["BAG_FIRST_ROW", "BORDER_ROW", "COLUMNS_PER_LIP", "mouth_loops"]

COLUMNS_PER_LIP = 14
# rows between the slit and the vermilion border, as a share of the height of the vermilion
_VERMILION_ROWS = (0.25, 0.6, 1.0)
BORDER_ROW = len(_VERMILION_ROWS)
# rows outside of the border [mm]
_SKIN_ROWS = (2.3, 5.2, 8.8)
# height of the vermilion from the slit by x / half width: upper, lower [mm]
_UPPER = ((0.0, 0.2, 0.5, 0.8, 1.0), (6.6, 7.9, 6.0, 3.2, 1.3))
_LOWER = ((0.0, 0.2, 0.5, 0.8, 1.0), (8.6, 8.5, 7.2, 4.0, 1.3))
# inner lips: depth behind the slit, opening to each side [mm]
_INNER = ((2.2, 0.03), (4.6, 0.7), (6.4, 3.0), (7.0, 7.0))
# the bag begins behind the first two inner rows
BAG_FIRST_ROW = 2
_GAP = 0.06


def _slit_height(x):
    """Return the designed height (n,) of the line between the lips at `x` [mm]."""
    t = np.abs(x) / MOUTH_HALF_WIDTH
    bow = -0.9 * np.exp(-((t / 0.16) ** 2)) + 0.8 * np.exp(-(((t - 0.42) / 0.25) ** 2))
    return STOMION_Y + bow - 1.2 * t**3


def _lip_sign():
    """Return +1 for columns of the upper lip, 0 at the corner, -1 for the lower lip."""
    return np.repeat([1.0, 0.0, -1.0], [COLUMNS_PER_LIP, 1, COLUMNS_PER_LIP])


def _even_polynomial(x, values):
    """Return `values` (n,) smoothed along the slit, level at the midline and true at the corner."""
    powers = np.array([0, 2, 3, 4, 5, 6])
    weight = np.where(x == x.max(), 3.0, 1.0)
    basis = (x[:, None] / MOUTH_HALF_WIDTH) ** powers
    return basis @ np.linalg.lstsq(basis * weight[:, None], values * weight, rcond=None)[0]


def _valley():
    """Return x and y (n + 1,) of the bottom of the crease between the lips."""
    x = MOUTH_HALF_WIDTH * np.arange(COLUMNS_PER_LIP + 1) / COLUMNS_PER_LIP
    shift = np.arange(-2.0, 2.01, 0.1)
    height = _slit_height(x)
    grid = np.column_stack([np.repeat(x, len(shift)), (height[:, None] + shift).ravel()])
    depth = lift(grid)[:, 2].reshape(len(x), -1)
    y = height + shift[depth.argmin(axis=1)] * (x < 0.8 * MOUTH_HALF_WIDTH)
    return x, _even_polynomial(x, y)


def _there_and_back(values):
    return np.concatenate([values, values[-2::-1]])


def _inner_rows(slit, share, sign):
    """Return the rows of the inner lips behind `slit` (c, 3)."""
    half = slit[: COLUMNS_PER_LIP + 1]
    along = np.gradient(half, axis=0)
    inward = np.column_stack([along[:, 2], np.zeros(len(half)), -along[:, 0]])
    inward /= np.linalg.norm(inward, axis=1)[:, None]
    blend = share[: len(half), None] ** 3
    inward = inward * (1 - blend) + np.array([0.0, 0.0, -1.0]) * blend
    inward /= np.linalg.norm(inward, axis=1)[:, None]
    inward[0] = (0.0, 0.0, -1.0)
    inward = _there_and_back(inward)
    rows = []
    for depth, opening in _INNER:
        row = slit + inward * depth
        row[:, 1] = slit[:, 1] - 0.5 * _GAP * sign + sign * opening * (1 - 0.75 * share**3)
        rows.append(row)
    return rows


def mouth_loops():
    """Return the rows around the left half of the mouth, upper midline to lower midline."""
    x, y = _valley()
    sign = _lip_sign()
    share = _there_and_back(x / MOUTH_HALF_WIDTH)
    plane = np.column_stack([_there_and_back(x), _there_and_back(y)])
    tangent = np.gradient(plane[: COLUMNS_PER_LIP + 1], axis=0)
    slope = _there_and_back(np.arctan2(tangent[:, 1], tangent[:, 0]))
    angle = 0.5 * np.pi * (1 - share**5) * sign + slope * share**5
    direction = np.column_stack([np.cos(angle), np.sin(angle)])
    slit = lift(plane)
    slit[:, 2] = _even_polynomial(plane[:, 0], slit[:, 2])
    slit[:, 1] += 0.5 * _GAP * sign
    border = np.where(sign >= 0, np.interp(share, *_UPPER), np.interp(share, *_LOWER))
    offsets = [s * border for s in _VERMILION_ROWS] + [border + d for d in _SKIN_ROWS]
    outer = [slit]
    for offset in offsets:
        target = plane + offset[:, None] * direction
        target[[0, -1], 0] = 0.0
        outer.append(lift(target))
    inner = _inner_rows(slit, share, sign)
    return Loops(outer, inner + bag_rows(inner[-1]), closed=False)
