"""Lips that stay closed on the source open no farther on the target than they are at rest."""

from __future__ import annotations

import numpy as np

from risorius._check import FloatArray
from risorius.anatomy.smooth_step import smooth_step
from risorius.cloning.lip_sight import LIP_PLACES, LipSight
from risorius.cloning.local_field import LocalField
from risorius.cloning.polyline import interpolated, line_trust, shares
from risorius.cloning.subject import Subject, turned_head

__all__ = ["LipSeal"]

# Lips that the source opens by less than the first share of the mouth's width count as closed,
# beyond the second as open.
_CLOSED, _OPEN = 0.02, 0.08
# Gaps that grow by less than this share of the width more than the source's are left alone.
_ALIKE, _ROUNDS = 0.01, 4
# Reach and smoothness of the correction, as shares of the mouth's width.
_REACH, _LENGTH, _BEND = 0.25, 0.12, 0.04


class LipSeal:
    """Closes what gapes: the corners of a mouth that smiles with its lips together.

    Contact lines part on both heads alike; whether one sees that depends on how the lips fold at
    the corners. What is seen from the front is compared here: the gap of the target may grow as
    much as that of the source.

    Parameters
    ----------
    source, target : Subject
        Both with lips.
    turn : (3, 3) float64
        Rotation of the target against the source.
    scale : float
        Size of the target over the source [1].
    """

    def __init__(self, source: Subject, target: Subject, *, turn: FloatArray, scale: float) -> None:
        assert source.lips is not None
        assert target.lips is not None
        self._turn, self._scale = turn, scale
        self._source = LipSight(source.head, source.lips)
        self._target = LipSight(turned_head(target.head, turn.T), target.lips)
        self._rest = target.mesh.positions @ turn
        self._width = target.lips.width
        slit = target.lips.slit
        self._lines = (slit.upper, slit.lower)
        self._trust = line_trust((source.lips.slit.upper, source.lips.slit.lower), self._lines)
        self._shares = [shares(target.mesh.positions[line]) for line in self._lines]
        self._source_rest = self._source.gaps(np.zeros_like(source.mesh.positions))
        self._target_rest = self._target.gaps(np.zeros_like(self._rest))
        near = np.asarray(target.lips.distance < _REACH * self._width)
        self._field = LocalField(
            target.mesh,
            near,
            self._lines,
            length=_LENGTH * self._width,
            bend=_BEND * self._width,
        )

    def correct(self, ours: FloatArray, theirs: FloatArray) -> FloatArray | None:
        """Return the correction (n, 3) [mm] for one shape, or None where nothing gapes.

        Parameters
        ----------
        ours : (v, 3) float64
            Displacement of the source's skin [mm, its own frame].
        theirs : (n, 3) float64
            Displacement of the target's skin so far [mm].
        """
        moved = theirs @ self._turn
        if self._trust == 0.0 or not (self._parting(moved) > _ALIKE * self._width).any():
            return None
        seen = self._target.gaps(moved)
        if not (seen > self._target_rest + _ALIKE * self._width).any():
            return None
        grown = np.maximum(self._scale * (self._source.gaps(ours) - self._source_rest), 0.0)
        closed = self._trust - self._trust * smooth_step(
            (grown / self._width - _CLOSED) / (_OPEN - _CLOSED)
        )
        if not closed.any():
            return None
        limit = self._target_rest + grown + _ALIKE * self._width
        result = np.zeros_like(theirs)
        for _ in range(_ROUNDS):
            # Lips that roll in show a gap without parting.
            excess = closed * np.clip(seen - limit, 0.0, np.maximum(self._parting(moved), 0.0))
            if not excess.any():
                break
            goal = np.zeros_like(theirs)
            for line, sign in zip(self._lines, (-0.5, 0.5)):
                place = self._target.places(self._rest + moved, line)
                step = np.interp(place, LIP_PLACES, excess, left=0.0, right=0.0)
                goal[line] = sign * step[:, None] * self._target.up
            step = np.zeros_like(theirs)
            step[self._field.vertices] = self._field.solve(goal)
            result, moved = result + step, moved + step
            seen = self._target.gaps(moved)
        return result @ self._turn.T if result.any() else None

    def _parting(self, moved: FloatArray) -> FloatArray:
        """Return how far (25,) the contact lines part at each place, by the motion alone [mm]."""
        upper, lower = (
            interpolated(moved[line], place, LIP_PLACES) @ self._target.up
            for line, place in zip(self._lines, self._shares)
        )
        return upper - lower
