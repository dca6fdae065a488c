"""What a strategy is: it answers picks with the next nine candidates."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from risorius._check import BoolArray, FloatArray
from risorius.errors import ParameterError
from risorius.tuning.genome import Genome
from risorius.tuning.looks import Looks

__all__ = [
    "CANDIDATE_COUNT",
    "STRATEGIES",
    "Generation",
    "Round",
    "Strategy",
    "Task",
    "make_strategy",
    "register_strategy",
]

CANDIDATE_COUNT = 9
"""Faces shown at once."""


@dataclass(frozen=True, eq=False)
class Task:
    """What is tuned, and what must stay.

    Parameters
    ----------
    genome : Genome
    start : (p,) float64
        Where tuning begins.
    locked : (p,) bool
        Parameters that stay at `start`.
    sensitivity : (k, p) float64 or None
        Effect of each parameter, over its whole range, on what is looked at; strategies that
        learn measure distances by it.
    looks : Looks or None
        The faces themselves, in the stead of `sensitivity`: what was seen is then known exactly,
        and effects anew in every generation.
    """

    genome: Genome
    start: FloatArray
    locked: BoolArray
    sensitivity: FloatArray | None = None
    looks: Looks | None = None

    def seen(self, values: FloatArray) -> FloatArray:
        """Return what is looked at (k,) of a candidate with values (p,)."""
        if self.looks is not None:
            return self.looks.face(values)
        return self.slopes(values) @ ((values - self.genome.low) / self.width)

    def slopes(self, values: FloatArray) -> FloatArray:
        """Return how what is looked at changes (k, p) with values (p,) over their ranges."""
        if self.looks is not None:
            return self.looks.slopes(values)
        return np.eye(len(self.genome)) if self.sensitivity is None else self.sensitivity

    @property
    def width(self) -> FloatArray:
        """Widths (p,) of the ranges."""
        return self.genome.high - self.genome.low


@dataclass(frozen=True, eq=False)
class Generation:
    """Nine candidates.

    Parameters
    ----------
    number : int
        Counts from 0.
    candidates : (9, p) float64
    low, high : (p,) float64
        Ranges that new candidates were drawn from.
    """

    number: int
    candidates: FloatArray
    low: FloatArray
    high: FloatArray


@dataclass(frozen=True, eq=False)
class Round:
    """A generation and what was picked from it, the best first."""

    generation: Generation
    picks: tuple[int, ...]

    @property
    def kept(self) -> FloatArray:
        """Picked candidates (k, p)."""
        return self.generation.candidates[list(self.picks)]


class Strategy(Protocol):
    """A way from picks to new candidates; it keeps nothing between calls."""

    def first(self, task: Task, rng: np.random.Generator) -> Generation:
        """Return the first generation; its first candidate is the start."""
        ...

    def following(
        self, task: Task, rounds: Sequence[Round], rng: np.random.Generator
    ) -> Generation:
        """Return the generation after the last of `rounds`, of which there is at least one."""
        ...

    def prepare(self, task: Task, generation: Generation) -> None:
        """Do what the generation after this one needs, whatever is picked."""
        ...


STRATEGIES: dict[str, Callable[[], Strategy]] = {}
"""Strategies by name; each one's module adds itself."""


def register_strategy(name: str, make: Callable[[], Strategy]) -> None:
    """Add a strategy."""
    STRATEGIES[name] = make


def make_strategy(name: str) -> Strategy:
    """Return the strategy of this name.

    Raises
    ------
    ParameterError
        If there is none.
    """
    if name not in STRATEGIES:
        raise ParameterError(f"strategy: {name!r} is not one of {', '.join(sorted(STRATEGIES))}")
    return STRATEGIES[name]()


def settle(task: Task, candidates: FloatArray) -> FloatArray:
    """Return candidates (k, p) inside the bounds, with locked parameters where they belong."""
    inside = np.clip(candidates, task.genome.low, task.genome.high)
    return np.where(task.locked, task.start, inside)


def first_generation(task: Task, rng: np.random.Generator) -> Generation:
    """Return the start and eight candidates drawn evenly from the bounds."""
    low, high = task.genome.low, task.genome.high
    drawn = rng.uniform(low, high, size=(CANDIDATE_COUNT - 1, len(low)))
    return Generation(0, settle(task, np.vstack([task.start, drawn])), low, high)
