"""Groups and materials of the skin's polygons."""

from __future__ import annotations

import numpy as np

from .eye_loops import CREASE_ROW, EYE_COLUMNS
from .mouth_loops import BAG_FIRST_ROW, BORDER_ROW, COLUMNS_PER_LIP

__all__ = ["skin_groups", "skin_materials"]

# upper border of the neck and lower border of the scalp: z, y in the side view [mm]
_NECK = ((-70, -20, 0, 15, 35, 60, 80), (-52, -56, -70, -90, -106, -114, -117))
_SCALP = ((-40, -32, -20, 0, 20, 45, 62, 80), (-99, -30, 15, 22, 34, 50, 66, 79))
# columns on each side of the inner corner of the eye that show the caruncle
_CARUNCLE_COLUMNS = 2
_MATERIALS = {"mouth_bag": "mouth", "vermilion_upper": "lips", "vermilion_lower": "lips"}


def _mouth_group(half, index):
    band = half.labels.band[index]
    if band >= half.mouth_margin + BAG_FIRST_ROW:
        return "mouth_bag"
    if band < half.mouth_margin - BORDER_ROW:
        return "face"
    return "vermilion_upper" if half.labels.column[index] < COLUMNS_PER_LIP else "vermilion_lower"


def _eye_group(half, index, outer_corner):
    if half.labels.band[index] < half.eye_margin - CREASE_ROW:
        return "face"
    return "lid_upper_left" if half.labels.column[index] < outer_corner else "lid_lower_left"


def _fill_group(centre):
    _, y, z = centre
    if y < np.interp(z, *_NECK):
        return "neck"
    return "scalp" if y > np.interp(z, *_SCALP) else "face"


def skin_groups(half):
    """Return the group of every polygon of the left half."""
    margin = half.positions[half.eye_rows[half.eye_margin]]
    outer_corner = int(margin[:, 0].argmax())
    groups = []
    for index, polygon in enumerate(half.polygons):
        kind = half.labels.kind[index]
        if kind == "mouth":
            groups.append(_mouth_group(half, index))
        elif kind == "eye":
            groups.append(_eye_group(half, index, outer_corner))
        elif kind == "ear":
            groups.append("ear_left")
        else:
            groups.append(_fill_group(half.positions[list(polygon)].mean(axis=0)))
    return groups


def skin_materials(half, groups):
    """Return the material of every polygon of the left half."""
    materials = [_MATERIALS.get(group, "skin") for group in groups]
    for index, kind in enumerate(half.labels.kind):
        if kind == "brow":
            materials[index] = "brow"
        elif kind == "eye" and half.labels.band[index] >= half.eye_margin:
            column = half.labels.column[index]
            if min(column + 1, EYE_COLUMNS - column) <= _CARUNCLE_COLUMNS:
                materials[index] = "caruncle"
    return materials
