"""Least squares over variables with bounds, small and dense, many times over."""

from __future__ import annotations

import numpy as np

from risorius._check import FloatArray
from risorius.playback.kernels.bounded import descend, finish

__all__ = ["fit_bounded"]

# Descent only has to find out which bounds hold; the rest is exact.
_NEAR = 1e-3
_SWEEPS = 40
_SLOPE = 1e-9


def fit_bounded(
    gram: FloatArray, linear: FloatArray, *, low: FloatArray, high: FloatArray
) -> FloatArray:
    """Return the x (k,) with low <= x <= high that minimises x' G x / 2 - h' x.

    Parameters
    ----------
    gram : (k, k) float64
        G, symmetric and positive definite.
    linear : (k,) float64
        h.
    low, high : (k,) float64
        Bounds.

    Notes
    -----
    Always starts from the bound nearest to zero, so that a frame's answer does not depend on the
    frames before it.
    """
    x = np.clip(np.zeros(len(linear)), low, high)
    descend(gram, linear, low, high, _NEAR, _SWEEPS, x)
    finish(gram, linear, low, high, _SLOPE, x)
    return x
