# pyright: basic
# ruff: noqa: PLR0913, PLR0917
"""The displacement of a linear muscle's zone."""

import math

from numba import njit

__all__ = ["pull_towards"]


@njit(cache=True, nogil=True, error_model="numpy")
def pull_towards(points, origin, pull, contraction, outward, support, most_stretch, field, out):
    """Write ``-c k d/|d|`` of `points` (k, 3), turned along what supports the skin, to `out`.

    `support` of the motion against `outward` (k, 3) is taken away and the rest stretched up to
    `most_stretch` to keep its length; ``c field`` (k, 3) is added, unless it has no rows.
    """
    for v in range(points.shape[0]):
        x, y, z = points[v, 0] - origin[0], points[v, 1] - origin[1], points[v, 2] - origin[2]
        distance = math.sqrt(x * x + y * y + z * z)
        scale = -contraction * pull[v] / distance if distance > 0.0 else 0.0
        x, y, z = scale * x, scale * y, scale * z
        if support != 0.0:
            ox, oy, oz = outward[v, 0], outward[v, 1], outward[v, 2]
            inward = support * min(x * ox + y * oy + z * oz, 0.0)
            ax, ay, az = x - inward * ox, y - inward * oy, z - inward * oz
            before = math.sqrt(x * x + y * y + z * z)
            after = math.sqrt(ax * ax + ay * ay + az * az)
            stretch = min(before / max(after, 1e-300), most_stretch) if after > 0.0 else 1.0
            x, y, z = stretch * ax, stretch * ay, stretch * az
        if field.shape[0]:
            x += contraction * field[v, 0]
            y += contraction * field[v, 1]
            z += contraction * field[v, 2]
        out[v, 0], out[v, 1], out[v, 2] = x, y, z
