"""The skin of the head as one field: lips and lids closed, no mouth bag."""

from __future__ import annotations

from .ear_field import add_ear
from .face_features import add_lids, add_lips, add_nose
from .fields import ellipsoid, fold, tube, union, within_box
from .radial import StarSurface
from .table import CENTRE, SKIN

__all__ = ["BASE", "skin_field"]

BASE = StarSurface(CENTRE, SKIN)


def _neck(points):
    trunk = tube(
        points, [(0, -60, -22, 44), (0, -110, -17, 47), (0, -150, -16, 49), (0, -200, -22, 54)], 10,
        scale=(0.98, 1, 1),
    )  # fmt: skip
    sternomastoid = tube(
        points, [(54, -45, -12, 9), (44, -100, 2, 10), (27, -150, 22, 9), (12, -190, 32, 8)], 20
    )
    trapezius = tube(
        points,
        [(20, -20, -75, 12), (24, -80, -60, 18), (34, -150, -55, 22), (50, -200, -50, 26)],
        16,
    )
    neck = union(union(trunk, sternomastoid, 18), trapezius, 18)
    return union(neck, ellipsoid(points, (0, -140, 30), (9, 16, 9)), 12)


def skin_field(points):
    """Return the field (n,) of the skin at `points` (n, 3) [mm]."""
    points = fold(points)
    skin = union(BASE(points), _neck(points), 22)
    skin = within_box(points, skin, (20, -35, 95), (30, 60, 40), add_nose)
    skin = within_box(points, skin, (15, -65, 90), (35, 35, 40), add_lips)
    skin = within_box(points, skin, (32, 0, 75), (32, 32, 40), add_lids)
    return within_box(points, skin, (82, -18, -12), (32, 60, 45), add_ear)
