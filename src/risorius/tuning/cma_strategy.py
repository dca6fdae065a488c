"""CMA-ES behind the interface of picks; needs the optional library `cma`."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from risorius._check import FloatArray
from risorius.errors import ParameterError
from risorius.tuning.strategy import (
    CANDIDATE_COUNT,
    Generation,
    Round,
    Task,
    register_strategy,
    settle,
)

__all__ = ["CmaStrategy"]


@dataclass(frozen=True)
class CmaStrategy:
    """Evolution of a normal distribution by ranks (Hansen 2016, library pycma).

    Picks are the ranks; faces that were not picked share the last one. The more faces are
    ranked, the better: an objective ranks all nine.

    Parameters
    ----------
    sigma : float
        First standard deviation, share of each range.
    """

    sigma: float = 0.25

    def first(self, task: Task, rng: np.random.Generator) -> Generation:
        """Return the start and eight candidates around it."""
        return self._asked(task, (), int(rng.integers(1 << 31)))

    def following(
        self, task: Task, rounds: Sequence[Round], rng: np.random.Generator
    ) -> Generation:
        """Return the best pick and eight candidates of the next distribution."""
        return self._asked(task, rounds, int(rng.integers(1 << 31)))

    def prepare(self, task: Task, generation: Generation) -> None:
        """Do nothing; all waits for the picks."""

    def _asked(self, task: Task, rounds: Sequence[Round], seed: int) -> Generation:
        genome = task.genome
        low, width = genome.low, genome.high - genome.low
        free = np.flatnonzero(~task.locked)
        number = rounds[-1].generation.number + 1 if rounds else 0
        shown = rounds[-1].kept[:1] if rounds else task.start[None]
        if not len(free):
            everyone = np.tile(task.start, (CANDIDATE_COUNT, 1))
            return Generation(number, everyone, genome.low, genome.high)
        if len(free) < 2:
            raise ParameterError("strategy: 'cma' needs two free parameters; take 'preference'")
        start = (task.start - low) / width
        search = _evolution(start[free], self.sigma, np.random.default_rng(seed))
        for each in rounds:
            ranks = np.full(CANDIDATE_COUNT, float(len(each.picks)))
            ranks[list(each.picks)] = np.arange(len(each.picks))
            places = (each.generation.candidates - low) / width
            search.ask()
            search.tell(list(places[:, free]), ranks.tolist())
        drawn = np.tile(start, (CANDIDATE_COUNT - 1, 1))
        drawn[:, free] = np.array(search.ask())[: CANDIDATE_COUNT - 1]
        candidates: FloatArray = np.vstack([shown, low + np.clip(drawn, 0.0, 1.0) * width])
        return Generation(number, settle(task, candidates), genome.low, genome.high)


def _evolution(start: FloatArray, sigma: float, rng: np.random.Generator) -> Any:
    try:
        import cma  # pyright: ignore
    except ImportError:
        raise ImportError("strategy: 'cma' needs an extra; pip install risorius[tuning]") from None
    # Its own generator, so that nothing global is seeded.
    options = {
        "popsize": CANDIDATE_COUNT,
        "verbose": -9,
        "bounds": [0.0, 1.0],
        "randn": lambda *shape: rng.standard_normal(shape),
        "seed": np.nan,
    }
    return cma.CMAEvolutionStrategy(np.clip(start, 0.01, 0.99), sigma, options)  # pyright: ignore


register_strategy("cma", CmaStrategy)
