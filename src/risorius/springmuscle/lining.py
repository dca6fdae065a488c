"""Lips and lids: what lies behind what, and what touches what."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from scipy.spatial import cKDTree

from risorius._check import IntArray
from risorius.anatomy.mechanics import Mechanics
from risorius.anatomy.skin import Skin

__all__ = ["lining_pairs", "sides_with_lids", "touching_lips"]

# Lining hangs on so many vertices of the skin in front of it, this near, that face away from it.
_THREADS, _DEEP, _FACING = 3, 7.0, 0.0
# Lips closer than this touch, within so many millimetres of their line [mm].
_SEAL_GAP, _SEAL_REACH = 3.5, 5.0


def lining_pairs(skin: Skin, sides: npt.NDArray[np.int8]) -> IntArray:
    """Return pairs (q, 2) of lining and the skin close in front of it: lips and lids have a depth.

    Without them skin that slides back would come out behind its own lining. The lining of one lip
    or lid never hangs on the other one; `sides` (n,) tells them apart.
    """
    lining = np.flatnonzero(skin.hidden & (skin.mass > 1e-9))
    seen = np.flatnonzero(~skin.hidden & (skin.mass > 1e-9))
    if not (len(lining) and len(seen)):
        return np.zeros((0, 2), np.int32)
    limit = _DEEP * skin.scale
    distance, near = cKDTree(skin.positions[seen]).query(
        skin.positions[lining], k=_THREADS, distance_upper_bound=limit
    )
    rows, columns = np.nonzero(np.isfinite(distance))
    first, second = lining[rows], seen[near[rows, columns]]
    facing = np.einsum("qd,qd->q", skin.normals[first], skin.normals[second]) < _FACING
    # Springs of hardly any length have no direction.
    long = np.linalg.norm(skin.positions[first] - skin.positions[second], axis=1) > 1e-3
    kept = facing & long & (sides[first] == sides[second])
    return np.stack([first[kept], second[kept]], axis=1).astype(np.int32)


def touching_lips(skin: Skin) -> IntArray:
    """Return pairs (q, 2) of the upper and the lower lip that touch: each with its nearest."""
    near = (skin.mouth.distance < _SEAL_REACH) & ~skin.hidden
    upper, lower = (np.flatnonzero(near & (side * skin.mouth.side > 0.0)) for side in (1.0, -1.0))
    if not (len(upper) and len(lower)):
        return np.zeros((0, 2), np.int32)
    limit = _SEAL_GAP * skin.scale
    parts: list[npt.NDArray[np.intp]] = []
    for own, other, turned in ((upper, lower, False), (lower, upper, True)):
        gap, nearest = cKDTree(skin.positions[other]).query(skin.positions[own])
        kept = np.asarray(gap) < limit
        pairs = np.stack([own[kept], other[nearest[kept]]], axis=1)
        parts.append(pairs[:, ::-1] if turned else pairs)
    return np.unique(np.concatenate(parts), axis=0).astype(np.int32)


def sides_with_lids(sides: npt.NDArray[np.int8], mechanics: Mechanics) -> npt.NDArray[np.int8]:
    """Return the sides (n,) of mouth and eyes: 1 and -1 for the lips, 2 and more for the lids."""
    result = sides.copy()
    for number, margins in enumerate(mechanics.margins.values()):
        near = margins.distance < 2.0 * margins.height
        result[near] = np.where(margins.upper[near], 2, 3) + 2 * number
    return result
