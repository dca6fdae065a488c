# pyright: basic
"""Quadratic programs with bounds: coordinate descent to come near, an active set to be exact."""

import numpy as np
from numba import njit

__all__ = ["descend", "finish"]


@njit(cache=True, nogil=True)
def descend(gram, linear, low, high, tolerance, sweeps, x):
    """Minimise x' G x / 2 - h' x with low <= x <= high, in place from the given `x`.

    Coordinates take their exact minimum in order; stops when no one moves by more than
    `tolerance`. Returns the number of sweeps.
    """
    count = len(x)
    slope = gram @ x - linear
    for sweep in range(sweeps):
        largest = 0.0
        for i in range(count):
            if gram[i, i] <= 0.0:
                continue
            wanted = min(max(x[i] - slope[i] / gram[i, i], low[i]), high[i])
            step = wanted - x[i]
            if step != 0.0:
                x[i] = wanted
                for j in range(count):
                    slope[j] += step * gram[i, j]
                largest = max(largest, abs(step))
        if largest <= tolerance:
            return sweep + 1
    return sweeps


@njit(cache=True, nogil=True)
def finish(gram, linear, low, high, tolerance, x):
    """Bring an `x` that lies near the minimum to it, in place, by a primal active set.

    Coordinates at a bound that they are pressed against are held; the others take their common
    minimum, as far as the next bound. Slopes count from `tolerance` times the diagonal of G.
    Returns the number of linear systems, at most 4 k.

    References
    ----------
    Nocedal and Wright, Numerical Optimization, algorithm 16.3, for bounds only.
    """
    count = len(x)
    slope = gram @ x - linear
    held = np.zeros(count, np.bool_)
    for i in range(count):
        pressed = (x[i] <= low[i] and slope[i] >= 0.0) or (x[i] >= high[i] and slope[i] <= 0.0)
        held[i] = pressed or low[i] >= high[i] or gram[i, i] <= 0.0
    for turn in range(4 * count):
        free = np.flatnonzero(~held)
        slope = gram @ x - linear
        share, block = 1.0, -1
        if len(free):
            system = np.empty((len(free), len(free)))
            right = np.empty(len(free))
            for a in range(len(free)):
                right[a] = -slope[free[a]]
                for b in range(len(free)):
                    system[a, b] = gram[free[a], free[b]]
            step = np.linalg.solve(system, right)
            for a in range(len(free)):
                i = free[a]
                room = (high[i] if step[a] > 0.0 else low[i]) - x[i]
                if abs(step[a]) * share > abs(room):
                    share, block = room / step[a], i
            for a in range(len(free)):
                i = free[a]
                x[i] = min(max(x[i] + share * step[a], low[i]), high[i])
        if block >= 0:
            to_high = abs(x[block] - high[block]) < abs(x[block] - low[block])
            x[block] = high[block] if to_high else low[block]
            held[block] = True
            continue
        slope = gram @ x - linear
        worst, leaving = 0.0, -1
        for i in range(count):
            if not held[i] or low[i] >= high[i] or gram[i, i] <= 0.0:
                continue
            wish = -slope[i] if x[i] <= low[i] else slope[i]
            if wish > tolerance * gram[i, i] and wish / gram[i, i] > worst:
                worst, leaving = wish / gram[i, i], i
        if leaving < 0:
            return turn + 1
        held[leaving] = False
    return 4 * count
