"""Lid margins that correspond, traced again where the heads' eye landmarks do not."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from risorius._check import FloatArray, IntArray
from risorius.cloning.polyline import nearest_on_line
from risorius.cloning.subject import Subject
from risorius.errors import MeshError
from risorius.head.eyes import EYE_LANDMARKS
from risorius.mesh.lids import LidMargins, find_lids

__all__ = ["LidPair", "trusted_lids"]

# A target whose margins have this many times the vertices of the source's is finer.
_FINER = 1.4


class LidPair(NamedTuple):
    """The margins of one eye on both heads."""

    source: LidMargins
    target: LidMargins


def trusted_lids(
    source: Subject, target: Subject, fitted: FloatArray, lines: tuple[str, ...]
) -> dict[str, LidPair]:
    """Return corresponding margins of each eye that both heads have, by side.

    Parameters
    ----------
    source, target : Subject
    fitted : (v, 3) float64
        The source's skin, registered [mm].
    lines : tuple of str
        Contact lines that took part in the fit: these are trusted. Of the others one head's is
        kept and the other's traced again from where the landmarks of the first came to lie; kept
        is the source's, unless the target's mesh is much finer.
    """
    result: dict[str, LidPair] = {}
    seen = [np.flatnonzero(each.cavity < 2).astype(np.int32) for each in (target, source)]
    for side, own in source.lids.items():
        given = target.lids.get(side)
        if given is None:
            continue
        result[side] = LidPair(own, given)
        if f"lid_upper_{side}" in lines:
            continue
        names = EYE_LANDMARKS[side]
        if len(given.slit.upper) > _FINER * len(own.slit.upper):
            wanted = target.mesh.positions[[target.head.skin_vertex(name) for name in names]]
            again = _retraced(source, fitted, seen[1], wanted)
            pair = None if again is None else LidPair(again, given)
        else:
            wanted = fitted[[source.head.skin_vertex(name) for name in names]]
            again = _retraced(target, target.mesh.positions, seen[0], wanted)
            pair = None if again is None else LidPair(own, again)
        if pair is not None and _miss(pair, fitted, target) < _miss(result[side], fitted, target):
            result[side] = pair
    return result


def _retraced(
    subject: Subject, positions: FloatArray, seen: IntArray, wanted: FloatArray
) -> LidMargins | None:
    """Trace a head's margins from the vertices that lie nearest to `wanted` (4, 3)."""
    nearest = cKDTree(positions[seen]).query(wanted)[1]
    inner, outer, upper, lower = (int(seen[row]) for row in np.atleast_1d(nearest).tolist())
    if len({inner, outer, upper, lower}) < 4:
        return None
    try:
        return find_lids(subject.mesh, inner=inner, outer=outer, upper=upper, lower=lower)
    except MeshError:
        return None


def _miss(pair: LidPair, fitted: FloatArray, target: Subject) -> float:
    own, other = pair
    total = 0.0
    for line, there in ((own.slit.upper, other.slit.upper), (own.slit.lower, other.slit.lower)):
        points = fitted[line]
        nearest = nearest_on_line(points, target.mesh.positions[there])
        total += float(np.linalg.norm(nearest - points, axis=1).mean())
    return total
