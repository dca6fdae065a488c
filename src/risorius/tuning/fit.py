"""Fit parameters to a shape by least squares: what a person need not look at."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.optimize import lsq_linear

from risorius._check import FloatArray
from risorius.tuning.candidates import Candidates, Gallery

__all__ = ["ShapeFit", "fit_shape"]

# Differences are taken over this share of a range; contact and folds make smaller ones noisy.
_STEP = 0.03
# A parameter at the end of its range costs as much as this share of the first error.
_HOLD = 0.05
# Ways to go along a step at once; the best counts.
_WAYS = np.array([1.0, 0.6, 0.3, 0.1])
# Gain of an iteration below which it ends.
_GAIN = 5e-3

Progress = Callable[[int, int, str], None]


@dataclass(frozen=True, eq=False)
class ShapeFit:
    """What a fit has found.

    Parameters
    ----------
    values : mapping of str to float
        By name.
    before, after : float
        Root mean square distance from the shape [mm].
    iterations : int
    """

    values: dict[str, float]
    before: float
    after: float
    iterations: int


def fit_shape(
    candidates: Candidates,
    target: FloatArray,
    *,
    start: FloatArray | None = None,
    iterations: int = 15,
    progress: Progress | None = None,
) -> ShapeFit:
    """Return the values whose face comes nearest to a shape.

    Bounded Gauss-Newton with differences: minimises ``mean |x(v) - t|^2 + h^2 mean u^2`` with u the
    distance from the start in units of the ranges, so that what does not matter stays.

    Parameters
    ----------
    candidates : Candidates
    target : (n, 3) float64
        The shape, vertex for vertex [mm].
    start : (p,) float64, optional
        The genome's if left out.
    iterations : int
        At most; it ends when nothing is gained any more.
    progress : callable, optional
        Called with (done, all, name).

    Notes
    -----
    Costs a face for each parameter and four more per iteration. Finds the nearest of several
    minima, not the lowest.
    """
    genome = candidates.genome
    low, width = genome.low, genome.high - genome.low
    first = genome.start if start is None else start
    origin = place = (first - low) / width
    gallery = Gallery(candidates)

    def apart(faces: list[FloatArray], places: FloatArray) -> FloatArray:
        errors = [np.sqrt(((face - target) ** 2).sum(axis=1).mean()) for face in faces]
        away = np.sqrt(((places - origin) ** 2).mean(axis=1))
        return np.hypot(errors, hold * away)

    hold = 0.0
    (face,) = gallery.faces(first[None])
    before = cost = float(apart([face], place[None])[0])
    hold = _HOLD * before
    done = 0
    if before == 0.0:
        return ShapeFit(genome.named(first), before, before, done)
    for done in range(1, iterations + 1):
        if progress is not None:
            progress(done - 1, iterations, f"{cost:.3f} mm")
        signs = np.where(place + _STEP <= 1.0, _STEP, -_STEP)
        tried = place + np.diag(signs)
        slopes = [
            (made - face).ravel() / sign
            for made, sign in zip(gallery.faces(low + tried * width), signs)
        ]
        step = _step(np.array(slopes).T, (target - face).ravel(), place, hold, origin)
        places = place + _WAYS[:, None] * step
        faces = gallery.faces(low + places * width)
        costs = apart(faces, places)
        best = int(np.argmin(costs))
        gained = cost - float(costs[best])
        if gained <= 0.0:
            break
        place, face, cost = places[best], faces[best], float(costs[best])
        if gained < _GAIN * cost:
            break
    after = float(np.sqrt(((face - target) ** 2).sum(axis=1).mean()))
    return ShapeFit(genome.named(low + place * width), before, after, done)


def _step(
    slopes: FloatArray, missing: FloatArray, place: FloatArray, hold: float, origin: FloatArray
) -> FloatArray:
    """Return the step (p,) of the linear problem inside the bounds."""
    count = len(missing) // 3
    normal = slopes.T @ slopes / count + (hold**2 / len(place)) * np.eye(len(place))
    right = slopes.T @ missing / count + (hold**2 / len(place)) * (origin - place)
    root = np.linalg.cholesky(normal)
    # |root^T s - y|^2 has the same minimum as the normal equations.
    wanted = np.linalg.solve(root, right)
    found = lsq_linear(root.T, wanted, bounds=(-place - 1e-12, 1.0 - place + 1e-12))
    return np.clip(found.x, -place, 1.0 - place)
