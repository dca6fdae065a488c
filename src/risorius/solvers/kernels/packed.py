# pyright: basic, reportCallIssue=false
# ruff: noqa: PLR0913, PLR0917
"""One pose in float32, `PACK` constraints without a common particle at a time."""

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
from risorius.solvers.kernels.memory import gather, load_pack, load_row, prefetch, scatter, store
from risorius.solvers.kernels.rings import project_ring_volumes
from risorius.solvers.kernels.simd import PACK
from risorius.solvers.kernels.single import project_contacts, project_holds, project_volumes

__all__ = ["iterate"]


# Groups whose entries are asked for in advance; large models stream through the cache.
_AHEAD = 24


@njit(**FLAGS)
def _expect(table, row, corners, backward):
    """Ask for the entries of a table that are needed some groups later."""
    ahead = row - _AHEAD * PACK if backward else row + _AHEAD * PACK
    if 0 <= ahead < table.size // corners:
        for corner in range(corners):
            prefetch(table, corners * ahead + corner * PACK)


@njit(**FLAGS)
def _holds(p, t, targets):
    """Draw particles to their targets, x, y, z at once; the targets' w is the particle's."""
    for c in range(t.hold_particles.size):
        i = 4 * t.hold_particles[c]
        here = load_row(p, i)
        store(p, i, here - t.hold_stiffness[c] * (here - load_row(targets, 4 * c)))


@njit(**FLAGS)
def _distances(p, t, pushed, backward, compliant):
    count = t.distance_rest.size // PACK
    for n in range(count):
        q = count - 1 - n if backward else n
        row = q * PACK
        i = 2 * row
        _expect(t.pairs, row, 2, backward)
        _expect(t.distance_rest, row, 1, backward)
        _expect(t.distance_gain, row, 1, backward)
        j = i + PACK
        ax, ay, az, wa = gather(p, t.pairs, i)
        bx, by, bz, wb = gather(p, t.pairs, j)
        x, y, z, length, per_length = measure_distance(ax, ay, az, bx, by, bz)
        gap = length - load_pack(t.distance_rest, row)
        if compliant:
            done = load_pack(pushed, row)
            step = (gap - load_pack(t.distance_compliance, row) * done) * load_pack(
                t.distance_gain, row
            )
            store(pushed, row, done + step)
        else:
            step = gap * load_pack(t.distance_gain, row)
        step = step * per_length
        sa = wa * step
        sb = wb * step
        scatter(p, t.pairs, i, ax - sa * x, ay - sa * y, az - sa * z, wa)
        scatter(p, t.pairs, j, bx + sb * x, by + sb * y, bz + sb * z, wb)


@njit(**FLAGS)
def _areas(p, t, pushed, backward, compliant):
    count = t.area_rest.size // PACK
    for n in range(count):
        q = count - 1 - n if backward else n
        row = q * PACK
        i = 3 * row
        j = i + PACK
        m = j + PACK
        ax, ay, az, wa = gather(p, t.corners, i)
        bx, by, bz, wb = gather(p, t.corners, j)
        cx, cy, cz, wc = gather(p, t.corners, m)
        area, weight, gradients = measure_area(ax, ay, az, bx, by, bz, cx, cy, cz, wa, wb, wc)
        gap = area - load_pack(t.area_rest, row)
        k = load_pack(t.area_stiffness, row)
        limit = load_pack(t.area_limit, row)
        if compliant:
            done = load_pack(pushed, row)
            step = compliant_step(gap, weight, k, done, limit)
            store(pushed, row, done + step)
        else:
            step = plain_step(gap, weight, k, limit)
        ax, ay, az, bx, by, bz, cx, cy, cz = move_area(
            step, gradients, ax, ay, az, bx, by, bz, cx, cy, cz, wa, wb, wc
        )
        scatter(p, t.corners, i, ax, ay, az, wa)
        scatter(p, t.corners, j, bx, by, bz, wb)
        scatter(p, t.corners, m, cx, cy, cz, wc)


@njit(**FLAGS)
def _bends(p, t, pushed, backward, compliant):
    count = t.bend_sine.size // PACK
    for n in range(count):
        q = count - 1 - n if backward else n
        row = q * PACK
        i = 4 * row
        _expect(t.flaps, row, 4, backward)
        _expect(t.bend_sine, row, 1, backward)
        _expect(t.bend_cosine, row, 1, backward)
        _expect(t.bend_stiffness, row, 1, backward)
        j = i + PACK
        m = j + PACK
        o = m + PACK
        px, py, pz, wp = gather(p, t.flaps, i)
        qx, qy, qz, wq = gather(p, t.flaps, j)
        ax, ay, az, wa = gather(p, t.flaps, m)
        bx, by, bz, wb = gather(p, t.flaps, o)
        sine = load_pack(t.bend_sine, row)
        cosine = load_pack(t.bend_cosine, row)
        gap, weight, per_ee, parts = measure_bend(
            px, py, pz, qx, qy, qz, ax, ay, az, bx, by, bz, wp, wq, wa, wb, sine, cosine
        )
        k = load_pack(t.bend_stiffness, row)
        limit = per_ee * t.bend_limit[0]
        if compliant:
            done = load_pack(pushed, row)
            step = compliant_step(gap, weight, k, done, limit)
            store(pushed, row, done + step)
        else:
            step = plain_step(gap, weight, k, limit)
        px, py, pz, qx, qy, qz, ax, ay, az, bx, by, bz = move_bend(
            step, parts, px, py, pz, qx, qy, qz, ax, ay, az, bx, by, bz, wp, wq, wa, wb
        )
        scatter(p, t.flaps, i, px, py, pz, wp)
        scatter(p, t.flaps, j, qx, qy, qz, wq)
        scatter(p, t.flaps, m, ax, ay, az, wa)
        scatter(p, t.flaps, o, bx, by, bz, wb)


@njit(**FLAGS)
def iterate(p, g, t, v, r, c, targets, rest, m, sweeps, first, alternating, compliant):
    """Project every constraint `sweeps` times, in order; odd sweeps backwards if alternating."""
    for sweep in range(first, first + sweeps):
        backward = alternating and sweep % 2 == 1
        if compliant:
            project_holds(p, t, targets, m.holds, True)
        else:
            _holds(p, t, targets)
        _distances(p, t, m.distances, backward, compliant)
        _areas(p, t, m.areas, backward, compliant)
        _bends(p, t, m.bends, backward, compliant)
        if r.rows.size:
            project_ring_volumes(p, g, v, r, rest, m.volumes, compliant)
        else:
            project_volumes(p, g, v, rest, m.volumes, compliant)
        project_contacts(p, c)
