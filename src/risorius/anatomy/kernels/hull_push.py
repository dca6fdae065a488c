# pyright: basic
# ruff: noqa: PLR0913, PLR0917
"""How far points must move to keep their distance from a convex solid."""

import math

from numba import njit

__all__ = ["hull_shortfall"]

# Planes whose height is this near to the largest share in the direction, so that it turns
# smoothly from plane to plane and points on the midline go straight forward [mm].
_BLEND = 0.3


@njit(cache=True, nogil=True, error_model="numpy")
def hull_shortfall(points, planes, offsets, push, least, box, deepest, result):
    """Write into `result` (n, 3) how each of `points` (n, 3) must move.

    A point is above the solid by its largest height over any of the `planes` (f, 3), `offsets`
    (f,); if that is below `least` (n,), the point moves by what is missing, at most `deepest`,
    along `push` (f, 3) of the planes. Points outside the `box` (2, 3) stay.
    """
    for i in range(len(points)):
        result[i] = 0.0
        x, y, z = points[i, 0], points[i, 1], points[i, 2]
        if x < box[0, 0] or x > box[1, 0] or y < box[0, 1] or y > box[1, 1]:
            continue
        if z < box[0, 2] or z > box[1, 2]:
            continue
        wanted, best = least[i], -1e300
        for k in range(len(offsets)):
            height = planes[k, 0] * x + planes[k, 1] * y + planes[k, 2] * z - offsets[k]
            if height > best:
                best = height
                if best >= wanted:
                    break
        if best >= wanted:
            continue
        dx = dy = dz = 0.0
        for k in range(len(offsets)):
            height = planes[k, 0] * x + planes[k, 1] * y + planes[k, 2] * z - offsets[k]
            share = 1.0 - (best - height) / _BLEND
            if share > 0.0:
                dx += share * push[k, 0]
                dy += share * push[k, 1]
                dz += share * push[k, 2]
        length = math.sqrt(dx * dx + dy * dy + dz * dz)
        if length > 1e-9:
            missing = min(wanted - best, deepest) / length
            result[i, 0], result[i, 1], result[i, 2] = dx * missing, dy * missing, dz * missing
