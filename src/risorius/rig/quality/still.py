"""Zones of a head that no expression may move, and how far they drift."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from risorius._check import BoolArray, FloatArray
from risorius.head.head import Head
from risorius.rig.rig import Rig

__all__ = ["Drift", "drifts", "still_zone"]

_EARS = (("10.1", "10.3"), ("10.2", "10.4"))


@dataclass(frozen=True)
class Drift:
    """Motion where there must be none.

    Parameters
    ----------
    largest : float
        Longest motion of a vertex in any still zone [mm].
    zone : str
        The zone with it, empty if nothing drifts.
    """

    largest: float
    zone: str


def still_zone(head: Head) -> dict[str, BoolArray]:
    """Return the zones that every expression leaves alone, as masks (n,) over the file's vertices.

    With h the height from the chin (2.1) to the middle of the eyes:

    - ``back``: skin more than 0.12 h behind the backs of the ears (10.3, 10.4; without them 1.1 h
      behind the outer eye corners);
    - ``skull_top``: skin above three quarters of the height from the hairline to the top (11.1,
      11.4; without them 0.9 h above the eyes); the forehead's muscle moves the scalp below;
    - ``ears``: skin within 0.08 h of the line from the top to the back of an ear; the lobe may
      follow the jaw;
    - ``neck_base``: skin more than 0.6 h below the chin;
    - ``teeth_upper``: the upper teeth.

    A zone without vertices is absent; so are all but the teeth without 2.1.

    Parameters
    ----------
    head : Head
    """
    zones: dict[str, BoolArray] = {}
    marks, skin = head.landmarks, head.skin
    points = skin.mesh.positions

    def add(name: str, mask: BoolArray) -> None:
        if mask.any():
            zones[name] = np.zeros(head.vertex_count, bool)
            zones[name][skin.source] = mask[skin.welded]

    if "2.1" in marks:
        eyes = marks.positions(("3.7", "3.11", "3.8", "3.12")).mean(axis=0)
        chin = marks.position("2.1")
        height = float(eyes[1] - chin[1])
        if marks.missing(("10.3", "10.4")):
            behind = float(marks.positions(("3.7", "3.12"))[:, 2].mean()) - 1.1 * height
        else:
            behind = float(marks.positions(("10.3", "10.4"))[:, 2].min()) - 0.12 * height
        add("back", points[:, 2] < behind)
        if marks.missing(("11.1", "11.4")):
            top = float(eyes[1]) + 0.9 * height
        else:
            top = float(np.array([0.25, 0.75]) @ marks.positions(("11.1", "11.4"))[:, 1])
        add("skull_top", points[:, 1] > top)
        near = np.full(len(points), np.inf)
        for names in _EARS:
            if not marks.missing(names):
                near = np.minimum(near, _distance_to_line(points, marks.positions(names)))
        add("ears", near < 0.08 * height)
        add("neck_base", points[:, 1] < chin[1] - 0.6 * height)
    teeth = head.part("teeth_upper")
    if teeth is not None:
        zones["teeth_upper"] = np.zeros(head.vertex_count, bool)
        zones["teeth_upper"][teeth.source] = True
    return zones


def _distance_to_line(points: FloatArray, line: FloatArray) -> FloatArray:
    """Return the distance (n,) of points to a polyline (k, 3) [mm]."""
    nearest = np.full(len(points), np.inf)
    for start, end in pairwise(line):
        span = end - start
        along = (points - start) @ span / max(float(span @ span), 1e-12)
        foot = start + np.clip(along, 0.0, 1.0)[:, None] * span
        nearest = np.minimum(nearest, np.linalg.norm(points - foot, axis=1))
    return nearest


def drifts(rig: Rig, zones: Mapping[str, BoolArray], scale: float) -> list[Drift]:
    """Measure the motion of still zones in every shape.

    Parameters
    ----------
    rig : Rig
    zones : mapping of str to (n,) bool
        From `still_zone`.
    scale : float
        Length of a file unit [mm].
    """
    names: Sequence[str] = tuple(zones)
    result: list[Drift] = []
    for target in rig.targets:
        length = scale * np.linalg.norm(target.deltas, axis=1)
        longest = [float(length[zones[name][target.vertices]].max(initial=0.0)) for name in names]
        worst = max(longest, default=0.0)
        result.append(Drift(worst, names[longest.index(worst)] if worst > 0.0 else ""))
    return result
