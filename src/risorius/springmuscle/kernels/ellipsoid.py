# pyright: basic
# ruff: noqa: PLR0913, PLR0917
"""Ellipsoids in their own coordinates, and which of them a vertex is bound to."""

import math

from numba import njit

from risorius.springmuscle.kernels.contraction import FLAGS

__all__ = ["bind_vertices", "cast_rays", "closest_local", "closest_on"]

_ITERATIONS = 60
_EXACT = 1e-13
# A vertex that a foot lies beside, not under, counts as this much farther away at most.
_LEAST_COSINE = 0.05


@njit(**FLAGS)
def closest_local(y, a, foot):
    """Put the point nearest to `y` (3,) on the ellipsoid with half axes `a` (3,) into `foot`.

    The foot is ``a^2 y / (a^2 + l)`` with l the largest root of
    ``sum (a y / (a^2 + l))^2 = 1``, a convex falling function: Newton's method from the left never
    passes the root. From the middle plane of a flat ellipsoid both sides are equally near; the
    positive one is taken.
    """
    least = min(a[0], a[1], a[2])
    root = -least * least
    for k in range(3):
        if y[k] != 0.0:
            root = max(root, a[k] * abs(y[k]) - a[k] * a[k])
    for _ in range(_ITERATIONS):
        value, slope = -1.0, 0.0
        for k in range(3):
            if y[k] != 0.0:
                q = a[k] * y[k] / (a[k] * a[k] + root)
                value += q * q
                slope -= 2.0 * q * q / (a[k] * a[k] + root)
        if value <= _EXACT:
            break
        root -= value / slope
    left = 1.0
    for k in range(3):
        if y[k] != 0.0:
            foot[k] = a[k] * a[k] * y[k] / (a[k] * a[k] + root)
            left -= (foot[k] / a[k]) ** 2
        else:
            foot[k] = 0.0
    if root == -least * least and left > 0.0:
        for k in range(3):
            if a[k] == least and y[k] == 0.0:
                foot[k] = least * math.sqrt(left)
                break


@njit(**FLAGS)
def closest_on(local, half_axes, feet):
    """Fill `feet` (q, 3): nearest points on the ellipsoids, in their own coordinates."""
    for i in range(len(local)):
        closest_local(local[i], half_axes[i], feet[i])


@njit(**FLAGS)
def cast_rays(origins, directions, centres, frames, half_axes, distances, hit):
    """Fill distances (q,) and ellipsoid numbers (q,) of the first hits; inf and -1 for misses."""
    for r in range(len(origins)):
        for s in range(len(centres)):
            a, b, c = 0.0, 0.0, -1.0
            for k in range(3):
                start, way = 0.0, 0.0
                for axis in range(3):
                    start += frames[s, axis, k] * (origins[r, axis] - centres[s, axis])
                    way += frames[s, axis, k] * directions[r, axis]
                start, way = start / half_axes[s, k], way / half_axes[s, k]
                a, b, c = a + way * way, b + way * start, c + start * start
            square = b * b - a * c
            if square < 0.0:
                continue
            # Outside the near root is the hit, inside the far one.
            near = (-b - math.sqrt(square)) / a
            far = (-b + math.sqrt(square)) / a
            t = near if near >= 0.0 else far
            if 0.0 <= t < distances[r]:
                distances[r] = t
                hit[r] = s


@njit(**FLAGS)
def bind_vertices(
    positions, normals, vertex_lips, centres, frames, half_axes, lips, radius, divide, guard,
    segments, feet, distances,
):  # fmt: skip
    """Find the best ellipsoid of one muscle for every vertex.

    The score is distance / max(N.d, 0.05), N.d <= 0 refused, with d the unit vector from the foot
    to the vertex (erratum E5); without `divide` it is distance * N.d, as printed. With `guard`, an
    ellipsoid under one lip never takes a vertex of the other. Vertices inside the muscle have no
    foot below them and stay free.
    """
    for i in range(len(positions)):
        best = math.inf
        for s in range(len(centres)):
            if guard and vertex_lips[i] * lips[s] < 0:
                continue
            reach = radius + max(half_axes[s, 0], half_axes[s, 1], half_axes[s, 2])
            dx = positions[i, 0] - centres[s, 0]
            dy = positions[i, 1] - centres[s, 1]
            dz = positions[i, 2] - centres[s, 2]
            if dx * dx + dy * dy + dz * dz > reach * reach:
                continue
            score, distance, fx, fy, fz = rate_foot(
                dx, dy, dz, normals[i], frames[s], half_axes[s], radius, divide
            )
            if score < 0.0:
                segments[i] = -1
                break
            if score < best:
                best = score
                segments[i] = s
                distances[i] = distance
                feet[i, 0], feet[i, 1], feet[i, 2] = fx, fy, fz


@njit(**FLAGS)
def rate_foot(dx, dy, dz, normal, frame, a, radius, divide):
    """Return score, distance and local foot of a vertex; inf where refused, -1 where inside."""
    y0 = frame[0, 0] * dx + frame[1, 0] * dy + frame[2, 0] * dz
    y1 = frame[0, 1] * dx + frame[1, 1] * dy + frame[2, 1] * dz
    y2 = frame[0, 2] * dx + frame[1, 2] * dy + frame[2, 2] * dz
    if (y0 / a[0]) ** 2 + (y1 / a[1]) ** 2 + (y2 / a[2]) ** 2 < 1.0:
        return -1.0, 0.0, 0.0, 0.0, 0.0
    f0, f1, f2 = outside_foot(y0, y1, y2, a)
    e0, e1, e2 = y0 - f0, y1 - f1, y2 - f2
    distance = math.sqrt(e0 * e0 + e1 * e1 + e2 * e2)
    if distance > radius or distance == 0.0:
        return math.inf, 0.0, 0.0, 0.0, 0.0
    cosine = 0.0
    for axis in range(3):
        cosine += normal[axis] * (frame[axis, 0] * e0 + frame[axis, 1] * e1 + frame[axis, 2] * e2)
    cosine /= distance
    if cosine <= 0.0:
        return math.inf, 0.0, 0.0, 0.0, 0.0
    score = distance / max(cosine, _LEAST_COSINE) if divide else distance * cosine
    return score, distance, f0, f1, f2


@njit(**FLAGS)
def outside_foot(y0, y1, y2, a):
    """Return `closest_local` of a point that is not inside, without arrays."""
    root = max(a[0] * abs(y0) - a[0] ** 2, a[1] * abs(y1) - a[1] ** 2, a[2] * abs(y2) - a[2] ** 2)
    root = max(root, 0.0)
    for _ in range(_ITERATIONS):
        q0, q1, q2 = (
            a[0] * y0 / (a[0] ** 2 + root),
            a[1] * y1 / (a[1] ** 2 + root),
            a[2] * y2 / (a[2] ** 2 + root),
        )
        value = q0 * q0 + q1 * q1 + q2 * q2 - 1.0
        if value <= _EXACT:
            break
        root += value / (
            2.0
            * (
                q0 * q0 / (a[0] ** 2 + root)
                + q1 * q1 / (a[1] ** 2 + root)
                + q2 * q2 / (a[2] ** 2 + root)
            )
        )
    return (
        a[0] ** 2 * y0 / (a[0] ** 2 + root),
        a[1] ** 2 * y1 / (a[1] ** 2 + root),
        a[2] ** 2 * y2 / (a[2] ** 2 + root),
    )
