# pyright: basic, reportCallIssue=false
# ruff: noqa: PLR0915
"""The volume of one pose in float32, by the rings of neighbours around each particle.

The gradient of six times the volume at a particle is the sum of q_s x q_(s+1) over the closed ring
of its neighbours, so `PACK` particles can be done side by side without writing to any other; and
six times the volume is a third of the sum of p . g over all of them.
"""

from numba import njit

from risorius.solvers.kernels.formulas import FLAGS
from risorius.solvers.kernels.memory import gather, lane_sum, load_pack, prefetch, scatter, store
from risorius.solvers.kernels.simd import PACK
from risorius.solvers.kernels.single import add_cross, open_caps

__all__ = ["project_ring_volumes"]

# Entries of the rings that are asked for in advance.
_AHEAD = 24 * PACK


@njit(**FLAGS)
def _cap_shares(p, g, v, volume):
    """Put the share of each hole's gradient that a rim particle gets into the hole's row of `g`.

    Returns the holes' part of the sum of p . g.
    """
    total = p[0] * 0
    for cap in range(v.cap_start[volume], v.cap_start[volume + 1]):
        row = 4 * v.cap_rows[cap]
        first, last = v.rim_start[cap], v.rim_start[cap + 1]
        for axis in range(3):
            g[row + axis] = 0
        before = 4 * v.rims[last - 1]
        for entry in range(first, last):
            here = 4 * v.rims[entry]
            add_cross(g, row, here, before, p)
            before = here
        for axis in range(3):
            total += p[row + axis] * g[row + axis]
            g[row + axis] /= last - first
    return total


@njit(**FLAGS)
def project_ring_volumes(p, g, v, r, rest, pushed, compliant):
    """Bring each volume to `rest`; `g` and `r.gradients` are scratch."""
    for volume in range(v.stiffness.size):
        open_caps(p, v, volume)
        from_caps = _cap_shares(p, g, v, volume)
        first, last = r.group_start[volume], r.group_start[volume + 1]
        x, y, z, w = gather(p, r.rows, first * PACK)
        moment = x * 0.0
        weight = moment
        for group in range(first, last):
            place = r.ring_start[group]
            ax, ay, az, w = gather(p, r.rings, place)
            gx = ax * 0.0
            gy = gx
            gz = gx
            for turn in range(place + PACK, r.ring_start[group + 1], PACK):
                prefetch(r.rings, min(turn + _AHEAD, r.rings.size - 1))
                bx, by, bz, w = gather(p, r.rings, turn)
                gx = gx + (ay * bz - az * by)
                gy = gy + (az * bx - ax * bz)
                gz = gz + (ax * by - ay * bx)
                ax, ay, az = bx, by, bz
            if r.has_rim[group]:
                sx, sy, sz, w = gather(g, r.caps, group * PACK)
                gx = gx + sx
                gy = gy + sy
                gz = gz + sz
                x, y, z, w = gather(p, r.rows, group * PACK)
                # The shares count for the weight, but not once more for the volume.
                moment = moment - (x * sx + y * sy + z * sz)
            else:
                x, y, z, w = gather(p, r.rows, group * PACK)
            moment = moment + (x * gx + y * gy + z * gz)
            weight = weight + w * (gx * gx + gy * gy + gz * gz)
            store(r.gradients, 3 * group * PACK, gx)
            store(r.gradients, (3 * group + 1) * PACK, gy)
            store(r.gradients, (3 * group + 2) * PACK, gz)
        total = lane_sum(weight)
        if total <= 0:
            continue
        k = v.stiffness[volume]
        gap = (lane_sum(moment) + from_caps) / 3 - 6 * rest[volume]
        if compliant:
            step = (gap - k * pushed[volume]) / (total + k)
            pushed[volume] += step
        else:
            step = k * gap / total
        for group in range(first, last):
            x, y, z, w = gather(p, r.rows, group * PACK)
            part = w * step
            gx = load_pack(r.gradients, 3 * group * PACK)
            gy = load_pack(r.gradients, (3 * group + 1) * PACK)
            gz = load_pack(r.gradients, (3 * group + 2) * PACK)
            scatter(p, r.rows, group * PACK, x - part * gx, y - part * gy, z - part * gz, w)
