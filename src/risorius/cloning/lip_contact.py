"""The seam of the lips opens on the target as it does on the source."""

from __future__ import annotations

import numpy as np

from risorius._check import FloatArray, IntArray
from risorius.cloning.local_field import LocalField
from risorius.cloning.polyline import arched, interpolated, shares
from risorius.cloning.subject import Subject

__all__ = ["LipContact"]

# How far the correction reaches from the lines, and how smooth it is, as shares of the width.
_REACH, _LENGTH, _BEND = 0.45, 0.25, 0.1
# Corrections below this do nothing [mm].
_LEAST = 1e-3
# Shares at the ends of the lines over which the correction fades: the corners touch anyway.
_END = 0.06


class LipContact:
    """Corrects the difference between upper and lower contact line.

    At equal shares of the lines' lengths the lips part by the same vector on both heads, up to
    the similarity. What is missing is divided between the lips as they move, and spread over
    them smoothly along the skin.

    Parameters
    ----------
    source, target : Subject
        Both with lips.
    """

    def __init__(self, source: Subject, target: Subject) -> None:
        assert source.lips is not None
        assert target.lips is not None
        self._source = (source.lips.slit.upper, source.lips.slit.lower)
        self._target = (target.lips.slit.upper, target.lips.slit.lower)
        self._source_places = [shares(source.mesh.positions[line]) for line in self._source]
        self._places = [shares(target.mesh.positions[line]) for line in self._target]
        lips = target.lips
        near = np.asarray(lips.distance < _REACH * lips.width)
        self._field = LocalField(
            target.mesh,
            near,
            self._target,
            length=_LENGTH * lips.width,
            bend=_BEND * lips.width,
        )

    def correct(self, ours: FloatArray, theirs: FloatArray) -> FloatArray:
        """Return the correction (s, n, 3) to the target's displacements.

        Parameters
        ----------
        ours : (s, v, 3) float64
            Displacements of the source's skin, in the target's frame and size [mm].
        theirs : (s, n, 3) float64
            Displacements of the target's skin so far [mm].
        """
        count, n = theirs.shape[:2]
        goal = np.zeros((n, count, 3))
        for shape in range(count):
            for line, wanted in self._goals(ours[shape], theirs[shape]):
                goal[line, shape] = wanted
        active = np.flatnonzero((np.linalg.norm(goal, axis=2) > _LEAST).any(axis=0))
        result = np.zeros_like(theirs)
        if len(active):
            solved = self._field.solve(goal[:, active].reshape(n, -1))
            rows = self._field.vertices
            moved = solved.reshape(len(rows), len(active), 3).transpose(1, 0, 2)
            result[np.ix_(active, rows)] = moved
        return result

    def _goals(self, ours: FloatArray, theirs: FloatArray) -> list[tuple[IntArray, FloatArray]]:
        goals: list[tuple[IntArray, FloatArray]] = []
        for number, (line, place) in enumerate(zip(self._target, self._places)):
            sign = 1.0 if number == 0 else -1.0
            moved = [
                arched(ours[own], own_place, place)
                for own, own_place in zip(self._source, self._source_places)
            ]
            made = [
                interpolated(theirs[own], own_place, place)
                for own, own_place in zip(self._target, self._places)
            ]
            missing = (moved[0] - moved[1]) - (made[0] - made[1])
            size = [np.linalg.norm(part, axis=1) for part in moved]
            share = size[number] / np.maximum(size[0] + size[1], 1e-12)
            fade = np.clip(np.minimum(place, 1.0 - place) / _END, 0.0, 1.0)
            goals.append((line, sign * (share * fade)[:, None] * missing))
        return goals
