"""Skin hangs together: what lies around a muscle's insertion is taken along."""

from __future__ import annotations

import numpy as np

from risorius._check import FloatArray, IntArray
from risorius.anatomy.smooth_step import smooth_step
from risorius.vectormuscle.muscle import FaceContext

__all__ = ["drag_field"]


def drag_field(
    context: FaceContext, ends: FloatArray, amount: FloatArray, *, reach: float
) -> tuple[IntArray, FloatArray]:
    """Return what follows an insertion: vertices (k,) and their displacement (k, 3) [mm] at 1.

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
    vertices, offset = context.within(ends[1], reach)
    moves = amount[vertices] != 0.0
    vertices, offset = vertices[moves], offset[moves]
    away = np.sqrt(np.einsum("kd,kd->k", offset, offset)) / reach
    outward = context.outward[vertices]
    inward = np.minimum(outward @ along, 0.0)
    way = along - (context.support * inward)[:, None] * outward
    length = np.sqrt(np.einsum("kd,kd->k", way, way))
    share = amount[vertices] * smooth_step(1.0 - away) / np.maximum(length, 1e-12)
    return vertices, share[:, None] * way
