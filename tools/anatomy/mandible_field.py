"""The mandible as a field."""

from __future__ import annotations

import numpy as np

from .arches import ARCHES, crowns
from .bone_fields import LEAST_TISSUE, arch_tube
from .fields import cut, ellipsoid, fold, polygon, rotation, tube, union
from .skin_field import skin_field

__all__ = ["mandible_field"]

_RAMUS = [
    (9, -73), (17, -82.5), (30, -88), (43, -84), (46, -74), (43.5, -60), (42, -44), (43, -30),
    (40.5, -19.5), (36.5, -22), (32, -31), (26, -36), (20.5, -32), (16, -22), (9.5, -20),
    (6.5, -28), (7, -45), (6.5, -60),
]  # fmt: skip


def _body(points):
    body = tube(
        points,
        [(0, -96, 79, 6.2), (10, -97.5, 77.5, 6), (21, -96, 69, 5.6), (31, -92, 54, 5.4),
         (40, -86.5, 36, 5.2), (45.5, -81, 21, 4.8)],
        30,
        scale=(0.95, 1.6, 1),
    )  # fmt: skip
    line = [(x, z - 0.6) for x, z in ARCHES["lower"].line]
    heights = [-82, -82, -82.5, -83, -83.5, -83.5]
    alveolar = arch_tube(points, line, heights, [4.2, 4.2, 4.6, 5, 5.4, 5.4], stretch=1.5)
    body = union(body, alveolar, 11)
    body = union(body, ellipsoid(points, (0, -101, 83), (8, 6.5, 4.6)), 8)
    body = union(body, ellipsoid(points, (9.5, -104, 80.5), (6, 4.5, 4.5)), 7)
    for crown in crowns(ARCHES["lower"])[:4]:  # bulges over the roots
        x, _, z = crown.centre + crown.turn[:, 2] * (crown.size[2] * 0.32)
        root = [(x, -79.5, z, 1.9), (x, -84, z - 0.3, 1.7), (x, -90, z - 1.5, 0.8)]
        body = union(body, tube(points, root, 6), 2)
    return body


def _ramus(points):
    x, y, z = points.T
    middle = 46.2 + 0.045 * (y + 80) + 0.03 * (15 - z) + 2.2 * np.clip((-70 - y) / 15, 0, 1)
    outline = polygon(points[:, [2, 1]], _RAMUS, smooth=90)
    return cut(outline + 0.5, np.abs(x - middle) - 3.2, 3.5)


def mandible_field(points):
    """Return the field (n,) of the mandible at `points` (n, 3) [mm]."""
    points = fold(points)
    bone = union(_body(points), _ramus(points), 9)
    oblique_line = [(45, -48, 40, 2.6), (43.5, -66, 43, 3.6), (38, -80, 48, 3)]
    bone = union(bone, tube(points, oblique_line, 10), 6)
    condyle = ellipsoid(points, (48.5, -20.5, 12.5), (8.6, 4.6, 5.2), rotation(0, 15, 0))
    return cut(union(bone, condyle, 4), skin_field(points) + LEAST_TISSUE, 3)
