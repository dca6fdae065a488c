"""The interactive genetic algorithm (Bui et al. 2003; its operators are ours)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations, cycle, islice

import numpy as np

from risorius._check import FloatArray
from risorius.tuning.genome import Genome
from risorius.tuning.gray import BitArray
from risorius.tuning.strategy import (
    CANDIDATE_COUNT,
    Generation,
    Round,
    Task,
    first_generation,
    register_strategy,
    settle,
)

__all__ = ["GeneticStrategy"]


@dataclass(frozen=True)
class GeneticStrategy:
    """Crossover, mutation, shrinking ranges; picked faces survive (spec vector-muscles 2.6).

    Parameters
    ----------
    shrink : float
        Factor of the ranges' half width per generation.
    mutation : float
        Probability that a bit of a child flips. With one bit in ten parameters little new comes
        up among nine faces; ten times as much needs half as many generations.
    parents : int
        Only so many of the picks, the best first, have children.
    """

    shrink: float = 0.85
    mutation: float = 0.1
    parents: int = 3

    def first(self, task: Task, rng: np.random.Generator) -> Generation:
        """Return the start and eight candidates drawn evenly from the bounds."""
        return first_generation(task, rng)

    def following(
        self, task: Task, rounds: Sequence[Round], rng: np.random.Generator
    ) -> Generation:
        """Return the picked faces and their children.

        Pairs of picks have children by uniform crossover on the borders of parameters; with a
        single pick its partners are drawn from the ranges. Ranges shrink around the mean of the
        picks, and open again when nine equal faces show that nothing is left to choose.
        """
        last = rounds[-1]
        kept = last.kept[: self.parents]
        low, high = self._ranges(task, last, kept)
        children: list[FloatArray] = []
        pairs = list(combinations(range(len(kept)), 2)) or [(0, -1)]
        for mother, father in islice(cycle(pairs), CANDIDATE_COUNT - len(kept)):
            partner = kept[father] if len(kept) > 1 else rng.uniform(low, high)
            children.append(
                self._child(task.genome, kept[mother], partner, rng, bounds=(low, high))
            )
        everyone = np.vstack([kept, *children])
        return Generation(last.generation.number + 1, settle(task, everyone), low, high)

    def prepare(self, task: Task, generation: Generation) -> None:
        """Do nothing; all waits for the picks."""

    def _ranges(self, task: Task, last: Round, kept: FloatArray) -> tuple[FloatArray, FloatArray]:
        genome, before = task.genome, last.generation
        free = ~task.locked
        spread = np.ptp(before.candidates[:, free], axis=0)
        half = 0.5 * (before.high - before.low)
        if (spread <= (half[free] * 2.0 ** (1 - genome.bits))).all():
            half = 0.5 * (genome.high - genome.low)
        else:
            half = self.shrink * half
        middle = np.clip(kept.mean(axis=0), genome.low + half, genome.high - half)
        return middle - half, middle + half

    def _child(
        self,
        genome: Genome,
        mother: FloatArray,
        father: FloatArray,
        rng: np.random.Generator,
        *,
        bounds: tuple[FloatArray, FloatArray],
    ) -> FloatArray:
        low, high = bounds
        from_mother = rng.random(len(mother)) < 0.5
        mixed = np.where(from_mother, mother, father)
        bits = genome.encode(mixed, low=low, high=high)
        return genome.decode(self._mutate(bits, rng), low=low, high=high)

    def _mutate(self, bits: BitArray, rng: np.random.Generator) -> BitArray:
        return bits ^ (rng.random(bits.shape) < self.mutation).astype(np.uint8)


register_strategy("genetic", GeneticStrategy)
