"""All muscles of a face, and what ties their ends together, as flat arrays."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from risorius._check import BoolArray, FloatArray, IntArray
from risorius.controls.control import Control
from risorius.controls.standard import controls_of_muscles
from risorius.errors import ParameterError
from risorius.springmuscle.muscle import JAW, FittedMuscle

if TYPE_CHECKING:
    from risorius.anatomy.jaw import JawAxes, JawPose

__all__ = ["Links", "MuscleSet"]


def _no_pairs() -> IntArray:
    return np.zeros((0, 2), np.int32)


@dataclass(frozen=True, eq=False)
class Links:
    """Ends of fibres that merge with segments of other muscles.

    Parameters
    ----------
    ends : (l, 2) int32
        Fibre and its last point, of all fibres and points of the set.
    hosts : (l, 2) int32
        Fibre and segment that the end lies in.
    groups : tuple of (g,) int32
        Segments that hang together, by number.
    yielding : float
        How much of a correction a contracting muscle takes, against 1 of a resting one.
    """

    ends: IntArray = field(default_factory=_no_pairs)
    hosts: IntArray = field(default_factory=_no_pairs)
    groups: tuple[IntArray, ...] = ()
    yielding: float = 1.0


@dataclass(frozen=True, eq=False)
class MuscleSet:
    """Muscles of one head with p control points and s ellipsoids in f fibres.

    Parameters
    ----------
    muscles : tuple of FittedMuscle
        Names are unique.
    links : Links
    """

    muscles: tuple[FittedMuscle, ...]
    links: Links = field(default_factory=Links)

    def __post_init__(self) -> None:
        names = [muscle.name for muscle in self.muscles]
        twice = sorted({name for name in names if names.count(name) > 1})
        if twice:
            raise ParameterError(f"muscles: {', '.join(twice)} is there twice; names are unique")

    @property
    def controls(self) -> tuple[Control, ...]:
        """Controls of the muscles, registered ones first; several muscles may share one."""
        names = dict.fromkeys(muscle.action.control for muscle in self.muscles)
        return controls_of_muscles(tuple(names))

    def contractions(self, values: Mapping[str, float]) -> FloatArray:
        """Return the contraction (k,) of every muscle for controls in 0..1, others clamped."""
        return np.array(
            [
                min(max(values.get(m.action.control, 0.0), 0.0), 1.0) * m.action.max_contraction
                for m in self.muscles
            ]
        )

    @cached_property
    def symmetric(self) -> bool:
        """Whether every muscle of a side has its exact mirror image."""
        sided = {m.action.control for m in self.muscles if m.side}
        paired = {c.name: c.mirror for c in self.controls if c.name in sided}
        return all(
            self._is_even(one) if one == other else self.twins(one, other)
            for one, other in paired.items()
        )

    def _is_even(self, control: str) -> bool:
        """Return whether the sided muscles of one control are each other's mirror images."""
        muscles = {m.name: m for m in self.muscles if m.action.control == control and m.side}
        for name, muscle in muscles.items():
            twin = muscles.get(name[:-2] + {1: "_r", -1: "_l"}[muscle.side])
            if twin is None or twin.action != muscle.action:
                return False
            if not np.array_equal(_points(muscle) * [-1.0, 1.0, 1.0], _points(twin)):
                return False
        return True

    def twins(self, one: str, other: str) -> bool:
        """Return whether the muscles of two controls are exact mirror images of each other."""
        first, second = (
            {m.name: m for m in self.muscles if m.action.control == name} for name in (one, other)
        )
        if one == other or len(first) != len(second):
            return False
        for name, muscle in first.items():
            twin = second.get(name[:-2] + {"_l": "_r", "_r": "_l"}.get(name[-2:], name[-2:]))
            if twin is None or replace(twin.action, control=one) != muscle.action:
                return False
            if not np.array_equal(_points(muscle) * [-1.0, 1.0, 1.0], _points(twin)):
                return False
        return True

    @cached_property
    def points(self) -> FloatArray:
        """Relaxed control points (p, 3) [mm]."""
        return _stacked([fibre.points for m in self.muscles for fibre in m.fibres], (0, 3))

    @cached_property
    def bones(self) -> npt.NDArray[np.int8]:
        """Bone (p,) of every control point."""
        parts = [fibre.bones for m in self.muscles for fibre in m.fibres]
        return np.concatenate(parts) if parts else np.zeros(0, np.int8)

    @cached_property
    def fibre_starts(self) -> IntArray:
        """First point (f + 1,) of every fibre, and p; fibre f has segments from start - f on."""
        counts = [len(fibre.points) for m in self.muscles for fibre in m.fibres]
        return np.concatenate([[0], np.cumsum(counts)]).astype(np.int32)

    @cached_property
    def fibre_muscle(self) -> IntArray:
        """Muscle (f,) of every fibre."""
        counts = [len(m.fibres) for m in self.muscles]
        return np.repeat(np.arange(len(counts)), counts).astype(np.int32)

    @cached_property
    def segment_fibre(self) -> IntArray:
        """Fibre (s,) of every segment."""
        counts = np.diff(self.fibre_starts) - 1
        return np.repeat(np.arange(len(counts)), counts).astype(np.int32)

    @cached_property
    def segment_muscle(self) -> IntArray:
        """Muscle (s,) of every segment."""
        return self.fibre_muscle[self.segment_fibre]

    @cached_property
    def point_muscle(self) -> IntArray:
        """Muscle (p,) of every control point."""
        return np.repeat(self.fibre_muscle, np.diff(self.fibre_starts)).astype(np.int32)

    @cached_property
    def segment_points(self) -> IntArray:
        """Control point (s,) that every segment begins at; it ends at the next one."""
        return (np.arange(len(self.segment_fibre)) + self.segment_fibre).astype(np.int32)

    @cached_property
    def centres(self) -> FloatArray:
        """Centres of the relaxed ellipsoids (s, 3) [mm]."""
        first = self.segment_points
        return 0.5 * (self.points[first] + self.points[first + 1])

    @cached_property
    def lengths(self) -> FloatArray:
        """Relaxed lengths of the segments (s,) [mm]."""
        first = self.segment_points
        return np.linalg.norm(self.points[first + 1] - self.points[first], axis=1)

    @cached_property
    def half_axes(self) -> FloatArray:
        """Half length, width and height of the ellipsoids (s, 3) [mm]."""
        return _stacked([fibre.half_axes for m in self.muscles for fibre in m.fibres], (0, 3))

    @cached_property
    def frames(self) -> FloatArray:
        """Frames of the relaxed ellipsoids (s, 3, 3), unit vectors in the columns."""
        return _stacked([fibre.frames for m in self.muscles for fibre in m.fibres], (0, 3, 3))

    @cached_property
    def lips(self) -> npt.NDArray[np.int8]:
        """Lip (s,) above every segment: 1 upper, -1 lower, 0 neither."""
        parts = [fibre.lips for m in self.muscles for fibre in m.fibres]
        return np.concatenate(parts) if parts else np.zeros(0, np.int8)

    @cached_property
    def aims(self) -> FloatArray:
        """Where each control point of a sphincter is drawn to (p, 3), itself elsewhere [mm]."""
        parts = [
            fibre.points if fibre.aims is None else fibre.aims
            for m in self.muscles
            for fibre in m.fibres
        ]
        return _stacked(parts, (0, 3))

    @cached_property
    def shares(self) -> FloatArray:
        """Share of its muscle's contraction (p,) that acts at each control point."""
        parts = [
            np.ones(len(fibre.points)) if fibre.shares is None else fibre.shares
            for m in self.muscles
            for fibre in m.fibres
        ]
        return _stacked(parts, (0,))

    @cached_property
    def ring_muscles(self) -> BoolArray:
        """Which muscles (k,) are sphincters."""
        return np.array([m.sphincter for m in self.muscles], bool)

    def moved_with_jaw(self, jaw: JawAxes, pose: JawPose) -> tuple[FloatArray, FloatArray]:
        """Return points and aims (p, 3) after the jaw has moved, each row with its own bone.

        A sphincter with points on both bones is drawn to the mean of its aim on the skull and of
        its aim on the jaw (erratum E9).
        """
        share = (self.bones == JAW).astype(np.float64)
        points = jaw.move(self.points, pose, share=share)
        count = np.bincount(self.point_muscle, minlength=len(self.muscles))
        lower = np.bincount(self.point_muscle, share, minlength=len(self.muscles))
        between = (lower > 0.0) & (lower < count)
        fixed = np.where(between[self.point_muscle], 0.5, share)
        swung = jaw.move(self.aims, pose)
        aims = self.aims + fixed[:, None] * (swung - self.aims)
        return points, np.where(self.ring_muscles[self.point_muscle, None], aims, points)


def _points(muscle: FittedMuscle) -> FloatArray:
    return np.concatenate([fibre.points for fibre in muscle.fibres])


def _stacked(parts: list[FloatArray], empty: tuple[int, ...]) -> FloatArray:
    return np.concatenate(parts) if parts else np.zeros(empty)
