"""Learn from comparisons where the wanted face lies (the modern answer to the same picks)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.linalg import cho_factor, cho_solve, solve_triangular
from scipy.special import expit

from risorius._check import FloatArray
from risorius.tuning.strategy import (
    CANDIDATE_COUNT,
    Generation,
    Round,
    Task,
    first_generation,
    register_strategy,
    settle,
)

__all__ = ["PreferenceStrategy", "ideal_point"]

# Newton steps; the problem is convex and needs five to ten.
_STEPS = 30


@dataclass(frozen=True)
class PreferenceStrategy:
    """Bradley-Terry model of an ideal point.

    "i rather than j" says that the wanted face lies nearer to i than to j. With distances
    ``|A (u - u*)|`` that is a half space in u*, so the most probable u* is the minimum of a
    convex function. The next generation holds the best pick, that minimum and draws from the
    uncertainty around it.

    Parameters
    ----------
    noise : float
        Width of doubt at a border, share of the distance of the two faces compared.
    lapse : float
        Share of comparisons that say nothing: people err.
    spread : float
        Factor of the uncertainty that new candidates are drawn with.
    keep : int
        Picks that are shown again.
    """

    noise: float = 0.25
    lapse: float = 0.1
    spread: float = 0.5
    keep: int = 1

    def first(self, task: Task, rng: np.random.Generator) -> Generation:
        """Return the start and eight candidates drawn evenly from the bounds."""
        return first_generation(task, rng)

    def following(
        self, task: Task, rounds: Sequence[Round], rng: np.random.Generator
    ) -> Generation:
        """Return the best picks, the most probable face and faces around it."""
        genome = task.genome
        low, width = genome.low, genome.high - genome.low
        free = np.flatnonzero(~task.locked)
        last = rounds[-1].generation
        kept = rounds[-1].kept[: self.keep]
        if not len(free):
            return Generation(last.number + 1, last.candidates, genome.low, genome.high)
        start = ((task.start - low) / width)[free]
        metric = np.eye(len(free))
        if task.sensitivity is not None:
            metric = _metric(task.sensitivity[:, free])
        better, worse = _comparisons(rounds, low, width)
        best, factor = ideal_point(
            better[:, free],
            worse[:, free],
            start=start,
            metric=metric,
            noise=self.noise,
            lapse=self.lapse,
        )
        drawn = rng.standard_normal((CANDIDATE_COUNT - 1 - len(kept), len(free)))
        around = solve_triangular(factor, drawn.T, lower=True, trans="T").T
        points = np.tile((task.start - low) / width, (len(drawn) + 1, 1))
        points[:, free] = np.vstack([best, best + self.spread * around])
        candidates = np.vstack([kept, low + np.clip(points, 0.0, 1.0) * width])
        return Generation(last.number + 1, settle(task, candidates), genome.low, genome.high)


def ideal_point(
    better: FloatArray,
    worse: FloatArray,
    *,
    start: FloatArray,
    metric: FloatArray,
    noise: float,
    lapse: float = 0.0,
) -> tuple[FloatArray, FloatArray]:
    """Return the most probable ideal point (p,) and the Cholesky factor (p, p) of its precision.

    Minimises ``sum log(1 + exp(-m / noise)) + |u - start|^2 / (2 s^2)``, where m is the distance
    of u from the border between the two faces on the side of the better one, in units of their
    distance, and s = 0.29 the deviation of an even spread over the range.

    Parameters
    ----------
    better, worse : (k, p) float64
        Compared points in units of the ranges.
    start : (p,) float64
        Centre of what is probable beforehand.
    metric : (p, p) float64
        Symmetric matrix A^T A of the distance.
    noise : float
    lapse : float
        Probability that a comparison says nothing; each is weighted by how likely it does say
        something (one step of expectation maximisation with each Newton step).
    """
    apart = better - worse
    normal = apart @ metric
    length = np.maximum(np.einsum("kp,kp->k", normal, apart), 1e-12)
    slope = normal / (length * noise)[:, None]
    offset = np.einsum("kp,kp->k", slope, 0.5 * (better + worse))
    prior = 12.0 * np.eye(len(start))
    point = start.copy()
    hessian = prior
    for _ in range(_STEPS):
        margin = slope @ point - offset
        doubt = expit(-margin)
        meant = (1.0 - lapse) * (1.0 - doubt)
        trust = meant / np.maximum(meant + 0.5 * lapse, 1e-300)
        gradient = prior @ (point - start) - slope.T @ (trust * doubt)
        hessian = prior + (slope * (trust * doubt * (1.0 - doubt))[:, None]).T @ slope
        step = cho_solve(cho_factor(hessian), gradient)
        # Far outside the range the logistic is flat; a long step would overshoot.
        step /= max(1.0, float(np.linalg.norm(step)) / (0.3 * np.sqrt(len(start))))
        point = point - step
        if np.abs(step).max() < 1e-9:
            break
    return point, np.asarray(np.linalg.cholesky(hessian), np.float64)


def _comparisons(
    rounds: Sequence[Round], low: FloatArray, width: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return compared candidates (k, p) and (k, p): picked ones against those left."""
    better: list[FloatArray] = []
    worse: list[FloatArray] = []
    for each in rounds:
        places = (each.generation.candidates - low) / width
        left = [row for row in range(len(places)) if row not in each.picks]
        for pick in each.picks:
            for other in left:
                if (places[pick] != places[other]).any():
                    better.append(places[pick])
                    worse.append(places[other])
    count = len(width)
    return np.array(better).reshape(-1, count), np.array(worse).reshape(-1, count)


def _metric(sensitivity: FloatArray) -> FloatArray:
    product = sensitivity.T @ sensitivity
    scale = float(np.trace(product)) / len(product)
    if scale <= 0.0:
        return np.eye(len(product))
    # What moves nothing keeps a little weight, so that it does not wander.
    return product / scale + 1e-3 * np.eye(len(product))


register_strategy("preference", PreferenceStrategy)
