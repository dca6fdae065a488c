"""Ray casting and closest points one triangle at a time, in double precision."""

from __future__ import annotations

import numpy as np

from risorius._check import FloatArray, IntArray


def first_hit(
    origin: FloatArray, direction: FloatArray, corners: FloatArray
) -> tuple[float, int, FloatArray]:
    """Return distance (inf on a miss), face and its barycentric coordinates."""
    best = (np.inf, -1, np.full(3, np.nan))
    for face, (a, b, c) in enumerate(corners):
        system = np.stack([a - b, a - c, direction], axis=1)
        if abs(np.linalg.det(system)) < 1e-300:
            continue
        u, v, distance = np.linalg.solve(system, a - origin)
        if u >= 0.0 and v >= 0.0 and u + v <= 1.0 and 0.0 <= distance < best[0]:
            best = (float(distance), face, np.array([1.0 - u - v, u, v]))
    return best


def closest_on_triangle(point: FloatArray, triangle: FloatArray) -> FloatArray:
    """Return the closest point of a triangle: over its inside, its sides and its corners."""
    a, b, c = triangle
    candidates = [a, b, c]
    for start, end in ((a, b), (b, c), (c, a)):
        side = end - start
        if side @ side > 0.0:
            share = (point - start) @ side / (side @ side)
            if 0.0 <= share <= 1.0:
                candidates.append(start + share * side)
    normal = np.cross(b - a, c - a)
    if normal @ normal > 0.0:
        foot = point - (point - a) @ normal / (normal @ normal) * normal
        turns = [
            np.cross(end - start, foot - start) @ normal for start, end in ((a, b), (b, c), (c, a))
        ]
        if min(turns) >= 0.0:
            candidates.append(foot)
    return min(candidates, key=lambda place: float(np.linalg.norm(place - point)))


def closest(point: FloatArray, corners: FloatArray, allowed: IntArray) -> float:
    """Return the distance to the closest of some faces, inf if there are none."""
    gaps = [np.linalg.norm(closest_on_triangle(point, corners[f]) - point) for f in allowed]
    return float(min(gaps, default=np.inf))
