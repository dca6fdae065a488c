# pyright: basic, reportCallIssue=false, reportGeneralTypeIssues=false
# ruff: noqa: PLR0913, PLR0917
"""The volumes of `LANES` poses, each pose in its lane.

By rings of neighbours where the surface has them (see `rings`), else face by face.
"""

from numba import njit

from risorius.solvers.kernels.formulas import FLAGS
from risorius.solvers.kernels.memory import load, store
from risorius.solvers.kernels.simd import LANES, splat

__all__ = ["ROW", "place", "project_volumes", "put"]

# Numbers per particle.
ROW = 3 * LANES


@njit(**FLAGS)
def place(x, row):
    """Return x, y, z of the particle whose vectors start at `row`."""
    return load(x, row), load(x, row + LANES), load(x, row + 2 * LANES)


@njit(**FLAGS)
def put(x, row, a, b, c):
    """Write x, y, z of the particle whose vectors start at `row`."""
    store(x, row, a)
    store(x, row + LANES, b)
    store(x, row + 2 * LANES, c)


@njit(**FLAGS)
def _add(x, row, a, b, c):
    store(x, row, load(x, row) + a)
    store(x, row + LANES, load(x, row + LANES) + b)
    store(x, row + 2 * LANES, load(x, row + 2 * LANES) + c)


@njit(**FLAGS)
def _cross(ax, ay, az, bx, by, bz):
    return ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx


@njit(**FLAGS)
def _open_caps(x, v, volume):
    for cap in range(v.cap_start[volume], v.cap_start[volume + 1]):
        first, last = v.rim_start[cap], v.rim_start[cap + 1]
        sx = sy = sz = splat(x, 0.0)
        for entry in range(first, last):
            ax, ay, az = place(x, ROW * v.rims[entry])
            sx = sx + ax
            sy = sy + ay
            sz = sz + az
        share = splat(x, 1.0 / (last - first))
        put(x, ROW * v.cap_rows[cap], sx * share, sy * share, sz * share)


@njit(**FLAGS)
def _close_caps(g, v, volume):
    for cap in range(v.cap_start[volume], v.cap_start[volume + 1]):
        row = ROW * v.cap_rows[cap]
        first, last = v.rim_start[cap], v.rim_start[cap + 1]
        share = splat(g, 1.0 / (last - first))
        gx, gy, gz = place(g, row)
        zero = splat(g, 0.0)
        put(g, row, zero, zero, zero)
        for entry in range(first, last):
            _add(g, ROW * v.rims[entry], gx * share, gy * share, gz * share)


@njit(**FLAGS)
def _by_faces(x, w, g, v, volume):
    """Write the gradient of six times a volume to `g`; return that volume and W."""
    zero = splat(x, 0.0)
    for entry in range(v.particle_start[volume], v.particle_start[volume + 1]):
        put(g, ROW * v.particles[entry], zero, zero, zero)
    total = zero
    for face in range(v.face_start[volume], v.face_start[volume + 1]):
        i = ROW * v.faces[3 * face]
        j = ROW * v.faces[3 * face + 1]
        m = ROW * v.faces[3 * face + 2]
        ax, ay, az = place(x, i)
        bx, by, bz = place(x, j)
        cx, cy, cz = place(x, m)
        nx, ny, nz = _cross(bx, by, bz, cx, cy, cz)
        total = total + ax * nx + ay * ny + az * nz
        _add(g, i, nx, ny, nz)
        nx, ny, nz = _cross(cx, cy, cz, ax, ay, az)
        _add(g, j, nx, ny, nz)
        nx, ny, nz = _cross(ax, ay, az, bx, by, bz)
        _add(g, m, nx, ny, nz)
    _close_caps(g, v, volume)
    weight = zero
    for particle in v.particles[v.particle_start[volume] : v.particle_start[volume + 1]]:
        gx, gy, gz = place(g, ROW * particle)
        weight = weight + w[particle] * (gx * gx + gy * gy + gz * gz)
    return total, weight


@njit(**FLAGS)
def _by_rings(x, w, g, v, r, volume):
    """Do what `_by_faces` does, without writing to one particle more than once."""
    moment = splat(x, 0.0)
    weight = moment
    for cap in range(v.cap_start[volume], v.cap_start[volume + 1]):
        gx = gy = gz = splat(x, 0.0)
        first, last = v.rim_start[cap], v.rim_start[cap + 1]
        bx, by, bz = place(x, ROW * v.rims[last - 1])
        for entry in range(first, last):
            ax, ay, az = place(x, ROW * v.rims[entry])
            nx, ny, nz = _cross(ax, ay, az, bx, by, bz)
            gx = gx + nx
            gy = gy + ny
            gz = gz + nz
            bx, by, bz = ax, ay, az
        row = ROW * v.cap_rows[cap]
        ax, ay, az = place(x, row)
        moment = moment + (ax * gx + ay * gy + az * gz)
        share = splat(x, 1.0 / (last - first))
        put(g, row, gx * share, gy * share, gz * share)
    for group in range(r.group_start[volume], r.group_start[volume + 1]):
        first = r.ring_start[group]
        gx = gy = gz = splat(x, 0.0)
        bx, by, bz = place(x, ROW * r.rings[first])
        for entry in range(first + 1, r.ring_start[group + 1]):
            ax, ay, az = place(x, ROW * r.rings[entry])
            nx, ny, nz = _cross(bx, by, bz, ax, ay, az)
            gx = gx + nx
            gy = gy + ny
            gz = gz + nz
            bx, by, bz = ax, ay, az
        row = ROW * r.rows[group]
        ax, ay, az = place(x, row)
        moment = moment + (ax * gx + ay * gy + az * gz)
        if r.has_rim[group]:
            bx, by, bz = place(g, ROW * r.caps[group])
            gx = gx + bx
            gy = gy + by
            gz = gz + bz
        put(g, row, gx, gy, gz)
        weight = weight + w[r.rows[group]] * (gx * gx + gy * gy + gz * gz)
    for cap in range(v.cap_start[volume], v.cap_start[volume + 1]):
        zero = splat(x, 0.0)
        put(g, ROW * v.cap_rows[cap], zero, zero, zero)
    return moment * splat(x, 1.0 / 3.0), weight


@njit(**FLAGS)
def project_volumes(x, w, g, v, r, rest, pushed, compliant):
    """Bring each volume to `rest`; `g` is scratch of the shape of `x`."""
    for volume in range(v.stiffness.size):
        _open_caps(x, v, volume)
        if r.rows.size:
            total, weight = _by_rings(x, w, g, v, r, volume)
        else:
            total, weight = _by_faces(x, w, g, v, volume)
        touched = v.particles[v.particle_start[volume] : v.particle_start[volume + 1]]
        k = v.stiffness[volume]
        gap = total - load(rest, LANES * volume) * 6.0
        if compliant:
            done = load(pushed, LANES * volume)
            step = (gap - k * done) / (weight + k + 1e-12)
            store(pushed, LANES * volume, done + step)
        else:
            step = k * gap / (weight + 1e-12)
        for particle in touched:
            row = ROW * particle
            part = w[particle] * step
            gx, gy, gz = place(g, row)
            _add(x, row, -(part * gx), -(part * gy), -(part * gz))
