# pyright: basic
"""The sum of several displacements, limited along each of them."""

import math

from numba import njit

__all__ = ["limited_sum"]


@njit(cache=True, nogil=True, error_model="numpy")
def limited_sum(fields, out):
    """Add the limited sums of displacements `fields` (m, k, 3) to `out` (k, 3)."""
    for v in range(fields.shape[1]):
        tx = ty = tz = 0.0
        for i in range(fields.shape[0]):
            tx += fields[i, v, 0]
            ty += fields[i, v, 1]
            tz += fields[i, v, 2]
        scale = 1.0
        for i in range(fields.shape[0]):
            ux, uy, uz = fields[i, v, 0], fields[i, v, 1], fields[i, v, 2]
            length = math.sqrt(ux * ux + uy * uy + uz * uz)
            if length == 0.0:
                continue
            ux, uy, uz = ux / length, uy / length, uz / length
            wanted = tx * ux + ty * uy + tz * uz
            largest = 0.0
            for j in range(fields.shape[0]):
                along = fields[j, v, 0] * ux + fields[j, v, 1] * uy + fields[j, v, 2] * uz
                largest = max(largest, along)
            if wanted > largest:
                scale = min(scale, largest / wanted)
        out[v, 0] += scale * tx
        out[v, 1] += scale * ty
        out[v, 2] += scale * tz
