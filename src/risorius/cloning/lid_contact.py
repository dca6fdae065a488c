"""Lids close on the target as far as they do on the source, outside the target's own eyeball."""

from __future__ import annotations

import numpy as np

from risorius._check import FloatArray, IntArray
from risorius.anatomy.radial_surface import RadialSurface
from risorius.anatomy.smooth_step import smooth_step
from risorius.cloning.local_field import LocalField
from risorius.cloning.polyline import interpolated, line_trust, shares
from risorius.cloning.subject import Subject
from risorius.head.part_geometry import fit_sphere
from risorius.mesh.lids import LidMargins

__all__ = ["EyeClearance", "LidContact"]

_PLACES = np.linspace(0.06, 0.94, 15)
_REACH, _LENGTH, _BEND = 1.3, 0.5, 0.25
# The correction sets in where less than the first share of the gap is left, fully below the
# second: lids that close, not lids that squint.
_ONSET, _FULL = 0.5, 0.2
_LEAST = 5e-3
# Distance that lids keep from the eyeball unless they are nearer at rest [mm].
_CLEARANCE = 0.25


class LidContact:
    """Corrects the gap between the margins of one eye.

    Parameters
    ----------
    source, target : Subject
        Both with this eye's lids.
    side : {"l", "r"}
    """

    def __init__(self, source: Subject, target: Subject, side: str) -> None:
        self._source = _Margins(source, source.lids[side])
        self._target = _Margins(target, target.lids[side])
        self._trust = line_trust(self._source.lines, self._target.lines)
        margins = target.lids[side]
        near = np.asarray(margins.distance < _REACH * margins.height)
        self._field = LocalField(
            target.mesh,
            near,
            self._target.lines,
            length=_LENGTH * margins.height,
            bend=_BEND * margins.height,
        )

    def correct(self, ours: FloatArray, theirs: FloatArray) -> FloatArray | None:
        """Return the correction (n, 3) [mm] for one shape, or None where none is needed.

        Parameters
        ----------
        ours : (v, 3) float64
            Displacement of the source's skin [mm, its own frame].
        theirs : (n, 3) float64
            Displacement of the target's skin so far [mm].
        """
        wanted, travel = self._source.gap_shares(ours)
        made, _ = self._target.gap_shares(theirs)
        onset = self._trust * smooth_step((_ONSET - wanted) / (_ONSET - _FULL))
        missing = onset * (wanted - made) * self._target.opening
        if np.abs(missing).max() < _LEAST:
            return None
        goal = np.zeros((len(theirs), 3))
        for number, line in enumerate(self._target.lines):
            part = missing * (travel if number == 0 else travel - 1.0)
            place = self._target.places[number]
            step = np.interp(place, _PLACES, part)
            step *= np.clip(np.minimum(place, 1.0 - place) / _PLACES[0], 0.0, 1.0)
            direction = interpolated(self._target.direction, _PLACES, place)
            goal[line] = step[:, None] * direction
        result = np.zeros_like(theirs)
        result[self._field.vertices] = self._field.solve(goal)
        return result


class _Margins:
    """The two margins of an eye at rest, sampled at equal shares."""

    def __init__(self, subject: Subject, margins: LidMargins) -> None:
        self.lines: tuple[IntArray, IntArray] = (margins.slit.upper, margins.slit.lower)
        rest = subject.mesh.positions
        self.places = [shares(rest[line]) for line in self.lines]
        upper, lower = (
            interpolated(rest[line], place, _PLACES) for line, place in zip(self.lines, self.places)
        )
        apart = upper - lower
        length = np.linalg.norm(apart, axis=1)
        self.direction = apart / np.maximum(length, 1e-9)[:, None]
        self.opening = np.maximum(length, 1e-9)

    def gap_shares(self, deltas: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return what is left of the gap at each place (k,), and the upper lid's share of it."""
        upper, lower = (
            np.einsum("kj,kj->k", interpolated(deltas[line], place, _PLACES), self.direction)
            for line, place in zip(self.lines, self.places)
        )
        travel = np.abs(upper) / np.maximum(np.abs(upper) + np.abs(lower), 1e-12)
        return 1.0 + (upper - lower) / self.opening, travel


class EyeClearance:
    """Keeps moving lids outside the eyeball.

    Parameters
    ----------
    subject : Subject
        With the lids and the eyeball of this side.
    side : {"l", "r"}
    """

    def __init__(self, subject: Subject, side: str) -> None:
        part = subject.head.parts[_EYES[side]]
        margins = subject.lids[side]
        self.centre = fit_sphere(part.mesh.positions)[0]
        self._surface = RadialSurface.of_mesh(part.mesh, self.centre)
        rest = subject.mesh.positions
        near = (margins.distance < _REACH * margins.height) & (rest[:, 2] > self.centre[2])
        self.vertices = np.flatnonzero(near).astype(np.int32)
        self._rest = rest[self.vertices]
        arm = self._rest - self.centre
        rest_gap = np.linalg.norm(arm, axis=1) - self._surface.radius(arm)
        self._floor = np.minimum(rest_gap, _CLEARANCE)

    def depth(self, deltas: FloatArray) -> FloatArray:
        """Return how far (n,) each vertex of the skin lies too deep, 0 where none does [mm]."""
        moved = deltas[self.vertices]
        arm = self._rest + moved - self.centre
        least = self._surface.radius(arm) + self._floor
        lift = np.maximum(least - np.linalg.norm(arm, axis=1), 0.0)
        result = np.zeros(len(deltas))
        result[self.vertices] = np.where(moved.any(axis=1), lift, 0.0)
        return result

    def outwards(self, deltas: FloatArray) -> FloatArray:
        """Return the unit vectors (k, 3) from the centre to the moved `vertices`."""
        arm = self._rest + deltas[self.vertices] - self.centre
        return arm / np.maximum(np.linalg.norm(arm, axis=1, keepdims=True), 1e-9)

    @staticmethod
    def possible(subject: Subject, side: str) -> bool:
        """Return whether the head has both the lids and the eyeball."""
        part = subject.head.part(_EYES[side])
        return side in subject.lids and part is not None and part.vertex_count >= 12


_EYES = {"l": "eye_left", "r": "eye_right"}
