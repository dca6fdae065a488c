# pyright: basic
# ruff: noqa: PLR0913, PLR0917
"""Which triangle each sample sees."""

import math

import numpy as np
from numba import njit

__all__ = ["area_normals", "fill", "prepare"]


@njit(cache=True, nogil=True, error_model="numpy")
def area_normals(positions, faces, out):
    """Write the unit sums of the doubled face areas around each vertex to `out` (n, 3), zeros."""
    for f in range(faces.shape[0]):
        a, b, c = faces[f, 0], faces[f, 1], faces[f, 2]
        x, y, z = positions[a, 0], positions[a, 1], positions[a, 2]
        ux, uy, uz = positions[b, 0] - x, positions[b, 1] - y, positions[b, 2] - z
        vx, vy, vz = positions[c, 0] - x, positions[c, 1] - y, positions[c, 2] - z
        nx, ny, nz = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
        for k in (a, b, c):
            out[k, 0] += nx
            out[k, 1] += ny
            out[k, 2] += nz
    for k in range(out.shape[0]):
        length = math.sqrt(out[k, 0] ** 2 + out[k, 1] ** 2 + out[k, 2] ** 2)
        if length > 0.0:
            out[k, 0] /= length
            out[k, 1] /= length
            out[k, 2] /= length


@njit(cache=True, nogil=True, error_model="numpy")
def prepare(view, faces, near, width, height, edges, volume, box):
    """Write edges (m, 9), volume (m,) and box (m, 4): first, last column, first, last row."""
    for f in range(faces.shape[0]):
        a, b, c = faces[f, 0], faces[f, 1], faces[f, 2]
        ax, ay, az = view[a, 0], view[a, 1], view[a, 2]
        bx, by, bz = view[b, 0], view[b, 1], view[b, 2]
        cx, cy, cz = view[c, 0], view[c, 1], view[c, 2]
        e = edges[f]
        e[0], e[1], e[2] = by * cz - bz * cy, bz * cx - bx * cz, bx * cy - by * cx
        e[3], e[4], e[5] = cy * az - cz * ay, cz * ax - cx * az, cx * ay - cy * ax
        e[6], e[7], e[8] = ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx
        volume[f] = ax * e[0] + ay * e[1] + az * e[2]
        if not math.isfinite(volume[f]):
            # Coordinates so large that their products overflow: nothing to be drawn.
            volume[f] = 0.0
            box[f, 0], box[f, 1], box[f, 2], box[f, 3] = 0, -1, 0, -1
            continue
        low_x = low_y = np.inf
        high_x = high_y = -np.inf
        for k in range(3):
            i, j = faces[f, k], faces[f, (k + 1) % 3]
            zi, zj = view[i, 2], view[j, 2]
            if zi >= near:
                x, y = view[i, 0] / zi, view[i, 1] / zi
                low_x, high_x = min(low_x, x), max(high_x, x)
                low_y, high_y = min(low_y, y), max(high_y, y)
            if (zi >= near) != (zj >= near):
                t = (near - zi) / (zj - zi)
                x = (view[i, 0] + t * (view[j, 0] - view[i, 0])) / near
                y = (view[i, 1] + t * (view[j, 1] - view[i, 1])) / near
                low_x, high_x = min(low_x, x), max(high_x, x)
                low_y, high_y = min(low_y, y), max(high_y, y)
        # A hair of slack: the box only saves work, the edges decide.
        half_w, half_h = 0.5 * width - 0.5, 0.5 * height - 0.5
        box[f, 0] = int(np.ceil(min(max(low_x + half_w - 1e-6, 0.0), float(width))))
        box[f, 1] = int(np.floor(max(min(high_x + half_w + 1e-6, width - 1.0), -1.0)))
        box[f, 2] = int(np.ceil(min(max(low_y + half_h - 1e-6, 0.0), float(height))))
        box[f, 3] = int(np.floor(max(min(high_y + half_h + 1e-6, height - 1.0), -1.0)))


@njit(cache=True, nogil=True, error_model="numpy")
def _span(slope, start, half_w, left, right):
    """Return left and right cut where ``slope (x - half_w) + start`` turns negative.

    A hundredth of a sample is left over: the span only saves work, the edges decide.
    """
    if slope > 0.0:
        return max(left, half_w - start / slope - 0.01), right
    if slope < 0.0:
        return left, min(right, half_w - start / slope + 0.01)
    return left, right


@njit(cache=True, nogil=True, error_model="numpy")
def fill(
    row_from, row_to, first, last, edges, volume, box, ceiling, floor, peel, inverse_depth, face
):
    """Keep, for each sample of the rows, the nearest of the triangles first..last - 1.

    Only inverse depths below `ceiling[0, 0]` count (the near plane). While peeling, `ceiling`
    and `floor` hold a bound for each sample: the layer in front and the opaque one behind.
    """
    height, width = face.shape
    half_w, half_h = 0.5 * width - 0.5, 0.5 * height - 0.5
    limit = ceiling[0, 0]
    for f in range(first, last):
        y_from, y_to = max(box[f, 2], row_from), min(box[f, 3], row_to - 1)
        x_from, x_to = box[f, 0], box[f, 1]
        d = volume[f]
        if y_from > y_to or x_from > x_to or d == 0.0:
            continue
        sign = 1.0 if d > 0.0 else -1.0
        scale = 1.0 / d
        ax, ay, az = edges[f, 0], edges[f, 1], edges[f, 2]
        bx, by, bz = edges[f, 3], edges[f, 4], edges[f, 5]
        cx, cy, cz = edges[f, 6], edges[f, 7], edges[f, 8]
        for y in range(y_from, y_to + 1):
            py = y - half_h
            row_a, row_b, row_c = ay * py + az, by * py + bz, cy * py + cz
            left, right = float(x_from), float(x_to)
            left, right = _span(ax * sign, row_a * sign, half_w, left, right)
            left, right = _span(bx * sign, row_b * sign, half_w, left, right)
            left, right = _span(cx * sign, row_c * sign, half_w, left, right)
            for x in range(math.ceil(left), math.floor(right) + 1):
                px = x - half_w
                a, b, c = ax * px + row_a, bx * px + row_b, cx * px + row_c
                if a * sign < 0.0 or b * sign < 0.0 or c * sign < 0.0:
                    continue
                w = np.float32((a + b + c) * scale)
                if not w > inverse_depth[y, x]:
                    continue
                if peel:
                    if not (w < ceiling[y, x] and w > floor[y, x]):
                        continue
                elif not w < limit:
                    continue
                inverse_depth[y, x] = w
                face[y, x] = f
