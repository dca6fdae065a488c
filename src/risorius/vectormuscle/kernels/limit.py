# pyright: basic
"""The sum of several displacements, limited along each of them."""

import math

import numpy as np
from numba import njit

__all__ = ["limited_sum", "scatter"]


@njit(cache=True, nogil=True, error_model="numpy")
def limited_sum(fields, order, out):
    """Add the limited sums of displacements `fields` (m, k, 3), in `order` (m,), to `out` (k, 3).

    What is zero at a vertex neither adds nor limits there, so it is passed over.
    """
    some = np.empty((fields.shape[0], 3))
    for v in range(fields.shape[1]):
        tx = ty = tz = 0.0
        count = 0
        for i in order:
            x, y, z = fields[i, v, 0], fields[i, v, 1], fields[i, v, 2]
            if x != 0.0 or y != 0.0 or z != 0.0:
                some[count, 0], some[count, 1], some[count, 2] = x, y, z
                count += 1
                tx += x
                ty += y
                tz += z
        scale = 1.0
        for i in range(count if count > 1 else 0):
            ux, uy, uz = some[i, 0], some[i, 1], some[i, 2]
            length = math.sqrt(ux * ux + uy * uy + uz * uz)
            if length == 0.0:
                continue
            ux, uy, uz = ux / length, uy / length, uz / length
            wanted = tx * ux + ty * uy + tz * uz
            largest = 0.0
            for j in range(count):
                along = some[j, 0] * ux + some[j, 1] * uy + some[j, 2] * uz
                largest = max(largest, along)
            if wanted > largest:
                scale = min(scale, largest / wanted)
        out[v, 0] += scale * tx
        out[v, 1] += scale * ty
        out[v, 2] += scale * tz


@njit(cache=True, nogil=True, error_model="numpy")
def scatter(values, rows, out):
    """Write `values` (k, 3) to the `rows` (k,) of `out` (n, 3)."""
    for k in range(rows.shape[0]):
        row = rows[k]
        out[row, 0], out[row, 1], out[row, 2] = values[k, 0], values[k, 1], values[k, 2]
