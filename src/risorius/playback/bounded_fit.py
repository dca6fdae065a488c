"""Least squares over variables with bounds, small and dense, many times over."""

from __future__ import annotations

import numpy as np

from risorius._check import FloatArray
from risorius.playback.kernels.bounded import descend

__all__ = ["fit_bounded"]

_TOLERANCE = 1e-5
_SWEEPS = 500


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
    descend(gram, linear, low, high, _TOLERANCE, _SWEEPS, x)
    return x
