"""Building blocks of implicit surfaces: negative inside, positive outside [mm].

Every function takes query points ``(n, 3)`` and returns one value per point. Blends and
scaled metrics are not exact distances; whoever needs a distance measures it on the mesh.
"""

from __future__ import annotations

import numpy as np
from numba import njit, prange
from scipy.interpolate import CubicSpline

__all__ = [
    "cut",
    "ellipsoid",
    "fold",
    "polygon",
    "rotation",
    "smooth_curve",
    "tube",
    "union",
    "within_box",
]


def fold(points):
    """Return a copy of `points` (n, 3) with x replaced by its absolute value."""
    folded = np.array(points, float)
    folded[:, 0] = np.abs(folded[:, 0])
    return folded


def union(a, b, radius):
    """Join two fields with a fillet of about `radius` [mm] (polynomial smooth minimum)."""
    overlap = np.maximum(radius - np.abs(a - b), 0.0) / radius
    return np.minimum(a, b) - overlap**2 * radius * 0.25


def cut(a, b, radius):
    """Intersect two fields with a rounded edge; pass ``-b`` to carve `b` out of `a`."""
    return -union(-a, -b, radius)


def rotation(about_x=0.0, about_y=0.0, about_z=0.0):
    """Return the matrix (3, 3) that turns about x, then y, then z [degrees]."""
    angles = np.radians([about_x, about_y, about_z])
    (cx, cy, cz), (sx, sy, sz) = np.cos(angles), np.sin(angles)
    turn_x = np.array([[1, 0, 0], [0, cx, -sx], [0, sx, cx]])
    turn_y = np.array([[cy, 0, sy], [0, 1, 0], [-sy, 0, cy]])
    turn_z = np.array([[cz, -sz, 0], [sz, cz, 0], [0, 0, 1]])
    return turn_z @ turn_y @ turn_x


def ellipsoid(points, centre, radii, turn=None):
    """Field of an ellipsoid, near the true distance at its surface."""
    local = points - np.asarray(centre, float)
    if turn is not None:
        local = local @ turn
    radii = np.asarray(radii, float)
    inner = np.sqrt(((local / radii) ** 2).sum(axis=1))
    outer = np.sqrt(((local / radii**2) ** 2).sum(axis=1)) + 1e-9
    return inner * (inner - 1.0) / outer


def smooth_curve(knots, count, *, closed=False):
    """Resample the polyline `knots` (k, d) as a cubic spline with `count` points."""
    knots = np.asarray(knots, float)
    if closed:
        knots = np.vstack([knots, knots[:1]])
    step = np.sqrt(np.linalg.norm(np.diff(knots[:, :3], axis=0), axis=1))
    at = np.concatenate([[0.0], np.cumsum(step)])
    spline = CubicSpline(at, knots, bc_type="periodic" if closed else "natural")
    return spline(np.linspace(0.0, at[-1], count))


@njit(parallel=True, cache=True)
def _tube_kernel(points, centres, radii, out):
    for i in prange(points.shape[0]):
        best = 1e9
        for j in range(centres.shape[0] - 1):
            dot = 0.0
            length = 1e-12
            for k in range(3):
                edge = centres[j + 1, k] - centres[j, k]
                dot += (points[i, k] - centres[j, k]) * edge
                length += edge * edge
            t = min(1.0, max(0.0, dot / length))
            square = 0.0
            for k in range(3):
                edge = centres[j + 1, k] - centres[j, k]
                square += (points[i, k] - centres[j, k] - t * edge) ** 2
            best = min(best, np.sqrt(square) - (radii[j] + t * (radii[j + 1] - radii[j])))
        out[i] = best


def tube(points, knots, count=24, *, closed=False, scale=(1.0, 1.0, 1.0)):
    """Field of a tube swept along a spline.

    Parameters
    ----------
    points : (n, 3) ndarray
    knots : (k, 4) array_like
        Centre and radius of the tube [mm].
    count : int
        Samples of the spline.
    scale : (3,) array_like
        Stretch of the cross-section along the axes; above 1 is fatter.
    """
    curve = smooth_curve(knots, count, closed=closed)
    scale = np.asarray(scale, float)
    out = np.empty(len(points))
    centres, radii = np.ascontiguousarray(curve[:, :3] / scale), curve[:, 3].copy()
    _tube_kernel(np.ascontiguousarray(points / scale), centres, radii, out)
    return out * scale.min()


@njit(parallel=True, cache=True)
def _polygon_kernel(points, corners, out):
    for i in prange(points.shape[0]):
        px, py = points[i, 0], points[i, 1]
        square = 1e18
        inside = False
        j = corners.shape[0] - 1
        for k in range(corners.shape[0]):
            ex, ey = corners[j, 0] - corners[k, 0], corners[j, 1] - corners[k, 1]
            wx, wy = px - corners[k, 0], py - corners[k, 1]
            t = min(1.0, max(0.0, (wx * ex + wy * ey) / (ex * ex + ey * ey + 1e-12)))
            square = min(square, (wx - ex * t) ** 2 + (wy - ey * t) ** 2)
            if (corners[k, 1] > py) != (corners[j, 1] > py) and wx < ex * wy / ey:
                inside = not inside
            j = k
        out[i] = -np.sqrt(square) if inside else np.sqrt(square)


def polygon(plane_points, corners, *, smooth=0):
    """Signed distance in the plane to a polygon; `smooth` > 0 rounds it to that many samples.

    Parameters
    ----------
    plane_points : (n, 2) ndarray
    corners : (k, 2) array_like
    """
    corners = np.asarray(corners, float)
    if smooth:
        flat = np.column_stack([corners, np.zeros(len(corners))])
        corners = smooth_curve(flat, smooth, closed=True)[:-1, :2]
    out = np.empty(len(plane_points))
    _polygon_kernel(np.ascontiguousarray(plane_points, float), np.ascontiguousarray(corners), out)
    return out


def within_box(points, values, centre, half_size, change):
    """Return `values` (n,) after ``change(points, values)`` inside a box only, for speed."""
    inside = np.flatnonzero((np.abs(points - np.asarray(centre, float)) < half_size).all(axis=1))
    if len(inside):
        values = values.copy()
        values[inside] = change(points[inside], values[inside])
    return values
