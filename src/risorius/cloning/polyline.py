"""Points on polylines: by share of the length, and nearest."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.spatial import cKDTree

from risorius._check import FloatArray, IntArray

__all__ = [
    "at_shares",
    "interpolated",
    "line_trust",
    "nearest_on_line",
    "nearest_on_segments",
    "shares",
]


def shares(points: FloatArray) -> FloatArray:
    """Return the place (k,) of each of `points` (k, 3) along its line, 0 to 1 by arc length."""
    steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    total = np.concatenate([[0.0], np.cumsum(steps)])
    return total / total[-1] if total[-1] > 0.0 else np.linspace(0.0, 1.0, len(points))


def at_shares(points: FloatArray, wanted: FloatArray) -> FloatArray:
    """Return the places (q, d) at shares `wanted` (q,) of the line through `points` (k, d)."""
    return interpolated(points, shares(points), wanted)


def interpolated(values: FloatArray, place: FloatArray, wanted: FloatArray) -> FloatArray:
    """Return `values` (k, d) given at shares `place` (k,), interpolated at `wanted` (q,)."""
    return np.stack([np.interp(wanted, place, column) for column in values.T], axis=1)


def line_trust(ours: Sequence[IntArray], theirs: Sequence[IntArray]) -> float:
    """Return how far the motion of our lines can correct that of theirs, 0 to 1.

    Lines with far fewer vertices than theirs (a third and less) tell too little.
    """
    share = min(len(a) / len(b) for a, b in zip(ours, theirs))
    return float(np.clip((share - 0.3) / 0.25, 0.0, 1.0))


def nearest_on_line(points: FloatArray, line: FloatArray) -> FloatArray:
    """Return the points (q, 3) of the polyline `line` (k, 3) nearest to `points` (q, 3) [mm]."""
    start, step = line[:-1], np.diff(line, axis=0)
    square = np.maximum(np.einsum("kj,kj->k", step, step), 1e-300)
    along = np.einsum("qkj,kj->qk", points[:, None] - start, step) / square
    places = start + np.clip(along, 0.0, 1.0)[..., None] * step
    best = np.linalg.norm(places - points[:, None], axis=2).argmin(axis=1)
    return places[np.arange(len(points)), best]


def nearest_on_segments(points: FloatArray, positions: FloatArray, edges: IntArray) -> FloatArray:
    """Return the points (q, 3) on `edges` (k, 2) nearest to `points` (q, 3) [mm].

    Of each point the eight edges with the nearest middles are looked at.
    """
    start = positions[edges[:, 0]]
    step = positions[edges[:, 1]] - start
    count = min(8, len(edges))
    near = cKDTree(start + 0.5 * step).query(points, k=count)[1].reshape(len(points), count)
    a, d = start[near], step[near]
    square = np.maximum(np.einsum("qkj,qkj->qk", d, d), 1e-300)
    along = np.einsum("qkj,qkj->qk", points[:, None] - a, d) / square
    places = a + np.clip(along, 0.0, 1.0)[..., None] * d
    best = np.linalg.norm(places - points[:, None], axis=2).argmin(axis=1)
    return places[np.arange(len(points)), best]
