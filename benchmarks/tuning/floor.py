"""The nearest face to a wish that the genes can make, as far as a search finds it."""

from __future__ import annotations

import numpy as np
from scipy.optimize import least_squares

from benchmarks.tuning.wishes import Wish

_STEPS = 12


def floor(wish: Wish, *, starts: int = 2) -> list[float]:
    """Return the least error (1,) [mm] of a bounded least-squares search from several places."""
    genome = wish.genome
    low, width = genome.low, genome.high - genome.low
    counted = np.flatnonzero(wish.weights > 0.0)
    root = np.sqrt(wish.weights / wish.weights.sum())[counted, None]
    aim = (wish.poses.face.head.skin.mesh.positions + wish.truth)[counted]

    def residual(place: np.ndarray) -> np.ndarray:
        made = wish.positions(genome.named(low + place * width))[counted]
        return (root * (made - aim)).ravel()

    # From inside the ranges rather than from an edge, where slopes vanish.
    first = np.clip((genome.start - low) / width, 0.1, 0.9)
    least = np.inf
    for seed in range(starts):
        rng = np.random.default_rng(seed)
        start = np.clip(
            first + (0.15 if seed else 0.0) * rng.standard_normal(len(first)), 0.05, 0.95
        )
        found = least_squares(residual, start, bounds=(0, 1), diff_step=0.02, max_nfev=_STEPS)
        least = min(least, float(np.sqrt(2.0 * found.cost)))
    return [least]
