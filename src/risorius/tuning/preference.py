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
    register_strategy,
    settle,
)

__all__ = ["PreferenceStrategy", "most_probable"]

# Newton steps; the problem is convex and needs five to ten.
_STEPS = 30
# Precision of an even spread over a range, 1 / 0.29^2.
_EVEN = 12.0


@dataclass(frozen=True)
class PreferenceStrategy:
    """Bradley-Terry model of an ideal point, in steps that a person can judge.

    "i rather than j" says that the wanted face lies nearer to i than to j, and of two picks the
    first nearer than the second. Faces are compared as they are seen; how they change with the
    values is a linear model around the most probable face. So each comparison is a half space of
    values, and the most probable ones are the minimum of a convex function. The next generation
    holds the best pick, that minimum, and draws from the uncertainty around it. No face is
    further from the middle than a radius that shrinks; distances are what is seen to move.

    Parameters
    ----------
    noise : float
        Width of doubt at a border, share of the distance of the two faces compared.
    lapse : float
        Share of comparisons that say nothing: people err.
    first_step : float
        How far the first faces are from the start, share of the effect of all ranges together.
    radius : float
        Bound on the way of the next faces, in the same unit.
    shrink : float
        Factor of the radius per generation.
    spread : float
        Factor of the uncertainty that new candidates are drawn with.
    directions : int
        The first faces lie along so many of the strongest directions of effect.
    """

    noise: float = 0.5
    lapse: float = 0.25
    first_step: float = 0.06
    radius: float = 0.12
    shrink: float = 0.85
    spread: float = 0.7
    directions: int = 8

    def first(self, task: Task, rng: np.random.Generator) -> Generation:
        """Return the start and four pairs of faces, each pair to both sides of it.

        The directions of the pairs are at right angles in what is seen, and what they change is
        equally far from the start.
        """
        low, high = task.genome.low, task.genome.high
        free = np.flatnonzero(~task.locked)
        if not len(free):
            return Generation(0, np.tile(task.start, (CANDIDATE_COUNT, 1)), low, high)
        pairs = (CANDIDATE_COUNT - 1) // 2
        slopes = task.slopes(task.start)[:, free]
        power, axes = np.linalg.eigh(slopes.T @ slopes)
        size = np.sqrt(np.maximum(power[::-1], 0.0))[: self.directions]
        total = float(np.sqrt(np.maximum(power, 0.0).sum()))
        # What moves nothing is left out, unless nothing moves anything.
        size = size[: max(1, int((size > 0.01 * total).sum()))]
        axes = axes[:, ::-1][:, : len(size)]
        turned = rng.standard_normal((pairs, len(size)))
        if len(size) >= pairs:
            turned = np.linalg.qr(turned.T)[0].T
        turned /= np.linalg.norm(turned, axis=1, keepdims=True)
        # What moves little would need values far out of bounds.
        steps = self.first_step * total * turned / np.maximum(size, 0.1 * max(total, 1e-300))
        points = np.tile((task.start - low) / task.width, (CANDIDATE_COUNT, 1))
        both = steps @ axes.T
        points[1:, free] += np.stack([both, -both], axis=1).reshape(-1, len(free))
        candidates = np.vstack([task.start, low + points[1:] * task.width])
        return Generation(0, settle(task, candidates), low, high)

    def following(
        self, task: Task, rounds: Sequence[Round], rng: np.random.Generator
    ) -> Generation:
        """Return the best pick, the most probable face and faces around it."""
        low, high = task.genome.low, task.genome.high
        free = np.flatnonzero(~task.locked)
        last = rounds[-1].generation
        best = rounds[-1].kept[:1]
        if not len(free):
            return Generation(last.number + 1, last.candidates, low, high)
        middle = _middle(task, last)
        slopes = task.slopes(middle)[:, free]
        slope, offset = _borders(task, rounds, middle, slopes)
        ideal, factor = most_probable(slope / self.noise, offset / self.noise, lapse=self.lapse)
        reach = self.radius * self.shrink ** len(rounds) * float(np.linalg.norm(slopes))
        ideal *= _within(slopes @ ideal, 2.0 * reach)
        drawn = rng.standard_normal((CANDIDATE_COUNT - 2, len(free)))
        around = solve_triangular(factor, drawn.T, lower=True, trans="T").T
        way = [np.minimum(self.spread, _within(slopes @ each, reach)) for each in around]
        points = np.tile((middle - low) / task.width, (CANDIDATE_COUNT - 1, 1))
        points[:, free] += ideal
        points[1:, free] += np.array(way)[:, None] * around
        candidates = np.vstack([best, low + points * task.width])
        return Generation(last.number + 1, settle(task, candidates), low, high)

    def prepare(self, task: Task, generation: Generation) -> None:
        """See how faces change around the most probable one."""
        task.slopes(_middle(task, generation))


def _middle(task: Task, generation: Generation) -> FloatArray:
    """Return the most probable face: the start, later what stands in the second place."""
    return settle(task, generation.candidates[1 if generation.number else 0][None])[0]


def _within(effect: FloatArray, reach: float) -> float:
    """Return the factor that brings an effect (k,) to a length of `reach`."""
    return min(1.0, reach / max(float(np.linalg.norm(effect)), 1e-300))


def _borders(
    task: Task, rounds: Sequence[Round], middle: FloatArray, slopes: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return the half spaces (k, p) and (k,) of values around `middle` that picks speak for.

    With faces i, j as seen, the wanted one T and the face M in the middle, ``|T - i| < |T - j|``
    is ``(i - j) . (T - (i + j) / 2) > 0`` with ``T = M + slopes u``, in units of ``|i - j|^2``.
    """
    here = task.seen(middle)
    rows: list[FloatArray] = []
    offsets: list[float] = []
    for each in rounds:
        seen = [task.seen(values) for values in each.generation.candidates]
        left = [row for row in range(len(seen)) if row not in each.picks]
        worse = {pick: [*each.picks[place + 1 :], *left] for place, pick in enumerate(each.picks)}
        for pick, others in worse.items():
            for other in others:
                apart = seen[pick] - seen[other]
                power = float(apart @ apart)
                if power > 0.0:
                    rows.append(slopes.T @ apart / power)
                    offsets.append(float(apart @ (0.5 * (seen[pick] + seen[other]) - here)) / power)
    return np.array(rows).reshape(-1, slopes.shape[1]), np.array(offsets)


def most_probable(
    slope: FloatArray, offset: FloatArray, *, lapse: float = 0.0
) -> tuple[FloatArray, FloatArray]:
    """Return the most probable point (p,) and the Cholesky factor (p, p) of its precision.

    Minimises ``sum log(1 + exp(offset - slope u)) + |u|^2 / (2 s^2)`` with s = 0.29, the
    deviation of an even spread over the range.

    Parameters
    ----------
    slope : (k, p) float64
    offset : (k,) float64
        Of comparisons that say ``slope u > offset``, in units of their doubt.
    lapse : float
        Probability that a comparison says nothing; each is weighted by how likely it does say
        something (one step of expectation maximisation with each Newton step).
    """
    count = slope.shape[1]
    prior = _EVEN * np.eye(count)
    point, hessian = np.zeros(count), prior
    for _ in range(_STEPS):
        doubt = expit(offset - slope @ point)
        meant = (1.0 - lapse) * (1.0 - doubt)
        trust = meant / np.maximum(meant + 0.5 * lapse, 1e-300)
        gradient = prior @ point - slope.T @ (trust * doubt)
        hessian = prior + (slope * (trust * doubt * (1.0 - doubt))[:, None]).T @ slope
        step = cho_solve(cho_factor(hessian), gradient)
        # Far outside the range the logistic is flat; a long step would overshoot.
        step /= max(1.0, float(np.linalg.norm(step)) / (0.3 * np.sqrt(count)))
        point = point - step
        if np.abs(step).max() < 1e-9:
            break
    return point, np.asarray(np.linalg.cholesky(hessian), np.float64)


register_strategy("preference", PreferenceStrategy)
