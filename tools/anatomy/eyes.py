"""Eyeballs: rings about the optical axis, so that pupil and iris end on edges."""

from __future__ import annotations

import numpy as np

from .part import Part, mirror_part
from .table import EYE_CENTRE, EYE_RADIUS

__all__ = ["IRIS_ANGLE", "PUPIL_ANGLE", "eye_parts"]

PUPIL_ANGLE, IRIS_ANGLE = 9.5, 28.0
_COLUMNS = 24
# polar angles of the rings from the pupil to the back [degrees]
_RINGS = (
    PUPIL_ANGLE, 15.0, 21.5, IRIS_ANGLE, 34.0, 43.0, 53.0, 64.0, 78.0, 94.0, 112.0, 132.0, 155.0,
)  # fmt: skip
_CORNEA = 1.0


def _radius(angle):
    """Return the distance from the centre: the cornea bulges over the iris [mm]."""
    return EYE_RADIUS + _CORNEA * np.clip(1 - (angle / 30.0) ** 2, 0.0, 1.0)


def _material(band):
    if band == 0:
        return "pupil"
    return "iris" if _RINGS[band - 1] < IRIS_ANGLE else "sclera"


def eye_parts():
    """Return the left and the right eyeball; vertex 0 is the pupil."""
    angles = np.concatenate([[0.0], np.repeat(_RINGS, _COLUMNS), [180.0]])
    turn = np.tile(2 * np.pi * np.arange(_COLUMNS) / _COLUMNS, len(_RINGS))
    turn = np.concatenate([[0.0], turn, [0.0]])
    polar = np.radians(angles)
    direction = np.stack(
        [np.sin(polar) * np.cos(turn), np.sin(polar) * np.sin(turn), np.cos(polar)], axis=1
    )
    positions = EYE_CENTRE + direction * _radius(angles)[:, None]
    polygons, materials = [], []
    for band in range(len(_RINGS) + 1):
        a, b = 1 + (band - 1) * _COLUMNS, 1 + band * _COLUMNS
        for k in range(_COLUMNS):
            j = (k + 1) % _COLUMNS
            if band == 0:
                polygons.append((0, b + k, b + j))
            elif band == len(_RINGS):
                polygons.append((a + k, len(positions) - 1, a + j))
            else:
                polygons.append((a + k, b + k, b + j, a + j))
            materials.append(_material(band))
    # seen along the axis, the back shrunk onto the rim so that nothing overlaps
    reach = polar / np.pi
    uvs = 0.5 + 0.5 * reach[:, None] * np.column_stack([np.cos(turn), np.sin(turn)])
    groups = ["eye_left"] * len(polygons)
    left = Part("eye_left", positions, polygons, groups, materials, uvs, list(polygons))
    return left, mirror_part(left, "eye_right")
