"""Lids close on the target as far as they do on the source, outside the target's own eyeball."""

from __future__ import annotations

import numpy as np

from risorius._check import FloatArray, IntArray
from risorius.anatomy.radial_surface import RadialSurface
from risorius.anatomy.smooth_step import smooth_step
from risorius.cloning.local_field import LocalField
from risorius.cloning.polyline import interpolated, line_trust
from risorius.cloning.subject import Subject, turned_head
from risorius.head.part_geometry import fit_sphere
from risorius.rig.quality.lid_gap import LID_PLACES, LidSight

__all__ = ["EyeClearance", "LidContact"]

_REACH, _LENGTH, _BEND = 1.3, 0.5, 0.25
# The correction sets in where less than the first share of the gap is left, fully below the
# second: lids that close, not lids that squint.
_ONSET, _FULL = 0.5, 0.2
# What differs by less than this share of the opening is left alone, twice what the lines of sight
# resolve; how often lids are looked at again.
_ALIKE, _ROUNDS = 0.015, 8
# Openings at one place below this share of the eye's largest are corners or covered by a hood.
_NARROW = 0.25
# Distance that lids keep from the eyeball unless they are nearer at rest [mm].
_CLEARANCE = 0.25


# Margins are moved by polynomials of this degree along the eye: no place by itself.
_DEGREE = 3
_BASIS = np.polynomial.legendre.legvander(2.0 * LID_PLACES - 1.0, _DEGREE)
_SMOOTHED = _BASIS @ np.linalg.pinv(_BASIS)


class LidContact:
    """Corrects the gap between the lids of one eye.

    What is left of the gap is measured as one sees it from the centre of the eyeball, the same on
    both heads (`risorius.rig.quality.lid_gap.LidSight`): margins may be rounded, hooded or traced
    one ring of vertices off. The margins are moved by what is missing, each lid by its share of
    the source's motion, and looked at again.

    Parameters
    ----------
    source, target : Subject
        Both with this eye's lids.
    side : {"l", "r"}
    turn : (3, 3) float64, optional
        Rotation of the target against the source: both are looked at from the same side.
    """

    def __init__(
        self, source: Subject, target: Subject, side: str, *, turn: FloatArray | None = None
    ) -> None:
        self._source = _Lids(source, side, np.eye(3))
        self._target = _Lids(target, side, np.eye(3) if turn is None else turn)
        self._trust = line_trust(self._source.lines, self._target.lines)
        if not (self._source.is_seen and self._target.is_seen):
            self._trust = 0.0
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
        if self._trust == 0.0 or self._source.least_left(ours) >= _ONSET:
            return None
        wanted, travel = self._source.gap(ours), self._source.upper_share(ours)
        onset = self._trust * smooth_step((_ONSET - float(wanted.max())) / (_ONSET - _FULL))
        if not onset > 0.0:
            return None
        result = np.zeros_like(theirs)
        for _ in range(_ROUNDS):
            missing = onset * (wanted - self._target.gap(theirs + result, wanted))
            if np.abs(missing).max() < _ALIKE:
                break
            missing = _SMOOTHED @ missing
            goal = np.zeros((len(theirs), 3))
            for line, step in self._target.steps(missing, travel):
                goal[line] = step
            result[self._field.vertices] += self._field.solve(goal)
        return result if result.any() else None


class _Lids:
    """The lids of one eye: how much of its gap a pose leaves, and how to change that.

    Gaps are shares of the eye's largest opening at rest.
    """

    def __init__(self, subject: Subject, side: str, turn: FloatArray) -> None:
        margins = subject.lids[side]
        self.lines: tuple[IntArray, IntArray] = (margins.slit.upper, margins.slit.lower)
        self._turn = turn
        head = turned_head(subject.head, turn.T)
        rest = head.skin.mesh.positions
        still = np.zeros_like(rest)
        self._sight = LidSight(head, margins, side)
        self._opening = max(self._sight.opening, 1e-9)
        self._rest = self._sight.gaps(still) / self._opening
        self._rest_apart = self._sight.apart(self.lines, still) / self._opening
        self._places = [self._sight.places(rest[line]) for line in self.lines]
        upper, lower = (self._at_places(rest[line], k) for k, line in enumerate(self.lines))
        apart = upper - lower
        self._direction = apart / np.maximum(np.linalg.norm(apart, axis=1), 1e-9)[:, None]
        self._arm = np.linalg.norm(0.5 * (upper + lower) - self._sight.centre, axis=1)

    @property
    def is_seen(self) -> bool:
        """Whether one sees anything of the eye at rest."""
        return self._sight.opening > 0.0

    def gap(self, moved: FloatArray, wanted: FloatArray | None = None) -> FloatArray:
        """Return what is left (9,) of the gap at each place, < 0 where the margins pass.

        Parameters
        ----------
        moved : (n, 3) float64
            Displacement of the skin [mm].
        wanted : (9,) float64, optional
            Where a gap is wanted and none is seen, margins that a hood covers pass each other
            from where they stand apart as far as at rest beyond what is seen.
        """
        moved = moved @ self._turn
        seen = self._sight.gaps(moved) / self._opening
        apart = self._sight.apart(self.lines, moved) / self._opening
        if wanted is not None:
            covered = np.maximum(self._rest_apart - self._rest, 0.0)
            apart = np.where((wanted > 0.0) & (self._rest > _NARROW), apart - covered, apart)
        return np.where(seen > 0.0, seen, np.minimum(apart, 0.0))

    def least_left(self, moved: FloatArray) -> float:
        """Return what is left of the gap where least is, by the margins alone: cheap."""
        change = (
            self._sight.apart(self.lines, moved @ self._turn) / self._opening - self._rest_apart
        )
        return 1.0 + float((change / np.maximum(self._rest, _NARROW)).min())

    def upper_share(self, moved: FloatArray) -> FloatArray:
        """Return the upper lid's share (9,) of the motion that closes the eye."""
        turned = moved @ self._turn
        upper, lower = (
            np.abs(np.einsum("kj,kj->k", self._at_places(turned[line], k), self._direction))
            for k, line in enumerate(self.lines)
        )
        return upper / np.maximum(upper + lower, 1e-12)

    def steps(self, missing: FloatArray, share: FloatArray) -> list[tuple[IntArray, FloatArray]]:
        """Return how each margin (k,) must move (k, 3) to open the gap by `missing` (9,) [mm]."""
        result: list[tuple[IntArray, FloatArray]] = []
        for number, line in enumerate(self.lines):
            part = missing * self._opening * self._arm * (share if number == 0 else share - 1.0)
            place = self._places[number]
            step = np.interp(place, LID_PLACES, part)
            step *= np.clip(np.minimum(place, 1.0 - place) / LID_PLACES[0], 0.0, 1.0)
            direction = interpolated(self._direction, LID_PLACES, place)
            result.append((line, step[:, None] * direction @ self._turn.T))
        return result

    def _at_places(self, values: FloatArray, number: int) -> FloatArray:
        place = self._places[number]
        order = np.argsort(place, kind="stable")
        return interpolated(values[order], place[order], LID_PLACES)


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
