"""Where soft tissue swells: cheek fat up to the nasolabial fold, thin tissue elsewhere."""

from __future__ import annotations

import numpy as np

from risorius._check import FloatArray
from risorius.anatomy.mechanics import Mechanics
from risorius.anatomy.skin import Skin
from risorius.anatomy.smooth_step import smooth_step

__all__ = ["swelling_depth"]

# Thickness of the cheek's fat, and what of other tissue swells [mm, share].
_FAT, _THIN_SHARE = 14.0, 0.7


def swelling_depth(skin: Skin, mechanics: Mechanics) -> FloatArray:
    """Return the thickness (n,) of tissue that must keep its volume [built-in mm].

    The fat of the cheek lies lateral of a line from the wing of the nose past the mouth corner,
    ends sharply there, which makes the nasolabial fold, and fades over the side of the face.
    """
    fat = _cheek_fat(skin, mechanics)
    free = smooth_step((skin.mouth.distance - 4.0) / 8.0) * ~skin.hidden
    thin = _THIN_SHARE * np.clip(skin.depth, 2.0, 8.0) * (1.0 - skin.lids) * free
    return skin.even(fat * ~skin.hidden + thin)


def _cheek_fat(skin: Skin, mechanics: Mechanics) -> FloatArray:
    marks, points, scale = mechanics.head.landmarks, skin.positions, skin.scale
    a = skin.mouth.half_width
    corner = marks.positions(("2.4", "2.5")) * [[1, 1, 1], [-1, 1, 1]]
    corner = corner.mean(axis=0)
    wing = _wing(mechanics)
    height = wing[1] - corner[1]
    low, high = corner[1], wing[1]
    ys = np.array([low - 0.9 * height, low - 0.45 * height, low, low + 0.5 * height,
                   high + 0.05 * height, high + 0.45 * height])  # fmt: skip
    xs = np.array([corner[0] + 0.36 * a, corner[0] + 0.38 * a, corner[0] + 0.33 * a,
                   corner[0] + 0.16 * a, wing[0] + 0.08 * a, wing[0] - 0.1 * a])  # fmt: skip
    fold = np.interp(points[:, 1], ys, xs)
    slope = np.interp(points[:, 1], ys, np.gradient(xs, ys))
    beyond = (np.abs(points[:, 0]) - fold) / np.sqrt(1.0 + slope**2) / scale
    upright = smooth_step((points[:, 1] - ys[0]) / (0.8 * height)) * smooth_step(
        (high + 1.35 * height - points[:, 1]) / (1.2 * height)
    )
    front = points[:, 2] > 0.5 * (corner[2] + wing[2]) - 45.0 * scale
    fat = _FAT * smooth_step((beyond + 1.0) / 5.0) * smooth_step((50.0 - beyond) / 38.0)
    offset = np.abs(points) * [1, 0, 0] + points * [0, 1, 1] - corner
    modiolus = np.linalg.norm(offset, axis=1) / scale
    return fat * upright * front * (0.15 + 0.85 * smooth_step((modiolus - 6.0) / 16.0))


def _wing(mechanics: Mechanics) -> FloatArray:
    """Return the wing of the nose (3,), left side, mean of both."""
    marks = mechanics.head.landmarks
    if not marks.missing(("9.1", "9.2")):
        wings = marks.positions(("9.1", "9.2")) * [[1, 1, 1], [-1, 1, 1]]
        return np.asarray(wings.mean(axis=0))
    tip, corner = marks.position("9.3"), marks.position("2.4")
    return np.array([0.72 * corner[0], tip[1] - 3.0, 0.5 * (tip[2] + corner[2])])
