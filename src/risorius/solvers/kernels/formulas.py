# pyright: basic
# ruff: noqa: PLR0913, PLR0917
"""The arithmetic of every projection, for numbers and for vectors alike (spec section 2.1).

Of each kind `measure_*` returns the error C, the weight W = sum w |grad C|^2 and what `move_*`
needs to subtract step * w * grad C. The step is s = k C / W as published (`plain_step`), or
(C - a m) / (W + a) with compliance a and multiplier m (`compliant_step`, XPBD). `limit` bounds it:
W is not let fall below limit (k C)^2, hence no particle moves by more than sqrt(w_max / limit).
Lengths are in units of the mean edge.
"""

from numba import njit

from risorius.solvers.kernels.simd import larger, reciprocal, reciprocal_root, signed_angle

__all__ = [
    "compliant_step",
    "measure_area",
    "measure_bend",
    "measure_distance",
    "move_area",
    "move_bend",
    "plain_step",
]

# No infinities for degenerate configurations: the gradient that multiplies 1 / TINY is 0 there.
_TINY = 1e-12

# Contraction and reciprocals only: not-a-number stays not-a-number and is found.
FLAGS = {"fastmath": {"contract", "nsz"}, "cache": True, "error_model": "numpy", "nogil": True}
# Vectors handed to a real call would travel through memory.
_INLINED = {**FLAGS, "forceinline": True}


@njit(**_INLINED)
def plain_step(value, weight, stiffness, limit):
    """Return k C / W."""
    part = stiffness * value
    return part * reciprocal(larger(weight, part * part * limit) + _TINY)


@njit(**_INLINED)
def compliant_step(value, weight, compliance, multiplier, limit):
    """Return (C - a m) / (W + a)."""
    part = value - compliance * multiplier
    return part * reciprocal(larger(weight, part * part * limit) + compliance + _TINY)


@njit(**_INLINED)
def measure_distance(ax, ay, az, bx, by, bz):
    """Return the vector from b to a, its length and the reciprocal of that."""
    x = ax - bx
    y = ay - by
    z = az - bz
    square = x * x + y * y + z * z + _TINY * _TINY
    per_length = reciprocal_root(square)
    return x, y, z, square * per_length, per_length


@njit(**_INLINED)
def measure_area(ax, ay, az, bx, by, bz, cx, cy, cz, wa, wb, wc):
    """Return the area, W, and the gradients at b and c (at a: minus their sum)."""
    ux = bx - ax
    uy = by - ay
    uz = bz - az
    vx = cx - ax
    vy = cy - ay
    vz = cz - az
    nx = uy * vz - uz * vy
    ny = uz * vx - ux * vz
    nz = ux * vy - uy * vx
    square = nx * nx + ny * ny + nz * nz + _TINY * _TINY
    per_double = reciprocal_root(square)
    half = per_double * 0.5
    nx = nx * half
    ny = ny * half
    nz = nz * half
    gbx = vy * nz - vz * ny
    gby = vz * nx - vx * nz
    gbz = vx * ny - vy * nx
    gcx = ny * uz - nz * uy
    gcy = nz * ux - nx * uz
    gcz = nx * uy - ny * ux
    gax = gbx + gcx
    gay = gby + gcy
    gaz = gbz + gcz
    weight = (
        wa * (gax * gax + gay * gay + gaz * gaz)
        + wb * (gbx * gbx + gby * gby + gbz * gbz)
        + wc * (gcx * gcx + gcy * gcy + gcz * gcz)
    )
    return square * half, weight, (gbx, gby, gbz, gcx, gcy, gcz)


@njit(**_INLINED)
def move_area(step, gradients, ax, ay, az, bx, by, bz, cx, cy, cz, wa, wb, wc):
    """Return the corners moved by step."""
    gbx, gby, gbz, gcx, gcy, gcz = gradients
    sa = step * wa
    sb = step * wb
    sc = step * wc
    return (
        ax + sa * (gbx + gcx),
        ay + sa * (gby + gcy),
        az + sa * (gbz + gcz),
        bx - sb * gbx,
        by - sb * gby,
        bz - sb * gbz,
        cx - sc * gcx,
        cy - sc * gcy,
        cz - sc * gcz,
    )


@njit(**_INLINED)
def measure_bend(
    px, py, pz, qx, qy, qz, ax, ay, az, bx, by, bz, wp, wq, wa, wb, rest_sine, rest_cosine
):
    """Return theta - theta0, W, 1 / |e|^2 and the parts of the gradient.

    The edge runs from p to q, a and b are the far corners. With m = e x (a - p) and
    n = (b - p) x e the gradients are -|e| m / |m|^2 at a, -|e| n / |n|^2 at b, and at p and q
    shares of them: 1 - t, 1 - s and t, s, where t and s are the feet of a and b on the edge.
    """
    ex = qx - px
    ey = qy - py
    ez = qz - pz
    ax = ax - px
    ay = ay - py
    az = az - pz
    bx = bx - px
    by = by - py
    bz = bz - pz
    mx = ey * az - ez * ay
    my = ez * ax - ex * az
    mz = ex * ay - ey * ax
    nx = by * ez - bz * ey
    ny = bz * ex - bx * ez
    nz = bx * ey - by * ex
    ee = ex * ex + ey * ey + ez * ez + _TINY
    mm = mx * mx + my * my + mz * mz + _TINY
    nn = nx * nx + ny * ny + nz * nz + _TINY
    mn = mx * nx + my * ny + mz * nz
    per_length = reciprocal_root(ee)
    length = ee * per_length
    root = reciprocal_root(mm * nn)
    both = root * root
    cosine = mn * root
    sine = -(mx * bx + my * by + mz * bz) * length * root
    value = signed_angle(
        sine * rest_cosine - cosine * rest_sine, cosine * rest_cosine + sine * rest_sine
    )
    per_ee = per_length * per_length
    t = (ax * ex + ay * ey + az * ez) * per_ee
    s = (bx * ex + by * ey + bz * ez) * per_ee
    t1 = 1.0 - t
    s1 = 1.0 - s
    per_mm = nn * both
    per_nn = mm * both
    gaa = ee * per_mm
    gbb = ee * per_nn
    gab = ee * mn * both
    gab = gab + gab
    weight = (
        wa * gaa
        + wb * gbb
        + wp * (t1 * t1 * gaa + t1 * s1 * gab + s1 * s1 * gbb)
        + wq * (t * t * gaa + t * s * gab + s * s * gbb)
    )
    return value, weight, per_ee, (mx, my, mz, nx, ny, nz, length * per_mm, length * per_nn, t, s)


@njit(**_INLINED)
def move_bend(step, parts, px, py, pz, qx, qy, qz, ax, ay, az, bx, by, bz, wp, wq, wa, wb):
    """Return the ends and far corners moved by step."""
    mx, my, mz, nx, ny, nz, at_m, at_n, t, s = parts
    at_m = step * at_m
    at_n = step * at_n
    mx = mx * at_m
    my = my * at_m
    mz = mz * at_m
    nx = nx * at_n
    ny = ny * at_n
    nz = nz * at_n
    pt = wp * (1.0 - t)
    ps = wp * (1.0 - s)
    qt = wq * t
    qs = wq * s
    return (
        px - pt * mx - ps * nx,
        py - pt * my - ps * ny,
        pz - pt * mz - ps * nz,
        qx - qt * mx - qs * nx,
        qy - qt * my - qs * ny,
        qz - qt * mz - qs * nz,
        ax + wa * mx,
        ay + wa * my,
        az + wa * mz,
        bx + wb * nx,
        by + wb * ny,
        bz + wb * nz,
    )
