"""The skin of the head as one field: lips and lids closed, no mouth bag."""

from __future__ import annotations

from .ear_field import add_ear
from .face_features import add_lids, add_lips, add_nose
from .fields import ellipsoid, fold, tube, union, within_box
from .radial import StarSurface
from .strokes import stroke_height
from .table import CENTRE, SKIN

__all__ = ["BASE", "skin_field"]

BASE = StarSurface(CENTRE, SKIN)


def _neck(points):
    trunk = tube(
        points,
        [(0, -60, -20, 41), (0, -100, -16, 41.5), (0, -135, -14, 42), (0, -200, -20, 46)],
        12,
        scale=(1, 1, 1.02),
    )
    sternomastoid = tube(
        points, [(50, -42, -16, 7), (39, -92, -1, 7), (25, -140, 16, 6.5), (13, -195, 31, 6)], 20
    )
    trapezius = tube(
        points,
        [(13, -30, -68, 13), (17, -80, -58, 18), (22, -140, -52, 21), (34, -200, -52, 24)],
        16,
    )
    nape = tube(points, [(0, -40, -70, 10), (0, -90, -58, 16), (0, -200, -56, 20)], 10)
    neck = union(union(trunk, sternomastoid, 18), union(trapezius, nape, 16), 26)
    return union(neck, ellipsoid(points, (0, -138, 26), (8, 20, 8)), 16)


def skin_field(points):
    """Return the field (n,) of the skin at `points` (n, 3) [mm]."""
    points = fold(points)
    skin = union(BASE(points), _neck(points), 16)
    skin = within_box(points, skin, (20, -35, 95), (30, 60, 40), add_nose)
    skin = within_box(points, skin, (15, -65, 90), (35, 35, 40), add_lips)
    skin = within_box(points, skin, (32, 0, 75), (32, 32, 40), add_lids)
    skin = skin - stroke_height(points)
    return within_box(points, skin, (82, -18, -12), (32, 60, 45), add_ear)
