"""Nose, lips and lids as fields joined to the base of the head."""

from __future__ import annotations

from .fields import cut, ellipsoid, rotation, tube, union
from .table import EYE_CENTRE

__all__ = ["add_lids", "add_lips", "add_nose"]


def add_nose(points, skin):
    """Join bridge, tip, wings and columella to `skin` (n,), then carve the nostril."""
    bridge = tube(
        points,
        [(0, 10, 88, 6.2), (0, 0, 88.5, 5.0), (0, -12, 93, 5.0), (0, -24, 99.5, 5.6),
         (0, -34, 103.5, 6.8)],
        30,
    )  # fmt: skip
    side = tube(
        points, [(5, 0, 81, 4.2), (6.2, -12, 83, 5.5), (8, -24, 87.5, 7.5), (10, -35, 92.5, 9)], 16
    )
    skin = union(skin, union(bridge, side, 12), 15)
    tip = ellipsoid(points, (0, -39, 104.6), (8, 7.4, 7.8))
    tip = union(tip, ellipsoid(points, (4, -39.4, 106), (4.8, 5, 5.2)), 5)
    wing = ellipsoid(points, (12.4, -41.2, 96.2), (5.2, 6.2, 8.4), rotation(12, 22, 0))
    tip = union(tip, wing, 5)
    columella = tube(points, [(0, -44.5, 105, 3), (0, -47.8, 100.5, 3), (0, -49.5, 95, 4)], 10)
    skin = union(skin, union(tip, columella, 3.5), 6.5)
    nostril = tube(
        points,
        [(6.2, -51, 101.5, 1.6), (7.2, -47.6, 99.6, 2.7), (7.8, -43, 98.2, 2.6),
         (6.5, -36, 97, 1.6)],
        12,
    )  # fmt: skip
    return cut(skin, -nostril, 1.6)


def add_lips(points, skin):
    """Join the closed lips to `skin` (n,) and carve the philtrum."""
    upper = tube(
        points,
        [(0, -65.6, 96, 3.9), (4, -65, 96.3, 4.1), (9, -65.3, 95, 3.9), (16, -66.9, 91, 3.1),
         (22, -68.5, 86.2, 1.9), (26, -69.5, 82.6, 0.8)],
        40,
    )  # fmt: skip
    lower = tube(
        points,
        [(0, -73, 93.6, 5), (6, -73, 93.2, 5), (12, -72.5, 91.2, 4.5), (18, -71.5, 87.6, 3.3),
         (23, -70.4, 83.9, 1.8), (26, -69.7, 82.2, 0.8)],
        40,
    )  # fmt: skip
    skin = union(skin, union(upper, lower, 0.6), 6)
    philtrum = tube(points, [(0, -49, 99.4, 2), (0, -55, 100.2, 2.6), (0, -61, 101.8, 2.2)], 10)
    return cut(skin, -philtrum, 3)


def add_lids(points, skin):
    """Join the bulge of the closed lids to `skin` (n,) and hollow the inner corner."""
    lid = ellipsoid(points, EYE_CENTRE + (0.3, -0.2, 0.2), (18, 13.8, 14.1))
    skin = union(skin, lid, 5)
    return cut(skin, -ellipsoid(points, (13.8, -1.5, 91), (3.6, 7, 5.4)), 8)
