"""The fall-off that all devices share."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from risorius._check import FloatArray

__all__ = ["smooth_step"]


def smooth_step(x: npt.ArrayLike) -> FloatArray:
    """Return ``x^2 (3 - 2 x)`` (...) with `x` (...) clipped to [0, 1]: 0 to 1 with flat ends."""
    clipped = np.clip(np.asarray(x, dtype=np.float64), 0.0, 1.0)
    return clipped * clipped * (3.0 - 2.0 * clipped)
