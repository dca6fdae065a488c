"""The target's lid margins, found again where its own eye landmarks are off."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from risorius._check import FloatArray
from risorius.cloning.polyline import nearest_on_line
from risorius.cloning.subject import Subject
from risorius.errors import MeshError
from risorius.head.eyes import EYE_LANDMARKS
from risorius.mesh.lids import LidMargins, find_lids

__all__ = ["trusted_lids"]


def trusted_lids(
    source: Subject, target: Subject, fitted: FloatArray, lines: tuple[str, ...]
) -> dict[str, LidMargins]:
    """Return the margins of each eye of the target that both heads have, by side.

    Parameters
    ----------
    source, target : Subject
    fitted : (v, 3) float64
        The source's skin, registered [mm].
    lines : tuple of str
        Contact lines that took part in the fit: these are trusted. The others are traced again
        from where the source's landmarks came to lie, and the line nearer to the source's counts.
    """
    result: dict[str, LidMargins] = {}
    for side, own in source.lids.items():
        given = target.lids.get(side)
        if given is not None and f"lid_upper_{side}" in lines:
            result[side] = given
            continue
        candidates = [each for each in (given, _retraced(source, target, fitted, side)) if each]
        if candidates:
            result[side] = min(candidates, key=lambda each: _miss(own, each, fitted, target))
    return result


def _retraced(source: Subject, target: Subject, fitted: FloatArray, side: str) -> LidMargins | None:
    seen = np.flatnonzero(target.cavity < 2)
    wanted = fitted[[source.head.skin_vertex(name) for name in EYE_LANDMARKS[side]]]
    nearest = cKDTree(target.mesh.positions[seen]).query(wanted)[1]
    inner, outer, upper, lower = (int(seen[row]) for row in np.atleast_1d(nearest).tolist())
    if len({inner, outer, upper, lower}) < 4:
        return None
    try:
        return find_lids(target.mesh, inner=inner, outer=outer, upper=upper, lower=lower)
    except MeshError:
        return None


def _miss(own: LidMargins, other: LidMargins, fitted: FloatArray, target: Subject) -> float:
    total = 0.0
    for line, there in ((own.slit.upper, other.slit.upper), (own.slit.lower, other.slit.lower)):
        points = fitted[line]
        nearest = nearest_on_line(points, target.mesh.positions[there])
        total += float(np.linalg.norm(nearest - points, axis=1).mean())
    return total
