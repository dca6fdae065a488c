# pyright: basic, reportCallIssue=false, reportGeneralTypeIssues=false
# ruff: noqa: PLR0913, PLR0917
"""`LANES` poses in float32, one constraint at a time, each pose in its lane.

`x` is flat: x, y and z of one particle are three vectors. Several blocks of `LANES` poses lie one
behind the other and are done one after the other; a caller may hand different blocks to different
threads, since no two touch the same memory and none waits for another.
"""

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
from risorius.solvers.kernels.lane_volumes import ROW, place, project_volumes, put
from risorius.solvers.kernels.memory import load, prefetch, store
from risorius.solvers.kernels.simd import LANES, larger, splat

__all__ = ["iterate", "largest_moves"]


# Constraints whose particles are asked for in advance: about as long as memory takes.
_AHEAD = 32


@njit(**FLAGS)
def _expect(x, particles, count, corners, c, backward):
    """Ask for the particles of the constraint that comes some steps later."""
    ahead = c - _AHEAD if backward else c + _AHEAD
    if 0 <= ahead < count:
        for corner in range(corners):
            i = ROW * particles[corners * ahead + corner]
            prefetch(x, i)
            prefetch(x, i + LANES)
            prefetch(x, i + 2 * LANES)


@njit(**FLAGS)
def _holds(x, w, t, targets, pushed, compliant):
    for c in range(t.hold_particles.size):
        particle = t.hold_particles[c]
        _expect(x, t.hold_particles, t.hold_particles.size, 1, c, False)
        wa = w[particle]
        k = t.hold_stiffness[c]
        if wa <= 0:
            continue
        for axis in range(3):
            i = ROW * particle + axis * LANES
            row = ROW * c + axis * LANES
            here = load(x, i)
            gap = here - load(targets, row)
            if compliant:
                done = load(pushed, row)
                step = (gap - k * done) / splat(x, wa + k)
                store(pushed, row, done + step)
                store(x, i, here - wa * step)
            else:
                store(x, i, here - k * gap)


@njit(**FLAGS)
def _distances(x, w, t, pushed, backward, compliant):
    count = t.distance_rest.size
    for n in range(count):
        c = count - 1 - n if backward else n
        _expect(x, t.pairs, count, 2, c, backward)
        i = t.pairs[2 * c]
        j = t.pairs[2 * c + 1]
        wa, wb = w[i], w[j]
        i, j = ROW * i, ROW * j
        ax, ay, az = place(x, i)
        bx, by, bz = place(x, j)
        dx, dy, dz, length, per_length = measure_distance(ax, ay, az, bx, by, bz)
        gap = length - t.distance_rest[c]
        if compliant:
            done = load(pushed, LANES * c)
            step = (gap - t.distance_compliance[c] * done) * t.distance_gain[c]
            store(pushed, LANES * c, done + step)
        else:
            step = gap * t.distance_gain[c]
        step = step * per_length
        sa = wa * step
        sb = wb * step
        put(x, i, ax - sa * dx, ay - sa * dy, az - sa * dz)
        put(x, j, bx + sb * dx, by + sb * dy, bz + sb * dz)


@njit(**FLAGS)
def _areas(x, w, t, pushed, backward, compliant):
    count = t.area_rest.size
    for n in range(count):
        c = count - 1 - n if backward else n
        _expect(x, t.corners, count, 3, c, backward)
        i = t.corners[3 * c]
        j = t.corners[3 * c + 1]
        m = t.corners[3 * c + 2]
        wa, wb, wc = w[i], w[j], w[m]
        i, j, m = ROW * i, ROW * j, ROW * m
        ax, ay, az = place(x, i)
        bx, by, bz = place(x, j)
        cx, cy, cz = place(x, m)
        area, weight, gradients = measure_area(ax, ay, az, bx, by, bz, cx, cy, cz, wa, wb, wc)
        gap = area - t.area_rest[c]
        if compliant:
            done = load(pushed, LANES * c)
            step = compliant_step(gap, weight, t.area_stiffness[c], done, t.area_limit[c])
            store(pushed, LANES * c, done + step)
        else:
            step = plain_step(gap, weight, t.area_stiffness[c], t.area_limit[c])
        ax, ay, az, bx, by, bz, cx, cy, cz = move_area(
            step, gradients, ax, ay, az, bx, by, bz, cx, cy, cz, wa, wb, wc
        )
        put(x, i, ax, ay, az)
        put(x, j, bx, by, bz)
        put(x, m, cx, cy, cz)


@njit(**FLAGS)
def _bends(x, w, t, pushed, backward, compliant):
    count = t.bend_sine.size
    for n in range(count):
        c = count - 1 - n if backward else n
        _expect(x, t.flaps, count, 4, c, backward)
        i = t.flaps[4 * c]
        j = t.flaps[4 * c + 1]
        m = t.flaps[4 * c + 2]
        o = t.flaps[4 * c + 3]
        wp, wq, wa, wb = w[i], w[j], w[m], w[o]
        i, j, m, o = ROW * i, ROW * j, ROW * m, ROW * o
        px, py, pz = place(x, i)
        qx, qy, qz = place(x, j)
        ax, ay, az = place(x, m)
        bx, by, bz = place(x, o)
        sine, cosine = t.bend_sine[c], t.bend_cosine[c]
        gap, weight, per_ee, parts = measure_bend(
            px, py, pz, qx, qy, qz, ax, ay, az, bx, by, bz, wp, wq, wa, wb, sine, cosine
        )
        limit = per_ee * t.bend_limit[0]
        if compliant:
            done = load(pushed, LANES * c)
            step = compliant_step(gap, weight, t.bend_stiffness[c], done, limit)
            store(pushed, LANES * c, done + step)
        else:
            step = plain_step(gap, weight, t.bend_stiffness[c], limit)
        px, py, pz, qx, qy, qz, ax, ay, az, bx, by, bz = move_bend(
            step, parts, px, py, pz, qx, qy, qz, ax, ay, az, bx, by, bz, wp, wq, wa, wb
        )
        put(x, i, px, py, pz)
        put(x, j, qx, qy, qz)
        put(x, m, ax, ay, az)
        put(x, o, bx, by, bz)


@njit(**FLAGS)
def _contacts(x, w, c):
    for contact in range(c.particles.size):
        particle = c.particles[contact]
        if w[particle] <= 0:
            continue
        i = ROW * particle
        ax, ay, az = place(x, i)
        qx, qy, qz = place(c.points, ROW * contact)
        nx, ny, nz = place(c.normals, ROW * contact)
        depth = (ax - qx) * nx + (ay - qy) * ny + (az - qz) * nz
        out = c.stiffness[0] * larger(-depth, splat(x, 0.0))
        put(x, i, ax + out * nx, ay + out * ny, az + out * nz)


@njit(**FLAGS)
def iterate(x, w, g, t, v, r, c, targets, rest, m, sweeps, first, alternating, compliant):
    """Project every constraint of one block of poses `sweeps` times, in order."""
    for sweep in range(first, first + sweeps):
        backward = alternating and sweep % 2 == 1
        _holds(x, w, t, targets, m.holds, compliant)
        _distances(x, w, t, m.distances, backward, compliant)
        _areas(x, w, t, m.areas, backward, compliant)
        _bends(x, w, t, m.bends, backward, compliant)
        project_volumes(x, w, g, v, r, rest, m.volumes, compliant)
        _contacts(x, w, c)


@njit(**FLAGS)
def largest_moves(x, before, particle_count, result):
    """Write the largest squared distance between `x` and `before` of each lane."""
    worst = splat(x, 0.0)
    for particle in range(particle_count):
        ax, ay, az = place(x, ROW * particle)
        bx, by, bz = place(before, ROW * particle)
        dx = ax - bx
        dy = ay - by
        dz = az - bz
        worst = larger(dx * dx + dy * dy + dz * dz, worst)
    store(result, 0, worst)
