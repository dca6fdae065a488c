# pyright: basic
"""Fill the texels that triangles cover."""

import math

from numba import njit

__all__ = ["paint"]


@njit(cache=True, nogil=True, error_model="numpy")
def paint(places, values, image, painted):
    """Write the values of triangles into a texture, interpolated at the middles of texels.

    Parameters
    ----------
    places : (m, 3, 2) float64
        Corners as (column, row); texel (0, 0) reaches from 0 to 1.
    values : (m, 3, c) float64
    image : (h, w, c) float64
        Where several triangles cover a texel the last one stays.
    painted : (h, w) int32
        Counts how often each texel was written.
    """
    height, width, channels = image.shape
    for f in range(places.shape[0]):
        ax, ay = places[f, 0, 0], places[f, 0, 1]
        bx, by = places[f, 1, 0], places[f, 1, 1]
        cx, cy = places[f, 2, 0], places[f, 2, 1]
        area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
        if area == 0.0:
            continue
        left = max(math.floor(min(ax, bx, cx) - 0.5), 0)
        right = min(math.ceil(max(ax, bx, cx) - 0.5), width - 1)
        top = max(math.floor(min(ay, by, cy) - 0.5), 0)
        bottom = min(math.ceil(max(ay, by, cy) - 0.5), height - 1)
        for row in range(top, bottom + 1):
            y = row + 0.5
            for column in range(left, right + 1):
                x = column + 0.5
                u = ((bx - x) * (cy - y) - (by - y) * (cx - x)) / area
                v = ((cx - x) * (ay - y) - (cy - y) * (ax - x)) / area
                w = 1.0 - u - v
                if u < 0.0 or v < 0.0 or w < 0.0:
                    continue
                for k in range(channels):
                    image[row, column, k] = (
                        u * values[f, 0, k] + v * values[f, 1, k] + w * values[f, 2, k]
                    )
                painted[row, column] += 1
