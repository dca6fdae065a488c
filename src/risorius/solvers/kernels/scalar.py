# pyright: basic
# ruff: noqa: PLR0913, PLR0917
"""The reference: one pose in float64, constraint after constraint."""

from numba import njit

from risorius.solvers.kernels.formulas import (
    FLAGS,
    compliant_step,
    measure_area,
    measure_bend,
    measure_distance,
    move_area,
    move_bend,
    plain_step,
)
from risorius.solvers.kernels.single import project_contacts, project_holds, project_volumes

__all__ = ["iterate"]


@njit(**FLAGS)
def _distances(p, t, pushed, backward, compliant):
    count = t.distance_rest.size
    for n in range(count):
        c = count - 1 - n if backward else n
        i = 4 * t.pairs[2 * c]
        j = 4 * t.pairs[2 * c + 1]
        wa, wb = p[i + 3], p[j + 3]
        x, y, z, length, per_length = measure_distance(
            p[i], p[i + 1], p[i + 2], p[j], p[j + 1], p[j + 2]
        )
        gap = length - t.distance_rest[c]
        if compliant:
            step = (gap - t.distance_compliance[c] * pushed[c]) * t.distance_gain[c]
            pushed[c] += step
        else:
            step = gap * t.distance_gain[c]
        step = step * per_length
        wa, wb = wa * step, wb * step
        p[i] -= wa * x
        p[i + 1] -= wa * y
        p[i + 2] -= wa * z
        p[j] += wb * x
        p[j + 1] += wb * y
        p[j + 2] += wb * z


@njit(**FLAGS)
def _areas(p, t, pushed, backward, compliant):
    count = t.area_rest.size
    for n in range(count):
        c = count - 1 - n if backward else n
        i = 4 * t.corners[3 * c]
        j = 4 * t.corners[3 * c + 1]
        m = 4 * t.corners[3 * c + 2]
        a = (p[i], p[i + 1], p[i + 2], p[j], p[j + 1], p[j + 2], p[m], p[m + 1], p[m + 2])
        w = (p[i + 3], p[j + 3], p[m + 3])
        area, weight, gradients = measure_area(*a, *w)
        gap = area - t.area_rest[c]
        if compliant:
            step = compliant_step(gap, weight, t.area_stiffness[c], pushed[c], t.area_limit[c])
            pushed[c] += step
        else:
            step = plain_step(gap, weight, t.area_stiffness[c], t.area_limit[c])
        (
            p[i],
            p[i + 1],
            p[i + 2],
            p[j],
            p[j + 1],
            p[j + 2],
            p[m],
            p[m + 1],
            p[m + 2],
        ) = move_area(step, gradients, *a, *w)


@njit(**FLAGS)
def _bends(p, t, pushed, backward, compliant):
    count = t.bend_sine.size
    for n in range(count):
        c = count - 1 - n if backward else n
        i = 4 * t.flaps[4 * c]
        j = 4 * t.flaps[4 * c + 1]
        m = 4 * t.flaps[4 * c + 2]
        o = 4 * t.flaps[4 * c + 3]
        ends = (p[i], p[i + 1], p[i + 2], p[j], p[j + 1], p[j + 2])
        tips = (p[m], p[m + 1], p[m + 2], p[o], p[o + 1], p[o + 2])
        w = (p[i + 3], p[j + 3], p[m + 3], p[o + 3])
        gap, weight, per_ee, parts = measure_bend(
            *ends, *tips, *w, t.bend_sine[c], t.bend_cosine[c]
        )
        limit = per_ee * t.bend_limit[0]
        if compliant:
            step = compliant_step(gap, weight, t.bend_stiffness[c], pushed[c], limit)
            pushed[c] += step
        else:
            step = plain_step(gap, weight, t.bend_stiffness[c], limit)
        (
            p[i],
            p[i + 1],
            p[i + 2],
            p[j],
            p[j + 1],
            p[j + 2],
            p[m],
            p[m + 1],
            p[m + 2],
            p[o],
            p[o + 1],
            p[o + 2],
        ) = move_bend(step, parts, *ends, *tips, *w)


@njit(**FLAGS)
def iterate(p, g, t, v, r, c, targets, rest, m, sweeps, first, alternating, compliant):
    """Project every constraint `sweeps` times, in order; odd sweeps backwards if alternating."""
    for sweep in range(first, first + sweeps):
        backward = alternating and sweep % 2 == 1
        project_holds(p, t, targets, m.holds, compliant)
        _distances(p, t, m.distances, backward, compliant)
        _areas(p, t, m.areas, backward, compliant)
        _bends(p, t, m.bends, backward, compliant)
        project_volumes(p, g, v, rest, m.volumes, compliant)
        project_contacts(p, c)
