"""Shapes of the low-level MPEG-4 parameters, solved on the head that shall make them.

A parameter asks one feature point to go a distance in a direction. The controls of the face are
tried one by one, their motions at all feature points make a linear model, and bounded least
squares find the pose: the point shall go where it is asked, sideways motion and motion elsewhere
cost a little. The pose is then tried on the face itself, and what is missing is asked for again.
"""

from __future__ import annotations

from collections.abc import Callable, Collection
from dataclasses import dataclass

import numpy as np

from risorius._check import FloatArray
from risorius.controls.control import Pose
from risorius.controls.fap import THESIS_LEAVES_OUT, Fap, faps
from risorius.playback.bounded_fit import fit_bounded
from risorius.playback.reading import FapReading
from risorius.rig.face import Face

__all__ = ["FapShape", "FapShapes", "solve_fap_shapes"]

Progress = Callable[[int, int, str], None]

UNITS_ASKED = 100.0
_TOLERANCE = 0.1  # share of the asked distance
_SIDEWAYS, _ELSEWHERE, _EFFORT = 0.05, 0.004, 0.002
_EASED = 0.03  # what sideways motion, motion elsewhere and effort cost when 100 units are far
_ROUNDS = 3
_LEAST = 10.0  # units below which a shape is no answer to its parameter
_SLIGHT = 0.02  # share of a control's range that is left out of a pose


@dataclass(frozen=True)
class FapShape:
    """What came out for one parameter in one direction.

    Parameters
    ----------
    number : int
    sign : int
        1, or -1 for the opposite direction.
    pose : mapping of str to float
        Controls that make it; the shape of `reach` units.
    reach : float
        Units in the asked direction that the pose makes, at most those of the bound.
    bound : float
        Largest sane value.
    residual_at_100, residual_at_bound : float
        Missing or excess distance over the asked distance.
    """

    number: int
    sign: int
    pose: Pose
    reach: float
    bound: float
    residual_at_100: float
    residual_at_bound: float

    @property
    def name(self) -> str:
        """Name of the morph target."""
        return faps()[self.number].target + ("" if self.sign > 0 else "_neg")

    @property
    def full(self) -> bool:
        """Whether 100 units are made within a tenth of what is asked."""
        return self.residual_at_100 <= _TOLERANCE

    @property
    def made(self) -> bool:
        """Whether there is a shape at all; it may need weights above 1 for 100 units."""
        return self.full or self.reach >= _LEAST


@dataclass(frozen=True, eq=False)
class FapShapes:
    """Solved shapes of a face and what it cannot do.

    Parameters
    ----------
    shapes : tuple of FapShape
    left_out : dict of str to str
        Shapes that there are not, or in part, with the reason.
    turns : tuple of int
        Parameters that are no shape and are made all the same: players turn the whole head.
    """

    shapes: tuple[FapShape, ...]
    left_out: dict[str, str]
    turns: tuple[int, ...] = ()

    @property
    def made_count(self) -> int:
        """Number of parameters of the 66 that are made in at least one direction."""
        return len({shape.number for shape in self.shapes if shape.made} | {*self.turns})

    @property
    def full_count(self) -> int:
        """Number of parameters that reach 100 units in at least one direction."""
        return len({shape.number for shape in self.shapes if shape.full} | {*self.turns})

    @property
    def bound_count(self) -> int:
        """Number of parameters that reach their sane bound in at least one direction."""
        bounds = {s.number for s in self.shapes if s.residual_at_bound <= _TOLERANCE}
        return len(bounds | {*self.turns})

    def poses(self, *, thesis: bool = False) -> dict[str, Pose]:
        """Return the poses that are made, by target name.

        Parameters
        ----------
        thesis : bool
            Only those of the thesis's set of 84: positive direction, two parameters less.
        """
        return {
            shape.name: shape.pose
            for shape in self.shapes
            if shape.made and not (thesis and (shape.sign < 0 or shape.number in THESIS_LEAVES_OUT))
        }


@dataclass(frozen=True, eq=False)
class _Model:
    """Linear model of a face at its feature points: one column per end of a control."""

    ends: tuple[tuple[str, float], ...]
    values: FloatArray  # (k, c) parameters of each column [FAPU]
    motion: FloatArray  # (k, 3, c) motion of the points [mm]

    def pose(self, x: FloatArray) -> dict[str, float]:
        pose: dict[str, float] = {}
        for (name, value), share in zip(self.ends, x):
            if share > _SLIGHT:
                pose[name] = pose.get(name, 0.0) + float(share) * value
        return pose


def solve_fap_shapes(
    face: Face, *, numbers: Collection[int] | None = None, progress: Progress | None = None
) -> FapShapes:
    """Solve the shape of every low-level parameter on a face, in both directions where allowed.

    Parameters
    ----------
    face : Face
    numbers : collection of int, optional
        Parameters to solve; all if left out.
    progress : callable, optional
        Called with (done, all, name) before each parameter.

    Raises
    ------
    LandmarkError
        If the head lacks the landmarks of the face's units.

    Notes
    -----
    Cost: one evaluation of the face per end of a control, and up to eight per direction.
    """
    reading = FapReading.of_head(face.head)
    model = _model(face, reading)
    shapes: list[FapShape] = []
    left_out = {faps()[number].target: reason for number, reason in reading.left_out.items()}
    for row, number in enumerate(reading.numbers):
        if numbers is not None and number not in numbers:
            continue
        fap = faps()[number]
        if progress is not None:
            progress(row, len(reading.numbers), fap.target)
        for sign in (1, -1) if not fap.one_way else (1,):
            shape = _solve(face, reading, model, (row, fap, sign))
            shapes.append(shape)
            if not shape.full:
                part = " (in part)" if shape.made else ""
                left_out[shape.name + part] = f"the face makes {shape.reach:.0f} of 100 units"
    turns = tuple(n for n, fap in faps().items() if fap.turns_head)
    turns = tuple(n for n in turns if numbers is None or n in numbers)
    return FapShapes(tuple(shapes), left_out, turns)


def _model(face: Face, reading: FapReading) -> _Model:
    ends: list[tuple[str, float]] = []
    for control in face.controls:
        ends.append((control.name, control.high))
        if control.low < control.default:
            ends.append((control.name, control.low))
    values: list[FloatArray] = []
    motion: list[FloatArray] = []
    for name, value in ends:
        deltas = face.displace({name: value})
        values.append(reading.values(deltas))
        motion.append(reading.point_motion(deltas))
    return _Model(tuple(ends), np.stack(values, axis=1), np.stack(motion, axis=2))


def _solve(
    face: Face, reading: FapReading, model: _Model, wanted: tuple[int, Fap, int]
) -> FapShape:
    row, fap, sign = wanted
    bound = fap.high if sign > 0 else -fap.low
    system = _System.of(reading, model, row, ease=1.0)
    pose, reach = _reach(face, reading, system, (row, sign, bound))
    residual_at_bound = abs(bound - reach) / bound
    asked = min(UNITS_ASKED, bound)
    residual = residual_at_bound
    if asked < bound:
        if reach >= asked:
            # A rig plays the shape at a share of its weight, which is exact.
            residual = 0.0
        else:
            eased = _System.of(reading, model, row, ease=_EASED)
            smaller, near = _reach(face, reading, eased, (row, sign, asked))
            residual = abs(asked - near) / asked
            if near > reach:
                pose, reach = smaller, near
    return FapShape(fap.number, sign, pose, reach, bound, residual, residual_at_bound)


@dataclass(frozen=True, eq=False)
class _System:
    """Normal equations of one parameter; only the asked amount changes."""

    model: _Model
    gram: FloatArray  # (c, c)
    column: FloatArray  # (c,)

    @staticmethod
    def of(reading: FapReading, model: _Model, row: int, *, ease: float) -> _System:
        scale = _length_of(reading, row)
        along = model.values[row] * scale
        gram = np.outer(along, along)
        sideways = model.motion[row] - np.outer(reading.direction[row], along)
        if reading.direction[row].any():
            gram += ease * _SIDEWAYS * sideways.T @ sideways
        corners = np.sort(reading.vertices, axis=1)
        others = (corners != corners[row]).any(axis=1)
        elsewhere = model.motion[others].reshape(-1, len(along))
        gram += ease * _ELSEWHERE * elsewhere.T @ elsewhere
        gram += ease * _EFFORT * np.eye(len(along))
        return _System(model, gram, along * scale)

    def solve(self, units: float) -> FloatArray:
        count = len(self.column)
        zero, one = np.zeros(count), np.ones(count)
        return fit_bounded(self.gram, self.column * units, low=zero, high=one)


def _length_of(reading: FapReading, row: int) -> float:
    """Return what one unit is worth beside millimetres; a turn counts at an eye's radius."""
    return float(reading.unit[row]) * (12.0 if not reading.direction[row].any() else 1.0)


def _reach(
    face: Face, reading: FapReading, system: _System, wanted: tuple[int, int, float]
) -> tuple[dict[str, float], float]:
    """Return the best pose for an amount, and the units that it makes in the asked direction."""
    row, sign, units = wanted
    ask = units
    best: tuple[dict[str, float], float] = ({}, 0.0)
    for _ in range(_ROUNDS):
        pose = system.model.pose(system.solve(sign * ask))
        if not pose:
            break
        made = sign * float(reading.values(face.displace(pose))[row])
        if abs(made - units) < abs(best[1] - units):
            best = (pose, made)
        if abs(made - units) <= 0.02 * units:
            break
        ask += units - made
    return best
