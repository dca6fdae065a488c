"""Skin hangs together: what lies around a muscle's insertion is taken along."""

from __future__ import annotations

import numpy as np

from risorius._check import FloatArray
from risorius.anatomy.smooth_step import smooth_step
from risorius.vectormuscle.muscle import FaceContext

__all__ = ["drag_field"]


def drag_field(
    context: FaceContext, ends: FloatArray, amount: FloatArray, *, reach: float
) -> FloatArray:
    """Return the displacement (n, 3) [mm] of the skin around an insertion at contraction 1.

    ``amount s(1 - |p - insertion| / reach)`` towards the origin, turned along what supports the
    skin at p; s is the smooth step. Waters' cone ends where real cheeks and chin still follow the
    mouth corner; this is the part of an elastic skin that a closed form can have.

    Parameters
    ----------
    context : FaceContext
    ends : (2, 3) float64
        Origin and insertion [mm].
    amount : (n,) float64
        Motion of each vertex, were it at the insertion [mm].
    reach : float
        Where the skin rests again [mm].
    """
    along = ends[0] - ends[1]
    along = along / np.linalg.norm(along)
    away = np.linalg.norm(context.positions - ends[1], axis=1) / reach
    outward = context.outward
    inward = np.minimum(outward @ along, 0.0)
    way = along - (context.support * inward)[:, None] * outward
    way /= np.maximum(np.linalg.norm(way, axis=1, keepdims=True), 1e-12)
    return (amount * smooth_step(1.0 - away))[:, None] * way
