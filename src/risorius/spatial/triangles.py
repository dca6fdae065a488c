"""Exact queries on single triangles, many at once."""

from __future__ import annotations

import numpy as np

from risorius._check import FloatArray

__all__ = ["closest_bary", "line_bary"]


def closest_bary(points: FloatArray, corners: FloatArray) -> FloatArray:
    """Return the barycentric coordinates of the nearest point of a triangle to each point.

    Parameters
    ----------
    points : (k, 3) float64
    corners : (k, 3, 3) float64
        The triangle of each point, corner by corner.

    Returns
    -------
    (k, 3) float64
        All at least 0, sum 1.

    Notes
    -----
    The nearest of four candidates: the foot on the plane if it lies inside, and the nearest
    point of each side. Triangles without area are the longest of their sides.
    """
    best = np.full(len(points), np.inf)
    result = np.zeros((len(points), 3))
    for corner in range(3):
        after = (corner + 1) % 3
        start, side = corners[:, corner], corners[:, after] - corners[:, corner]
        squared = np.einsum("ij,ij->i", side, side)
        along = np.einsum("ij,ij->i", points - start, side)
        share = np.clip(along / np.where(squared > 0.0, squared, 1.0), 0.0, 1.0)
        bary = np.zeros((len(points), 3))
        bary[:, corner], bary[:, after] = 1.0 - share, share
        _keep_nearer(points, corners, bary, best, result)
    foot = _plane_bary(points, corners)
    inside = np.flatnonzero((foot >= 0.0).all(axis=1))
    rows = foot[inside]
    gap = _squared_gap(points[inside], corners[inside], rows)
    nearer = gap < best[inside]
    result[inside[nearer]] = rows[nearer]
    return result


def line_bary(
    origins: FloatArray, directions: FloatArray, corners: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return where lines meet the planes of triangles.

    Parameters
    ----------
    origins, directions : (k, 3) float64
    corners : (k, 3, 3) float64
        The triangle of each line.

    Returns
    -------
    bary : (k, 3) float64
        NaN where the line is parallel to the plane or the triangle has no area.
    distance : (k,) float64
        In lengths of the direction, likewise.

    References
    ----------
    Moeller, Trumbore 1997, "Fast, minimum storage ray/triangle intersection".
    """
    first, second = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    away = origins - corners[:, 0]
    across, over = np.cross(directions, second), np.cross(away, first)
    volume = np.einsum("ij,ij->i", first, across)
    volume = np.where(volume == 0.0, np.nan, volume)
    bary = np.empty((len(origins), 3))
    bary[:, 1] = np.einsum("ij,ij->i", away, across) / volume
    bary[:, 2] = np.einsum("ij,ij->i", directions, over) / volume
    bary[:, 0] = 1.0 - bary[:, 1] - bary[:, 2]
    return bary, np.einsum("ij,ij->i", second, over) / volume


def _plane_bary(points: FloatArray, corners: FloatArray) -> FloatArray:
    """Return the coordinates of the foot on the plane; -1 where there is no plane."""
    first, second = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    away = points - corners[:, 0]
    normal = np.cross(first, second)
    squared = np.einsum("ij,ij->i", normal, normal)
    safe = np.where(squared > 0.0, squared, 1.0)
    bary = np.empty((len(points), 3))
    bary[:, 1] = np.einsum("ij,ij->i", np.cross(away, second), normal) / safe
    bary[:, 2] = np.einsum("ij,ij->i", np.cross(first, away), normal) / safe
    bary[:, 0] = 1.0 - bary[:, 1] - bary[:, 2]
    bary[squared == 0.0] = -1.0
    return bary


def _squared_gap(points: FloatArray, corners: FloatArray, bary: FloatArray) -> FloatArray:
    gap = points - np.einsum("kc,kcj->kj", bary, corners)
    return np.einsum("ij,ij->i", gap, gap)


def _keep_nearer(
    points: FloatArray,
    corners: FloatArray,
    bary: FloatArray,
    best: FloatArray,
    result: FloatArray,
) -> None:
    gap = _squared_gap(points, corners, bary)
    nearer = gap < best
    best[nearer] = gap[nearer]
    result[nearer] = bary[nearer]
