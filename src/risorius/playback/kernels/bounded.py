# pyright: basic
"""Quadratic programs with bounds, by coordinate descent."""

from numba import njit

__all__ = ["descend"]


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
