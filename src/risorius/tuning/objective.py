"""Tune without a person: the distance to a shape answers, or a made-up user with a wish."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
import numpy.typing as npt

from risorius._check import FloatArray, as_points
from risorius.errors import ParameterError, ShapeError
from risorius.tuning.candidates import Candidates, Gallery
from risorius.tuning.strategy import Generation

__all__ = ["MadeUpUser", "ShapeObjective"]

Distance = Callable[[FloatArray], float]


@dataclass(frozen=True, eq=False)
class ShapeObjective:
    """Distance of candidates from a sculpted shape.

    Parameters
    ----------
    candidates : Candidates
    target : (n, 3) array_like
        The shape, vertex for vertex [mm].
    weights : (n,) array_like or None
        What counts; default everything alike.
    """

    candidates: Candidates
    target: npt.ArrayLike
    weights: npt.ArrayLike | None = None

    def __call__(self, generation: Generation) -> tuple[int, ...]:
        """Return all candidates, the nearest first."""
        distances = [self._apart(face) for face in self._gallery.faces(generation.candidates)]
        return tuple(np.argsort(distances, kind="stable").tolist())

    def distance(self, values: FloatArray) -> float:
        """Return the root mean square distance [mm] of the candidate with values (p,).

        Raises
        ------
        ShapeError
            If the target has another number of vertices.
        """
        return self._apart(self.candidates.positions(self.candidates.genome.named(values)))

    @cached_property
    def _gallery(self) -> Gallery:
        return Gallery(self.candidates)

    def _apart(self, made: FloatArray) -> float:
        target = as_points("target", self.target)
        if made.shape != target.shape:
            raise ShapeError(
                f"target: {len(target)} vertices, the face has {len(made)}; it must be the same "
                "mesh, sculpted"
            )
        squared = ((made - target) ** 2).sum(axis=1)
        weights = None if self.weights is None else np.asarray(self.weights)
        return float(np.sqrt(np.average(squared, weights=weights)))


@dataclass(eq=False)
class MadeUpUser:
    """Picks what is nearest to a hidden wish, and errs now and then.

    Parameters
    ----------
    distance : callable
        From the values (p,) of a candidate to its distance from the wish.
    picks : int
        How many it takes.
    error : float
        Probability with which a pick is any other face instead.
    seed : int
    """

    distance: Distance
    picks: int = 3
    error: float = 0.0
    seed: int = 0
    _rng: np.random.Generator = field(init=False)

    def __post_init__(self) -> None:
        if not 1 <= self.picks <= 9 or not 0.0 <= self.error <= 1.0:
            raise ParameterError("user: needs 1 to 9 picks and an error rate in 0..1")
        self._rng = np.random.default_rng(self.seed)

    def __call__(self, generation: Generation) -> tuple[int, ...]:
        """Return the picks, the nearest first."""
        distances = [self.distance(values) for values in generation.candidates]
        order = np.argsort(distances, kind="stable").tolist()
        chosen, left = order[: self.picks], order[self.picks :]
        for place in range(len(chosen)):
            if left and self._rng.random() < self.error:
                other = int(self._rng.integers(len(left)))
                chosen[place], left[other] = left[other], chosen[place]
        return tuple(chosen)
