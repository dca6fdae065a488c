# pyright: basic
# ruff: noqa: PLR0913, PLR0917
"""How much of the sky each pixel sees, judged by the depth of its neighbours.

The estimate follows the idea of horizon-free obscurance (sum over nearby points of the cosine
to the normal, fading with the distance) on a spiral of taps, so that both the crease beside
the lid and the whole opening of the mouth count.
"""

import math

import numpy as np
from numba import njit

__all__ = ["blended", "corner_shares", "occlude", "reduce_depth", "soften", "spiral"]

# Taps reach at most so far [pixels]; things nearer by so many radii no longer count.
_WIDEST = 400.0
_DEEP = 3.0
_GAIN = 2.0
_PIT = 1.5


def spiral(*, taps=20, turns=7):
    """Return (16, taps, 3): a spiral of taps within radius 1, in 16 turned positions.

    The third number is the weight of a tap, which falls with its distance from the middle.
    """
    share = (np.arange(taps) + 0.5) / taps
    angle = 2.0 * np.pi * (turns * share[None, :] + np.arange(16)[:, None] / 16.0)
    x, y = np.cos(angle) * share, np.sin(angle) * share
    return np.stack([x, y, 1.0 - (x * x + y * y)], axis=2)


@njit(cache=True, nogil=True, error_model="numpy")
def corner_shares(edges, px, py):
    """Return the barycentric coordinates at the sample (px, py) from the middle."""
    a = edges[0] * px + edges[1] * py + edges[2]
    b = edges[3] * px + edges[4] * py + edges[5]
    c = edges[6] * px + edges[7] * py + edges[8]
    whole = 1.0 / (a + b + c)
    return a * whole, b * whole, c * whole


@njit(cache=True, nogil=True, error_model="numpy")
def blended(table, rows, u, v, w):
    """Return the three columns of `table` blended over the corners `rows`."""
    i, j, k = rows[0], rows[1], rows[2]
    return (
        u * table[i, 0] + v * table[j, 0] + w * table[k, 0],
        u * table[i, 1] + v * table[j, 1] + w * table[k, 1],
        u * table[i, 2] + v * table[j, 2] + w * table[k, 2],
    )


@njit(cache=True, nogil=True, error_model="numpy")
def reduce_depth(
    row_from,
    row_to,
    step,
    inverse_depth,
    face,
    edges,
    volume,
    normals,
    normal_rows,
    depth,
    normal,
):
    """Write depth (h, w) and normal (h, w, 3) of the nearest of each pixel's samples."""
    rows, columns = face.shape
    half_w, half_h = 0.5 * columns - 0.5, 0.5 * rows - 0.5
    for y in range(row_from, row_to):
        for x in range(depth.shape[1]):
            best, best_y, best_x = np.float32(0.0), -1, -1
            for sy in range(y * step, y * step + step):
                for sx in range(x * step, x * step + step):
                    if inverse_depth[sy, sx] > best:
                        best, best_y, best_x = inverse_depth[sy, sx], sy, sx
            if best_y < 0:
                depth[y, x] = np.inf
                continue
            f = face[best_y, best_x]
            px, py = best_x - half_w, best_y - half_h
            u, v, w = corner_shares(edges[f], px, py)
            nx, ny, nz = blended(normals, normal_rows[f], u, v, w)
            scale = 1.0 / (math.sqrt(nx * nx + ny * ny + nz * nz) + 1e-30)
            if volume[f] > 0.0:
                scale = -scale
            depth[y, x] = 1.0 / best
            normal[y, x, 0], normal[y, x, 1], normal[y, x, 2] = nx * scale, ny * scale, nz * scale


@njit(cache=True, nogil=True, error_model="numpy")
def occlude(row_from, row_to, depth, normal, focal, radius, spiral, open_sky):
    """Write `open_sky` (h, w): 1 where nothing within `radius` hides the sky, towards 0."""
    height, width = depth.shape
    half_w, half_h = 0.5 * width - 0.5, 0.5 * height - 0.5
    deepest2 = (_DEEP * radius) ** 2
    # Divisions cost more than all else here.
    per_focal, per_radius, per_deepest2 = 1.0 / focal, 1.0 / radius, 1.0 / deepest2
    for y in range(row_from, row_to):
        for x in range(width):
            z = depth[y, x]
            open_sky[y, x] = 1.0
            reach = radius * focal / z
            if not reach >= 1.0:
                continue
            reach = min(reach, _WIDEST)
            z_per_focal = z * per_focal
            px, py = (x - half_w) * z_per_focal, (y - half_h) * z_per_focal
            nx, ny, nz = normal[y, x, 0], normal[y, x, 1], normal[y, x, 2]
            taps = spiral[((x & 3) * 4 + (y & 3)) * 7 & 15]
            hidden = pit = 0.0
            for tap in range(taps.shape[0]):
                qx = x + round(taps[tap, 0] * reach)
                qy = y + round(taps[tap, 1] * reach)
                if qx < 0 or qy < 0 or qx >= width or qy >= height:
                    continue
                far = depth[qy, qx]
                if far == np.inf:
                    continue
                far_per_focal = far * per_focal
                dx = (qx - half_w) * far_per_focal - px
                dy = (qy - half_h) * far_per_focal - py
                dz = far - z
                length2 = dx * dx + dy * dy + dz * dz
                if dz * dz >= deepest2 or length2 == 0.0:
                    continue
                cosine = (dx * nx + dy * ny + dz * nz) / math.sqrt(length2)
                fade = taps[tap, 2] * (1.0 - dz * dz * per_deepest2)
                hidden += max(0.0, cosine - 0.10) * fade
                pit += min(max(-dz * per_radius, -1.0), 1.0) * fade
            open_sky[y, x] = max(0.0, 1.0 - (_GAIN * hidden + _PIT * max(pit, 0.0)) / taps.shape[0])


@njit(cache=True, nogil=True, error_model="numpy")
def soften(row_from, row_to, depth, radius, down, open_sky, out):
    """Average five pixels of about the same depth in a column (`down`) or row into `out`.

    The weights 1/2, 1, 1, 1, 1/2 cancel a pattern of period 4, that of the turned spirals.
    """
    height, width = depth.shape
    dy, dx = (1, 0) if down else (0, 1)
    for y in range(row_from, row_to):
        for x in range(width):
            z = depth[y, x]
            if z == np.inf:
                out[y, x] = 1.0
                continue
            total, weight = 0.0, 0.0
            for k in range(-2, 3):
                qy, qx = y + k * dy, x + k * dx
                if qy < 0 or qx < 0 or qy >= height or qx >= width:
                    continue
                if abs(depth[qy, qx] - z) > 0.3 * radius:
                    continue
                share = 0.5 if abs(k) == 2 else 1.0
                total += share * open_sky[qy, qx]
                weight += share
            out[y, x] = total / weight
