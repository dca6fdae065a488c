"""One tuning session: candidates, picks, undo, locks; and the loop that asks."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import numpy as np

from risorius._check import FloatArray
from risorius.errors import ParameterError
from risorius.tuning import cma_strategy, genetic, preference
from risorius.tuning.genome import Genome
from risorius.tuning.looks import Looks
from risorius.tuning.strategy import (
    CANDIDATE_COUNT,
    Generation,
    Round,
    Task,
    make_strategy,
    settle,
)

__all__ = ["Ask", "Session", "tune"]

# After so many halves a candidate is the best pick to the eye; then that is shown.
_HALVINGS = 4

assert genetic.__all__ and preference.__all__ and cma_strategy.__all__  # they register themselves

Ask = Callable[[Generation], Sequence[int] | None]
"""Answers a generation: picks (the best first), nothing for other faces, None to stop."""


class Session:
    """A person, a script or an objective chooses among nine, again and again.

    Parameters
    ----------
    genome : Genome
    strategy : str
        One of `STRATEGIES`: ``"genetic"`` as published, ``"preference"``, ``"cma"``.
    seed : int
        Same seed and same picks: same faces.
    start : mapping of str to float, optional
        Values to begin with instead of the genome's.
    sensitivity : (k, p) float64, optional
        See `Task`.
    looks : Looks, optional
        The faces; better than `sensitivity`.
    admit : callable, optional
        Says whether a candidate with values (p,) may be shown. One that may not is brought
        nearer to the best pick so far, in halves, until it may.

    Raises
    ------
    ParameterError
        If the strategy or a name in `start` is unknown.
    """

    def __init__(
        self,
        genome: Genome,
        *,
        strategy: str = "genetic",
        seed: int = 0,
        start: Mapping[str, float] | None = None,
        sensitivity: FloatArray | None = None,
        looks: Looks | None = None,
        admit: Callable[[FloatArray], bool] | None = None,
    ) -> None:
        self._admit = admit
        self._strategy = make_strategy(strategy)
        self._seed = seed
        locked = np.zeros(len(genome), bool)
        self._task = Task(genome, genome.values(start or {}), locked, sensitivity, looks)
        self._rounds: list[Round] = []
        self._rolls = [0]
        self._generation = self._propose()

    @property
    def genome(self) -> Genome:
        """What is tuned."""
        return self._task.genome

    @property
    def generation(self) -> Generation:
        """The nine candidates to choose from."""
        return self._generation

    @property
    def rounds(self) -> tuple[Round, ...]:
        """What was picked so far."""
        return tuple(self._rounds)

    @property
    def locked(self) -> tuple[str, ...]:
        """Names of the locked parameters."""
        return tuple(np.asarray(self.genome.names)[self._task.locked].tolist())

    @property
    def best(self) -> dict[str, float]:
        """The best pick of the last round by name; the start before any."""
        values = self._rounds[-1].kept[0] if self._rounds else self._task.start
        return self.genome.named(settle(self._task, values[None])[0])

    def pick(self, picks: Sequence[int]) -> Generation:
        """Choose among the nine and get the next ones.

        Parameters
        ----------
        picks : sequence of int
            One to three, counting from 0, the best first; an objective may rank all nine. None
            at all shows other faces.

        Raises
        ------
        ParameterError
            If a pick is no candidate or is named twice.
        """
        chosen = require_picks(picks)
        if not chosen:
            return self.reroll()
        self._rounds.append(Round(self._generation, chosen))
        self._rolls.append(0)
        self._generation = self._propose()
        return self._generation

    def reroll(self) -> Generation:
        """Return other candidates from the same picks."""
        self._rolls[-1] += 1
        self._generation = self._propose()
        return self._generation

    def undo(self) -> Generation:
        """Return to the candidates before the last picks.

        Raises
        ------
        ParameterError
            If nothing was picked yet.
        """
        if not self._rounds:
            raise ParameterError("undo: nothing was picked yet")
        self._rolls.pop()
        last = self._rounds.pop().generation
        self._generation = replace(last, candidates=settle(self._task, last.candidates))
        return self._generation

    def prepare(self) -> None:
        """Do what the next generation needs whatever is picked; call it while a person looks."""
        self._strategy.prepare(self._task, self._generation)

    def lock(self, names: Iterable[str]) -> None:
        """Keep parameters at their best value from now on.

        Raises
        ------
        ParameterError
            If a name is unknown.
        """
        rows = self.genome.rows(names)
        best = self.genome.values(self.best)
        start, locked = self._task.start.copy(), self._task.locked.copy()
        start[rows], locked[rows] = best[rows], True
        self._change(replace(self._task, start=start, locked=locked))

    def unlock(self, names: Iterable[str]) -> None:
        """Let parameters vary again.

        Raises
        ------
        ParameterError
            If a name is unknown.
        """
        locked = self._task.locked.copy()
        locked[self.genome.rows(names)] = False
        self._change(replace(self._task, locked=locked))

    def accept(self, pick: int | None = None) -> dict[str, float]:
        """Return the values of a candidate, or of the best pick so far, by name.

        Raises
        ------
        ParameterError
            If it is no candidate.
        """
        if pick is None:
            return self.best
        (row,) = require_picks([pick])
        return self.genome.named(self._generation.candidates[row])

    def _change(self, task: Task) -> None:
        self._task = task
        candidates = settle(task, self._generation.candidates)
        self._generation = replace(self._generation, candidates=candidates)

    def _propose(self) -> Generation:
        rng = np.random.default_rng([self._seed, len(self._rounds), self._rolls[-1]])
        if not self._rounds:
            return self._tamed(self._strategy.first(self._task, rng))
        return self._tamed(self._strategy.following(self._task, self._rounds, rng))

    def _tamed(self, proposed: Generation) -> Generation:
        """Return the generation with what may not be shown brought nearer to the best pick."""
        admit = self._admit
        if admit is None:
            return proposed
        best = self.genome.values(self.best)

        def nearer(values: FloatArray) -> FloatArray:
            for _ in range(_HALVINGS):
                if admit(values):
                    return values
                values = 0.5 * (best + values)
            return best

        with ThreadPoolExecutor(os.cpu_count()) as pool:
            made = np.array(list(pool.map(nearer, proposed.candidates)))
        return replace(proposed, candidates=made)


def require_picks(picks: Sequence[int]) -> tuple[int, ...]:
    """Return `picks` if they are different candidates.

    Raises
    ------
    ParameterError
        If one is no candidate or is named twice.
    """
    chosen = tuple(int(pick) for pick in picks)
    wrong = [pick for pick in chosen if not 0 <= pick < CANDIDATE_COUNT]
    if wrong or len(set(chosen)) != len(chosen):
        raise ParameterError(
            f"picks: {', '.join(str(pick + 1) for pick in chosen)}: give different numbers from 1 "
            f"to {CANDIDATE_COUNT}"
        )
    return chosen


def tune(session: Session, ask: Ask, *, generations: int = 10) -> dict[str, float]:
    """Ask until the answer is None or `generations` are through; return the best by name."""
    for _ in range(generations):
        picks = ask(session.generation)
        if picks is None:
            break
        session.pick(picks)
    return session.best
