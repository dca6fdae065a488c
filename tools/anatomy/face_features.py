"""Nose, lips and lids as fields joined to the base of the head."""

from __future__ import annotations

from .fields import cut, ellipsoid, rotation, tube, union
from .table import EYE_CENTRE

__all__ = ["add_lids", "add_lips", "add_nose"]


def add_nose(points, skin):
    """Join bridge, tip, wings and columella to `skin` (n,), then carve the nostril."""
    bridge = tube(
        points,
        [(0, 9, 87.8, 6.5), (0, -3, 88.2, 5.8), (0, -16, 93.4, 5.6), (0, -27, 100.4, 6.2),
         (0, -36, 103.8, 7.2)],
        30,
    )  # fmt: skip
    side = tube(
        points, [(5, -2, 80, 5), (7.5, -14, 83, 7.5), (8, -27, 89, 9), (7.5, -36, 94, 9.5)], 16
    )
    skin = union(skin, union(bridge, side, 9), 10)
    tip = ellipsoid(points, (0, -38.4, 104.6), (8.5, 7.8, 7.6))
    tip = union(tip, ellipsoid(points, (4.2, -38.8, 106), (5.2, 5.4, 5.6)), 5)
    wing = ellipsoid(points, (12.2, -41.8, 96), (5.6, 6.8, 8.6), rotation(0, 20, 0))
    tip = union(tip, wing, 5)
    columella = tube(points, [(0, -43.5, 105, 3), (0, -46.5, 100, 3.2), (0, -48, 94, 3.5)], 10)
    skin = union(skin, union(tip, columella, 3.5), 6.5)
    nostril = tube(
        points,
        [(5.6, -48.6, 103.5, 1.3), (7, -47.4, 100.5, 2.5), (8.6, -46.4, 97, 2.3),
         (7.6, -40, 96, 1.8)],
        12,
    )  # fmt: skip
    return cut(skin, -nostril, 1.8)


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
    skin = union(skin, lid, 4)
    return cut(skin, -ellipsoid(points, (13.8, -0.5, 91), (4.2, 8, 6)), 8)
