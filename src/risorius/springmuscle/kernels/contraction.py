# pyright: basic
# ruff: noqa: PLR0913, PLR0917
"""How fibres contract, and how linked ends are held together (Kaehler et al. 2001, section 4)."""

import math

from numba import njit

__all__ = ["FLAGS", "contract_points", "hold_links"]

FLAGS = {"fastmath": {"contract", "nsz"}, "cache": True, "error_model": "numpy", "nogil": True}

# A contracted muscle keeps this share of its length (erratum E1).
LEAST = 0.01


@njit(**FLAGS)
def slide_along(points, first, last, contraction, fixed_point, lengths, result):
    """Slide points first..last along their own polyline towards the one place that stays.

    ``t~ = t0 + max(1 - c, 0.01) (t - t0)`` with t the arc length; t0 = 0, the origin, as published
    (errata E1, E6). `lengths` is room for the arc lengths.
    """
    total = 0.0
    lengths[first] = 0.0
    for i in range(first + 1, last + 1):
        square = 0.0
        for axis in range(3):
            square += (points[i, axis] - points[i - 1, axis]) ** 2
        total += math.sqrt(square)
        lengths[i] = total
    pull = min(max(contraction, 0.0), 1.0 - LEAST)
    k = first
    for i in range(first, last + 1):
        place = lengths[i] - pull * (lengths[i] - fixed_point * total)
        while k < last - 1 and lengths[k + 1] < place:
            k += 1
        span = lengths[k + 1] - lengths[k]
        part = (place - lengths[k]) / span if span > 0.0 else 0.0
        # With no contraction the point itself is returned, to the last bit.
        if pull == 0.0:
            part, k = 0.0, i
        for axis in range(3):
            result[i, axis] = points[k, axis]
            if part != 0.0:
                result[i, axis] += part * (points[k + 1, axis] - points[k, axis])


@njit(**FLAGS)
def draw_towards(points, aims, shares, first, last, contraction, pivot, result):
    """Draw points first..last to their aims: ``q = a + max(1 - c, 0.01) (p - a)``.

    A finite `pivot` (3,) keeps their distance from the horizontal axis through it: they slide
    around an eyeball.
    """
    for i in range(first, last + 1):
        pull = min(max(contraction, 0.0) * shares[i], 1.0 - LEAST)
        for axis in range(3):
            result[i, axis] = points[i, axis] + pull * (aims[i, axis] - points[i, axis])
        if pull > 0.0 and pivot[0] == pivot[0]:
            before = math.hypot(points[i, 1] - pivot[1], points[i, 2] - pivot[2])
            after = math.hypot(result[i, 1] - pivot[1], result[i, 2] - pivot[2])
            if after > 0.0:
                for axis in range(1, 3):
                    result[i, axis] = pivot[axis] + before / after * (result[i, axis] - pivot[axis])


@njit(**FLAGS)
def contract_points(
    points,
    aims,
    shares,
    starts,
    fibre_muscle,
    rings,
    contractions,
    fixed_points,
    pivots,
    room,
    result,
):
    """Contract every fibre; `result` (p, 3) receives the control points, `room` (p,) is scratch."""
    for f in range(len(starts) - 1):
        first, last, m = starts[f], starts[f + 1] - 1, fibre_muscle[f]
        if rings[m]:
            draw_towards(points, aims, shares, first, last, contractions[m], pivots[m], result)
        else:
            slide_along(points, first, last, contractions[m], fixed_points[m], room, result)


@njit(**FLAGS)
def hold_links(
    q, places, starts, ends, hosts, rest, active, fixed, twins, yielding, sweeps, tolerance
):
    """Gauss-Seidel sweeps over linked ends; return the sweeps done and the last change.

    Each link keeps the relaxed distances `rest` (l, 2) between the end of one fibre and the two
    points of the segment that it lies in. `ends` (l, 2) are fibre and point, `hosts` (l, 2) the
    two points, `places` (p,) the relaxed share of its fibre's length at each point: the correction
    of an end is spread over its fibre and fades towards the origin. `fixed` points (p,) stay.
    `twins` (p,) is the other copy of a ring's first point, or the point itself. An `active` fibre's
    points (p,) take `yielding` of a correction against 1.
    """
    change = 0.0
    for sweep in range(sweeps):
        change = 0.0
        for k in range(len(ends)):
            f, e = ends[k, 0], ends[k, 1]
            mine = yielding if active[e] else 1.0
            for side in range(2):
                b = hosts[k, side]
                other = 0.0 if fixed[b] else (yielding if active[b] else 1.0)
                dx, dy, dz = q[b, 0] - q[e, 0], q[b, 1] - q[e, 1], q[b, 2] - q[e, 2]
                length = math.sqrt(dx * dx + dy * dy + dz * dz) + 1e-12
                gap = (length - rest[k, side]) / length / (mine + other)
                change = max(change, abs(gap) * length * max(mine, other))
                for i in range(starts[f], starts[f + 1]):
                    share = places[i] * mine * gap
                    q[i, 0] += share * dx
                    q[i, 1] += share * dy
                    q[i, 2] += share * dz
                if other > 0.0:
                    q[b, 0] -= other * gap * dx
                    q[b, 1] -= other * gap * dy
                    q[b, 2] -= other * gap * dz
                    if twins[b] != b:
                        for axis in range(3):
                            q[twins[b], axis] = q[b, axis]
        if change < tolerance:
            return sweep + 1, change
    return sweeps, change
