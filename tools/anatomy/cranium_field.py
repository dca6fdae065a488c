"""The cranium as a field: the base of the skin minus the tissue depth, plus the face's bones."""

from __future__ import annotations

import numpy as np

from .arches import ARCHES, crowns
from .bone_fields import LEAST_TISSUE, arch_tube
from .fields import cut, ellipsoid, fold, polygon, rotation, tube, union
from .mandible_field import mandible_field
from .skin_field import BASE, skin_field

__all__ = ["cranium_field"]

_FLOOR = [
    (120, 5), (92, 3), (80, 8), (60, 7), (48, 0), (40, -18), (12, -26), (0, -36), (-25, -46),
    (-55, -45), (-80, -30), (-130, -20), (-130, 150), (120, 150),
]  # fmt: skip
_RIM = [
    (33, 19.3, 80.5, 4.8), (22, 16.5, 83.5, 4.6), (13.5, 7, 82, 3.8), (12.6, -6, 78.5, 3),
    (17.5, -18, 76, 3.4), (31, -22.6, 74, 3.8), (43.5, -19.5, 69, 4.4), (51, -8, 62, 4.6),
    (52.4, 4, 61.5, 4.4), (47.5, 14.5, 71, 5),
]  # fmt: skip
_APERTURE = [
    (0, -21.5), (3.2, -22.5), (7.8, -28.5), (11, -36), (12.2, -41), (10, -46.5), (4, -48), (0, -47),
]  # fmt: skip
_SEPTUM = [(52, -18), (80, -19), (74, -30), (80, -47), (52, -49)]


def _braincase(points):
    """Vault and base, without the bones of the face."""
    bone = cut(BASE(points, inset=True), polygon(points[:, [2, 1]], _FLOOR), 9)
    bone = cut(bone, -ellipsoid(points, (66, 2, 41), (15.5, 30, 21)), 9)  # temporal fossa
    glabella = tube(points, [(0, 11, 85.5, 5.5), (11, 12.5, 86, 5), (22, 16.5, 82.5, 4.5)], 12)
    bone = union(bone, glabella, 9)
    bone = union(bone, ellipsoid(points, (0, -30, 14), (26, 12, 34)), 12)
    bone = union(bone, ellipsoid(points, (36, -28, 2), (22, 10, 14)), 10)
    mastoid = ellipsoid(points, (51, -39, -9), (8.5, 14, 10.5), rotation(20, 0, -12))
    bone = union(bone, mastoid, 9)
    bone = union(bone, ellipsoid(points, (0, -16, -76), (8, 5, 6)), 10)  # occipital protuberance
    bone = union(bone, ellipsoid(points, (13, -44, -8), (6, 6, 10)), 7)  # occipital condyle
    bone = union(bone, ellipsoid(points, (36.5, -5, 46), (13, 22, 19)), 8)  # greater wing
    bone = union(bone, ellipsoid(points, (0, -14, 56), (13, 24, 26)), 8)  # ethmoid block
    return union(bone, tube(points, _RIM, 60, closed=True), 6)


def _maxilla(points):
    frontal = [(8.5, 2, 81, 4.5), (12, -14, 80, 4.8), (15.5, -30, 78.5, 5), (13.5, -46, 79, 5.5)]
    bone = union(tube(points, frontal, 20), ellipsoid(points, (22, -35, 59), (16, 18, 19)), 9)
    line = [(x, z - 0.8) for x, z in ARCHES["upper"].line]
    radii = [5.2, 5.6, 6, 6.4, 6.6, 6.4]
    bone = union(bone, arch_tube(points, line, [-54] * 6, radii, stretch=1.35), 8)
    bone = union(bone, ellipsoid(points, (0, -47.5, 60), (22, 4.5, 22)), 6)  # palate
    buttress = tube(points, [(44, -29, 60, 7), (36, -40, 58, 7), (30, -48, 57, 6)], 10)
    bone = union(bone, buttress, 8)
    zygoma = ellipsoid(points, (46.5, -27, 62.5), (12, 11, 9.5), rotation(0, 35, 0))
    bone = union(bone, zygoma, 9)
    process = [(49.5, -24, 62, 5), (51.5, -12, 61, 4.6), (51.8, 0, 61.5, 4.5), (50, 10, 66, 4.5)]
    return union(bone, tube(points, process, 12), 6)


def _add_face(points, bone):
    """Join maxilla, zygomatic arch, pterygoid plates and nasal bones."""
    bone = union(bone, _maxilla(points), 6)
    for crown in crowns(ARCHES["upper"])[:4]:  # bulges over the roots
        x, _, z = crown.centre + crown.turn[:, 2] * (crown.size[2] * 0.34)
        top = -42 if crown.size[0] == 7.6 else -50
        root = [(x, -59, z, 2.4), (x, -54, z - 0.4, 2.2), (x, top, z - 2.2, 0.9)]
        bone = union(bone, tube(points, root, 6), 2.5)
    arch = tube(
        points,
        [(49, -25, 59, 6), (56, -22.5, 50, 4.6), (61.2, -21, 38, 4.2), (62.2, -19.5, 26, 4),
         (61, -16.5, 14, 4.2), (59, -14, 4, 5), (56, -10, -10, 6)],
        40,
        scale=(0.8, 1.25, 1),
    )  # fmt: skip
    bone = union(bone, arch, 6)
    plates = [(12, -26, 36, 4), (13.5, -40, 38, 4), (15, -50, 38, 3)]
    bone = union(bone, tube(points, plates, 8, scale=(0.7, 1, 1.2)), 5)
    bridge = [(0, 8, 84, 6.2), (0, -4, 84.6, 6), (0, -12, 87.8, 5.6), (0, -32, 98, 4.6)]
    side = [(4.5, 3, 82, 5.6), (5.2, -8, 84, 5.6), (7.2, -18, 86, 5.2), (12.5, -31, 81, 5)]
    return union(bone, union(tube(points, bridge, 16), tube(points, side, 10), 8), 5)


def _carve(points, bone):
    """Carve orbit, nose, fossae and canals, and put septum and nasal spine back."""
    orbit = [(34.5, -1, 100, 20.5), (33, -1, 78, 17.6), (31, -1, 66, 16.2), (25, -1.5, 50, 11),
             (17, -2, 34, 2.5)]  # fmt: skip
    bone = cut(bone, -tube(points, orbit, 30, scale=(1.12, 0.97, 1)), 4)
    aperture = _APERTURE + [(-x, y) for x, y in _APERTURE[-2:0:-1]]
    pear = polygon(points[:, :2], aperture, smooth=60)
    bone = cut(bone, -cut(pear, np.abs(points[:, 2] - 86) - 23, 4), 3)
    septum = cut(np.abs(points[:, 0]) - 1, polygon(points[:, [2, 1]], _SEPTUM), 1)
    bone = union(bone, septum, 2)
    bone = union(bone, tube(points, [(0, -48.5, 80, 3), (0, -47.8, 89, 1)], 6), 3)  # nasal spine
    bone = cut(bone, -ellipsoid(points, (24, -38, 86), (6.5, 7, 7)), 7)  # canine fossa
    bone = cut(bone, -ellipsoid(points, (0, -52, -22), (13, 16, 16)), 5)  # foramen magnum
    bone = cut(bone, -tube(points, [(70, -24, -1, 3.2), (54, -24, -1, 2.4)], 4), 2)  # ear canal
    socket = ellipsoid(points, (48, -20.5, 12.5), (10.5, 7, 7.6), rotation(0, 15, 0))
    bone = cut(bone, -socket, 3)
    coronoid_gap = [(54, 0, 41, 4), (52, -20, 40, 6.5), (50, -45, 36, 8)]
    bone = cut(bone, -tube(points, coronoid_gap, 10, scale=(1, 1, 1.4)), 4)
    return cut(bone, -(mandible_field(points) - 1.6), 1.5)


def cranium_field(points):
    """Return the field (n,) of the cranium at `points` (n, 3) [mm]."""
    points = fold(points)
    bone = _carve(points, _add_face(points, _braincase(points)))
    # the skin is thin over the nasal bones
    offset = (points - [0, -9, 92]) / [11, 15, 16]
    tissue = LEAST_TISSUE - 2.5 * np.exp(-(offset**2).sum(axis=1))
    return cut(bone, skin_field(points) + tissue, 2.5)
