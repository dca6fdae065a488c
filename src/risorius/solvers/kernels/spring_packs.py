# pyright: basic, reportCallIssue=false, reportGeneralTypeIssues=false
# ruff: noqa: PLR0913, PLR0917
"""Springs, one pose in float32, `PACK` particles at a time.

Each particle sums over its own springs, so that nothing is scattered and no two packs wait for
each other; an edge is computed from both ends, which is cheaper than writing to two places.
"""

import math

from numba import njit

from risorius.solvers.kernels.formulas import FLAGS
from risorius.solvers.kernels.memory import gather, lane_sum, load_pack, scatter, store
from risorius.solvers.kernels.simd import PACK, larger, reciprocal_root

__all__ = ["leapfrog_packs"]

_INLINED = {**FLAGS, "forceinline": True}

_ROW = 3 * PACK
_EDGE, _BIPHASIC = 2 * PACK, 3 * PACK
_ANCHOR = 5 * PACK
# Keeps the reciprocal of a length 0 finite; the vector that it multiplies is 0 there.
_TINY = 1e-24


@njit(**_INLINED)
def _pull_of_edges(t, rows, block, x, y, z, fx, fy, fz):
    """Add what linear edges exert: ``k (L - L0) / L = k - k L0 / L``, which needs no L."""
    for slot in range(t.edge_start[block], t.edge_start[block + 1]):
        ox, oy, oz, _ = gather(rows, t.neighbours, slot * PACK)
        dx, dy, dz, per_length = _apart(x, y, z, ox, oy, oz)
        row = slot * _EDGE
        pull = load_pack(t.edge_rows, row) - load_pack(t.edge_rows, row + PACK) * per_length
        fx = fx - pull * dx
        fy = fy - pull * dy
        fz = fz - pull * dz
    return fx, fy, fz


@njit(**_INLINED)
def _pull_of_biphasic_edges(t, rows, block, x, y, z, fx, fy, fz):
    """As `_pull_of_edges`, plus ``s k max(1 - L1 / L, 0)`` beyond the knees L1."""
    for slot in range(t.edge_start[block], t.edge_start[block + 1]):
        ox, oy, oz, _ = gather(rows, t.neighbours, slot * PACK)
        dx, dy, dz, per_length = _apart(x, y, z, ox, oy, oz)
        row = slot * _BIPHASIC
        stiffness = load_pack(t.edge_rows, row)
        pull = stiffness - load_pack(t.edge_rows, row + PACK) * per_length
        beyond = 1.0 - load_pack(t.edge_rows, row + 2 * PACK) * per_length
        pull = pull + t.stiffening[0] * stiffness * larger(beyond, beyond * 0.0)
        fx = fx - pull * dx
        fy = fy - pull * dy
        fz = fz - pull * dz
    return fx, fy, fz


@njit(**_INLINED)
def _pull_of_anchors(t, block, x, y, z, fx, fy, fz):
    for slot in range(t.anchor_start[block], t.anchor_start[block + 1]):
        row = slot * _ANCHOR
        ax, ay, az = _place(t.anchor_rows, row)
        dx, dy, dz, per_length = _apart(x, y, z, ax, ay, az)
        row += 3 * PACK
        pull = load_pack(t.anchor_rows, row) - load_pack(t.anchor_rows, row + PACK) * per_length
        fx = fx - pull * dx
        fy = fy - pull * dy
        fz = fz - pull * dz
    return fx, fy, fz


@njit(**_INLINED)
def _apart(ax, ay, az, bx, by, bz):
    """Return the vector from b to a and the reciprocal of its length."""
    x = ax - bx
    y = ay - by
    z = az - bz
    return x, y, z, reciprocal_root(x * x + (y * y + (z * z + _TINY)))


@njit(**_INLINED)
def _place(array, row):
    return (
        load_pack(array, row),
        load_pack(array, row + PACK),
        load_pack(array, row + 2 * PACK),
    )


@njit(**_INLINED)
def _put(array, row, x, y, z):
    store(array, row, x)
    store(array, row + PACK, y)
    store(array, row + 2 * PACK, z)


@njit(**FLAGS)
def _forces(rows, x, v, t, forces, peak):
    """Write all forces; return the power and, in `peak` (PACK,), the largest squares of f / m."""
    most = load_pack(peak, 0) * 0.0
    power = most
    for block in range(t.edge_start.size - 1):
        row = block * _ROW
        px, py, pz = _place(x, row)
        fx, fy, fz = _place(t.load, row)
        hx, hy, hz = _place(t.hold_targets, row)
        held = load_pack(t.hold_stiffness, block * PACK)
        fx = fx - held * (px - hx)
        fy = fy - held * (py - hy)
        fz = fz - held * (pz - hz)
        if t.stiffening[0] > 0.0:
            fx, fy, fz = _pull_of_biphasic_edges(t, rows, block, px, py, pz, fx, fy, fz)
        else:
            fx, fy, fz = _pull_of_edges(t, rows, block, px, py, pz, fx, fy, fz)
        fx, fy, fz = _pull_of_anchors(t, block, px, py, pz, fx, fy, fz)
        _put(forces, row, fx, fy, fz)
        w = load_pack(t.inv_mass, block * PACK)
        vx, vy, vz = _place(v, row)
        power = power + fx * vx + fy * vy + fz * vz
        most = larger(most, (fx * fx + fy * fy + fz * fz) * (w * w))
    store(peak, 0, most)
    return lane_sum(power)


@njit(**FLAGS)
def _move(rows, x, v, t, forces, dt, kept):
    none = load_pack(t.inv_mass, 0) * 0.0
    for block in range(t.edge_start.size - 1):
        row = block * _ROW
        px, py, pz = _place(x, row)
        vx, vy, vz = _place(v, row)
        fx, fy, fz = _place(forces, row)
        w = load_pack(t.inv_mass, block * PACK) * dt
        vx = kept * (vx + w * fx)
        vy = kept * (vy + w * fy)
        vz = kept * (vz + w * fz)
        px = px + dt * vx
        py = py + dt * vy
        pz = pz + dt * vz
        _put(v, row, vx, vy, vz)
        _put(x, row, px, py, pz)
        scatter(rows, t.own, block * PACK, px, py, pz, none)


@njit(**FLAGS)
def leapfrog_packs(rows, x, v, t, forces, peak, dt, drag, kinetic, tolerance, limit):
    """As `springs.leapfrog`, with `rows` (4 n,) and `x` (3 n,) the same places in two layouts."""
    kept = peak[0] * 0 + math.exp(-drag * dt)
    residual = 0.0
    for step in range(limit):
        power = _forces(rows, x, v, t, forces, peak)
        residual = 0.0
        for lane in range(PACK):
            # Not-a-number wins, so that it is found.
            if not peak[lane] <= residual:
                residual = peak[lane]
        if residual <= tolerance * tolerance or not residual < 1e24:
            return step, math.sqrt(residual)
        if kinetic and power < 0.0:
            v[:] = 0.0
        _move(rows, x, v, t, forces, dt, kept)
    return limit, math.sqrt(residual)
