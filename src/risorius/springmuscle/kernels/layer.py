# pyright: basic
# ruff: noqa: PLR0913, PLR0917
"""Depth of a grid's cells below the skin, by rays against a few triangles."""

import math

import numpy as np
from numba import njit

from risorius.springmuscle.kernels.contraction import FLAGS

__all__ = ["cast_lines", "measure_cells"]

# Skin counts as hit only where it faces along the ray.
_FACING = 0.15
# Meeting points may lie this far outside a triangle, so that no ray slips between two.
_SLACK = 1e-9
_LEAST_SAMPLES, _MOST_SAMPLES = 3, 20


@njit(**FLAGS)
def line_meets(x, y, z, dx, dy, dz, corners, t):
    """Return the signed distance at which a line meets triangle `t`, nan where it does not."""
    ax, ay, az = corners[t, 0, 0], corners[t, 0, 1], corners[t, 0, 2]
    e0, e1, e2 = corners[t, 1, 0] - ax, corners[t, 1, 1] - ay, corners[t, 1, 2] - az
    f0, f1, f2 = corners[t, 2, 0] - ax, corners[t, 2, 1] - ay, corners[t, 2, 2] - az
    p0, p1, p2 = dy * f2 - dz * f1, dz * f0 - dx * f2, dx * f1 - dy * f0
    volume = e0 * p0 + e1 * p1 + e2 * p2
    if volume == 0.0:
        return math.nan
    s0, s1, s2 = x - ax, y - ay, z - az
    u = (s0 * p0 + s1 * p1 + s2 * p2) / volume
    if u < -_SLACK or u > 1.0 + _SLACK:
        return math.nan
    q0, q1, q2 = s1 * e2 - s2 * e1, s2 * e0 - s0 * e2, s0 * e1 - s1 * e0
    v = (dx * q0 + dy * q1 + dz * q2) / volume
    if v < -_SLACK or u + v > 1.0 + _SLACK:
        return math.nan
    return (f0 * q0 + f1 * q1 + f2 * q2) / volume


@njit(**FLAGS)
def nearest_meeting(
    x, y, z, dx, dy, dz, corners, normals, middles, radii, taken, chosen, count, reach
):  # fmt: skip
    """Return signed distance and triangle of the meeting nearest to the point, nan and -1.

    Triangles that are not `taken` hide what lies behind them.
    """
    best, found = math.nan, -1
    for k in range(count):
        t = chosen[k]
        mx, my, mz = middles[t, 0] - x, middles[t, 1] - y, middles[t, 2] - z
        along = mx * dx + my * dy + mz * dz
        aside = mx * mx + my * my + mz * mz - along * along
        # Rounding must not lose a line through a corner.
        if aside > radii[t] * radii[t] * 1.000001:
            continue
        if normals[t, 0] * dx + normals[t, 1] * dy + normals[t, 2] * dz <= _FACING:
            continue
        distance = line_meets(x, y, z, dx, dy, dz, corners, t)
        if abs(distance) <= reach and not abs(distance) >= abs(best):
            best, found = distance, t
    if found >= 0 and not taken[found]:
        return math.nan, -1
    return best, found


@njit(**FLAGS)
def gather(x, y, z, nx, ny, nz, radius, tilt, reach, middles, radii, chosen):
    """Put the triangles that lines from around a point can meet into `chosen`; return how many.

    The lines start within `radius` of the point and lean against the unit vector n by at most
    `tilt` (tangent of the angle).
    """
    count = 0
    for t in range(len(middles)):
        dx, dy, dz = middles[t, 0] - x, middles[t, 1] - y, middles[t, 2] - z
        along = abs(dx * nx + dy * ny + dz * nz)
        size = radius + radii[t]
        far = size + tilt * (along + size)
        if along <= reach + size and dx * dx + dy * dy + dz * dz - along * along <= far * far:
            chosen[count] = t
            count += 1
    return count


@njit(**FLAGS)
def lean(normals, r, c, nx, ny, nz):
    """Return the greatest tangent of the angle of a cell's normals against the unit vector n."""
    most = 0.0
    for a in range(2):
        for b in range(2):
            x, y, z = normals[r + a, c + b, 0], normals[r + a, c + b, 1], normals[r + a, c + b, 2]
            along = x * nx + y * ny + z * nz
            if along < 0.1:
                return 10.0
            most = max(most, math.sqrt(max(x * x + y * y + z * z - along * along, 0.0)) / along)
    return most


@njit(**FLAGS)
def cast_lines(points, directions, corners, normals, middles, radii, taken, reach, distances, hit):
    """Fill signed distance and triangle of the skin nearest to each point along its direction."""
    chosen = np.empty(len(corners), np.int32)
    for i in range(len(points)):
        x, y, z = points[i, 0], points[i, 1], points[i, 2]
        dx, dy, dz = directions[i, 0], directions[i, 1], directions[i, 2]
        count = gather(x, y, z, dx, dy, dz, 0.0, 0.0, reach, middles, radii, chosen)
        distances[i], hit[i] = nearest_meeting(
            x, y, z, dx, dy, dz, corners, normals, middles, radii, taken, chosen, count, reach
        )


@njit(**FLAGS)
def measure_cells(
    grid, grid_normals, dirty, corners, normals, middles, radii, taken, edge, reach, low, high,
    nearest, farthest, near_place, far_place, counts,
):  # fmt: skip
    """Measure the depth of the `dirty` cells of a grid (r, c, 3), by bilinear samples.

    Of each cell: least and greatest signed distance to the skin, positive below it, where they are
    (u along the rows, v along the columns), and how many samples there are, hit, and hit inside
    `low`..`high` (r - 1, c - 1). Three samples per mean `edge` of the skin.
    """
    chosen = np.empty(len(corners), np.int32)
    w = np.empty(4)
    for r in range(dirty.shape[0]):
        for c in range(dirty.shape[1]):
            if not dirty[r, c]:
                continue
            x, y, z, radius, long, wide = cell_bounds(grid, r, c)
            w[:] = 0.25
            nx, ny, nz = unit_blend(grid_normals, r, c, w)
            tilt = lean(grid_normals, r, c, nx, ny, nz)
            count = gather(x, y, z, nx, ny, nz, radius, tilt, reach, middles, radii, chosen)
            rows = min(max(math.ceil(3.0 * long / edge) + 1, _LEAST_SAMPLES), _MOST_SAMPLES)
            cols = min(max(math.ceil(3.0 * wide / edge) + 1, _LEAST_SAMPLES), _MOST_SAMPLES)
            nearest[r, c], farthest[r, c] = math.inf, -math.inf
            counts[r, c, 0], counts[r, c, 1], counts[r, c, 2] = rows * cols, 0, 0
            for i in range(rows):
                for j in range(cols):
                    u, v = i / (rows - 1), j / (cols - 1)
                    w[0], w[1], w[2], w[3] = (1 - u) * (1 - v), (1 - u) * v, u * (1 - v), u * v
                    px, py, pz = blend(grid, r, c, w)
                    nx, ny, nz = unit_blend(grid_normals, r, c, w)
                    depth, found = nearest_meeting(
                        px, py, pz, nx, ny, nz, corners, normals, middles, radii, taken, chosen,
                        count, reach,
                    )  # fmt: skip
                    if found < 0:
                        continue
                    counts[r, c, 1] += 1
                    if low[r, c] - 1e-9 <= depth <= high[r, c] + 1e-9:
                        counts[r, c, 2] += 1
                    if depth < nearest[r, c]:
                        nearest[r, c] = depth
                        near_place[r, c, 0], near_place[r, c, 1] = u, v
                    if depth > farthest[r, c]:
                        farthest[r, c] = depth
                        far_place[r, c, 0], far_place[r, c, 1] = u, v
            if counts[r, c, 1] == 0:
                nearest[r, c] = farthest[r, c] = 0.0


@njit(**FLAGS)
def blend(values, r, c, w):
    """Return the bilinear mean of a grid's vectors in cell (r, c) with weights `w` (4,)."""
    x = w[0] * values[r, c, 0] + w[1] * values[r, c + 1, 0]
    x += w[2] * values[r + 1, c, 0] + w[3] * values[r + 1, c + 1, 0]
    y = w[0] * values[r, c, 1] + w[1] * values[r, c + 1, 1]
    y += w[2] * values[r + 1, c, 1] + w[3] * values[r + 1, c + 1, 1]
    z = w[0] * values[r, c, 2] + w[1] * values[r, c + 1, 2]
    z += w[2] * values[r + 1, c, 2] + w[3] * values[r + 1, c + 1, 2]
    return x, y, z


@njit(**FLAGS)
def unit_blend(values, r, c, w):
    """Return `blend` at length 1, zero where it is zero."""
    x, y, z = blend(values, r, c, w)
    size = math.sqrt(x * x + y * y + z * z)
    if size > 0.0:
        x, y, z = x / size, y / size, z / size
    return x, y, z


@njit(**FLAGS)
def cell_bounds(grid, r, c):
    """Return middle, radius, and longest extent along rows and columns of a cell."""
    x = 0.25 * (grid[r, c, 0] + grid[r, c + 1, 0] + grid[r + 1, c, 0] + grid[r + 1, c + 1, 0])
    y = 0.25 * (grid[r, c, 1] + grid[r, c + 1, 1] + grid[r + 1, c, 1] + grid[r + 1, c + 1, 1])
    z = 0.25 * (grid[r, c, 2] + grid[r, c + 1, 2] + grid[r + 1, c, 2] + grid[r + 1, c + 1, 2])
    radius = 0.0
    for a in range(2):
        for b in range(2):
            dx, dy = grid[r + a, c + b, 0] - x, grid[r + a, c + b, 1] - y
            dz = grid[r + a, c + b, 2] - z
            radius = max(radius, math.sqrt(dx * dx + dy * dy + dz * dz))
    long = max(gap(grid, r, c, r + 1, c), gap(grid, r, c + 1, r + 1, c + 1))
    wide = max(gap(grid, r, c, r, c + 1), gap(grid, r + 1, c, r + 1, c + 1))
    return x, y, z, radius, long, wide


@njit(**FLAGS)
def gap(grid, r, c, s, d):
    """Return the distance of two grid points."""
    dx = grid[r, c, 0] - grid[s, d, 0]
    dy = grid[r, c, 1] - grid[s, d, 1]
    dz = grid[r, c, 2] - grid[s, d, 2]
    return math.sqrt(dx * dx + dy * dy + dz * dz)
