"""Points on polylines: by share of the length, and nearest."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.spatial import cKDTree

from risorius._check import FloatArray, IntArray

__all__ = [
    "arched",
    "at_shares",
    "interpolated",
    "line_trust",
    "nearest_on_line",
    "nearest_on_segments",
    "place_on_line",
    "shares",
]

# Lines with at least so many vertices show the shape of an open mouth by themselves. Vertices
# within this share of the ends belong to the corners.
_MANY, _CORNERS = 12, 0.05


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


def arched(values: FloatArray, place: FloatArray, wanted: FloatArray) -> FloatArray:
    """Return motion `values` (k, d) of a contact line at shares `wanted` (q,) of its length.

    An open mouth is an ellipse: what the line moves beyond its corners is taken to be
    sqrt(s (1 - s)) times something even, which is interpolated instead. On lines of many vertices
    that is no different from `interpolated`, which is used for them.

    Parameters
    ----------
    values : (k, d) float64
        From corner to corner [mm].
    place : (k,) float64
        Shares of the line's vertices.
    wanted : (q,) float64
    """
    inner = (place > _CORNERS) & (place < 1.0 - _CORNERS)
    if len(place) >= _MANY or not inner.any():
        return interpolated(values, place, wanted)
    between = values[-1] - values[0]
    beyond = values[inner] - values[0] - place[inner, None] * between
    even = beyond / np.sqrt(place * (1.0 - place))[inner, None]
    arch = np.sqrt(np.maximum(wanted * (1.0 - wanted), 0.0))[:, None]
    rise = arch * interpolated(even, place[inner], wanted)
    return values[0] + wanted[:, None] * between + rise


def line_trust(ours: Sequence[IntArray], theirs: Sequence[IntArray]) -> float:
    """Return how far the motion of our lines can correct that of theirs, 0 to 1.

    Lines with far fewer vertices than theirs (a third and less) tell too little.
    """
    share = min(len(a) / len(b) for a, b in zip(ours, theirs))
    return float(np.clip((share - 0.3) / 0.25, 0.0, 1.0))


def nearest_on_line(points: FloatArray, line: FloatArray) -> FloatArray:
    """Return the points (q, 3) of the polyline `line` (k, 3) nearest to `points` (q, 3) [mm]."""
    start, along, _ = place_on_line(points, line)
    return line[start] + along[:, None] * (line[start + 1] - line[start])


def place_on_line(points: FloatArray, line: FloatArray) -> tuple[IntArray, FloatArray, FloatArray]:
    """Return where on a polyline points lie nearest.

    Parameters
    ----------
    points : (q, 3) float64
        [mm].
    line : (k, 3) float64
        [mm].

    Returns
    -------
    start : (q,) int
        Vertex of the line before the place.
    along : (q,) float64
        Share of the way to the next vertex.
    distance : (q,) float64
        [mm].
    """
    start, step = line[:-1], np.diff(line, axis=0)
    square = np.maximum(np.einsum("kj,kj->k", step, step), 1e-300)
    along = np.einsum("qkj,kj->qk", points[:, None] - start, step) / square
    along = np.clip(along, 0.0, 1.0)
    distance = np.linalg.norm(start + along[..., None] * step - points[:, None], axis=2)
    best = distance.argmin(axis=1)
    at = (np.arange(len(points)), best)
    return best.astype(np.int32), along[at], distance[at]


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
