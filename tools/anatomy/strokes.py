"""Brush strokes that raise or lower the skin along a line, as a sculptor would."""

from __future__ import annotations

import numpy as np
from numba import njit, prange

from .fields import smooth_curve
from .stroke_table import STROKES

__all__ = ["stroke_height"]

_SAMPLES = 16
_REACH = 2.6  # radii beyond which a stroke is not felt


def _segments():
    """Return all strokes as rows (stroke, x, y, z, radius, height) and where each begins."""
    curves = [smooth_curve(knots, _SAMPLES) for knots in STROKES.values()]
    return np.ascontiguousarray(np.stack(curves))


@njit(parallel=True, cache=True)
def _height_kernel(points, curves, out):
    for i in prange(points.shape[0]):
        total = 0.0
        for s in range(curves.shape[0]):
            best = 1e18
            radius = height = 1.0
            for j in range(curves.shape[1] - 1):
                dot = 0.0
                length = 1e-12
                for k in range(3):
                    edge = curves[s, j + 1, k] - curves[s, j, k]
                    dot += (points[i, k] - curves[s, j, k]) * edge
                    length += edge * edge
                t = min(1.0, max(0.0, dot / length))
                square = 0.0
                for k in range(3):
                    edge = curves[s, j + 1, k] - curves[s, j, k]
                    square += (points[i, k] - curves[s, j, k] - t * edge) ** 2
                if square < best:
                    best = square
                    radius = curves[s, j, 3] + t * (curves[s, j + 1, 3] - curves[s, j, 3])
                    height = curves[s, j, 4] + t * (curves[s, j + 1, 4] - curves[s, j, 4])
            share = best / (radius * radius)
            if share < _REACH * _REACH:
                total += height * np.exp(-share)
        out[i] = total


_CURVES = _segments()


def stroke_height(points):
    """Return how far (n,) the strokes raise the skin at `points` (n, 3), x >= 0 [mm]."""
    out = np.empty(len(points))
    _height_kernel(np.ascontiguousarray(points), _CURVES, out)
    return out
