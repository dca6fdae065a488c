"""From the values of a genome to a face that can be looked at."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np

from risorius._check import FloatArray
from risorius.controls.control import Pose, resolve_pose
from risorius.errors import ParameterError
from risorius.rig.face import Face
from risorius.tuning.genome import Genome, Parameter

__all__ = [
    "Candidates",
    "FaceCandidates",
    "FunctionCandidates",
    "Gallery",
    "PoseCandidates",
    "paired_controls",
    "sensitivity_of",
]


class Candidates(Protocol):
    """Something with named bounded parameters that makes a face."""

    @property
    def genome(self) -> Genome:
        """What may be tuned."""
        ...

    def positions(self, values: Mapping[str, float]) -> FloatArray:
        """Return the vertices (n, 3) of the candidate with these values [mm]."""
        ...


class FaceCandidates(Candidates, Protocol):
    """Muscles with genes, in one expression."""

    @property
    def pose(self) -> Pose:
        """The expression that is looked at."""
        ...

    def face_of(self, values: Mapping[str, float]) -> Face:
        """Return the face whose muscles have these values; others stay as they are."""
        ...


@dataclass(frozen=True, eq=False)
class FunctionCandidates:
    """Any function of named parameters: stiffness, thickness, outline points.

    Parameters
    ----------
    genome : Genome
    make : callable
        From values by name to vertices (n, 3) [mm].
    """

    genome: Genome
    make: Callable[[Mapping[str, float]], FloatArray]

    def positions(self, values: Mapping[str, float]) -> FloatArray:
        """Return the vertices (n, 3) of the candidate with these values [mm]."""
        return self.make(values)


@dataclass(frozen=True, eq=False)
class PoseCandidates:
    """A preset of any face: how far each control goes.

    Parameters
    ----------
    face : Face
    pose : mapping of str to float
        The preset before tuning; its controls are what is tuned.
    mirror : bool
        Controls of both sides that start equal stay equal; one parameter, named without side,
        drives both.
    """

    face: Face
    pose: Pose
    mirror: bool = True

    @property
    def genome(self) -> Genome:
        """One parameter for each control of the pose, in the control's range."""
        return self._genome

    @cached_property
    def _genome(self) -> Genome:
        ranges = {control.name: control for control in self.face.controls}
        values = resolve_pose(self.face.controls, self.pose).values
        parameters = [
            Parameter(name, ranges[group[0]].low, ranges[group[0]].high, values[group[0]])
            for name, group in self._groups.items()
        ]
        return Genome(tuple(parameters))

    def pose_of(self, values: Mapping[str, float]) -> Pose:
        """Return the preset with these values."""
        return {control: values[name] for name, group in self._groups.items() for control in group}

    def positions(self, values: Mapping[str, float]) -> FloatArray:
        """Return the vertices (n, 3) of the candidate with these values [mm]."""
        return self.face.pose(self.pose_of(values))

    @cached_property
    def _groups(self) -> dict[str, tuple[str, ...]]:
        return paired_controls(self.pose, mirror=self.mirror)


def paired_controls(pose: Pose, *, mirror: bool = True) -> dict[str, tuple[str, ...]]:
    """Return the controls of a pose by the name of the parameter that drives them.

    With `mirror`, controls of both sides that are equal are driven by one, named without side.
    """
    result: dict[str, tuple[str, ...]] = {}
    for name, value in pose.items():
        other = _other_side(name)
        both = mirror and other is not None and pose.get(other) == value
        stem = name[:-2] if both else name
        result[stem] = (*result.get(stem, ()), name)
    return result


def _other_side(name: str) -> str | None:
    swapped = {"_l": "_r", "_r": "_l"}.get(name[-2:])
    return name[:-2] + swapped if swapped else None


class Gallery:
    """Faces of candidates, made side by side; those that were just shown are not made again.

    Parameters
    ----------
    candidates : Candidates
    """

    def __init__(self, candidates: Candidates) -> None:
        self.candidates = candidates
        self._shown: dict[bytes, FloatArray] = {}

    def faces(self, rows: FloatArray) -> list[FloatArray]:
        """Return the vertices (n, 3) of many candidates [mm].

        Parameters
        ----------
        rows : (c, p) float64
            Values of each, in the order of the genome.
        """
        genome = self.candidates.genome
        keys = [np.ascontiguousarray(row).tobytes() for row in rows]
        new = {key: row for key, row in zip(keys, rows) if key not in self._shown}
        named = [genome.named(row) for row in new.values()]
        with ThreadPoolExecutor(os.cpu_count()) as pool:
            made = dict(zip(new, pool.map(self.candidates.positions, named)))
        self._shown = {key: made[key] if key in made else self._shown[key] for key in keys}
        return [self._shown[key] for key in keys]


def sensitivity_of(candidates: Candidates, *, names: Iterable[str] | None = None) -> FloatArray:
    """Return the effect (k, p) of each parameter over its range on the vertices [mm].

    One-sided differences of a quarter of the range at the start.

    Parameters
    ----------
    candidates : Candidates
    names : iterable of str, optional
        Parameters to look at, others count as without effect; default all.

    Notes
    -----
    Costs one face per parameter.
    """
    genome = candidates.genome
    start = genome.start
    rows = genome.rows(genome.names if names is None else names)
    reach = 0.25 * (genome.high - genome.low)
    # Into the range, where the start is an end of it.
    reach = np.where(start + reach <= genome.high, reach, -reach)
    moved = start + np.vstack([np.zeros(len(genome)), np.diag(reach)[rows]])
    rest, *others = Gallery(candidates).faces(moved)
    result = np.zeros((rest.size, len(genome)))
    for row, made in zip(rows, others):
        result[:, row] = (made - rest).ravel() * (4.0 if reach[row] > 0.0 else -4.0)
    if not np.isfinite(result).all():
        raise ParameterError("sensitivity: a candidate has vertices that are not finite")
    return result
