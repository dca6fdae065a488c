# pyright: basic
# ruff: noqa: PLR0913, PLR0917
"""Lines and dots over a finished picture, hidden behind what is nearer."""

import math

from numba import njit

__all__ = ["stamp"]


@njit(cache=True, nogil=True, error_model="numpy")
def stamp(ends, half_width, lift, inverse_depth, step, colour, opacity, hidden, cover, picture):
    """Draw capsules as one stroke: where several of them overlap the densest counts.

    Parameters
    ----------
    ends : (k, 2, 3)
        Column, row [pixels] and depth [mm] of both ends of each capsule; all depths > 0.
    half_width : float
        Half the thickness [pixels].
    lift : float
        Depth by which the stroke is pulled to the front before it is compared [mm].
    inverse_depth : (h step, w step)
        Of the opaque surfaces, for each sample.
    colour : (3,)
        On the scale of `picture`.
    opacity, hidden : float
        Opacity of the parts in view and of the parts behind something.
    cover : (h, w)
        Zeros; scratch, zero again at the end.
    picture : (h, w, 3)
        Drawn upon.
    """
    height, width = cover.shape
    x_low, x_high, y_low, y_high = width, -1, height, -1
    for k in range(ends.shape[0]):
        ax, ay, az = ends[k, 0, 0], ends[k, 0, 1], 1.0 / ends[k, 0, 2]
        bx, by, bz = ends[k, 1, 0], ends[k, 1, 1], 1.0 / ends[k, 1, 2]
        dx, dy = bx - ax, by - ay
        length2 = dx * dx + dy * dy
        reach = half_width + 1.0
        x_from = int(max(min(min(ax, bx) - reach, width), 0.0))
        x_to = int(min(max(max(ax, bx) + reach, -1.0), width - 1.0))
        y_from = int(max(min(min(ay, by) - reach, height), 0.0))
        y_to = int(min(max(max(ay, by) + reach, -1.0), height - 1.0))
        x_low, x_high = min(x_low, x_from), max(x_high, x_to)
        y_low, y_high = min(y_low, y_from), max(y_high, y_to)
        for y in range(y_from, y_to + 1):
            for x in range(x_from, x_to + 1):
                px, py = x + 0.5 - ax, y + 0.5 - ay
                along = 0.0
                if length2 > 0.0:
                    along = min(max((px * dx + py * dy) / length2, 0.0), 1.0)
                gap = math.sqrt((px - along * dx) ** 2 + (py - along * dy) ** 2)
                share = min(max(half_width + 0.5 - gap, 0.0), 1.0, 2.0 * half_width)
                if share <= cover[y, x]:
                    continue
                z = 1.0 / (az + along * (bz - az)) - lift
                open_samples = 0
                for sy in range(y * step, y * step + step):
                    for sx in range(x * step, x * step + step):
                        if z <= 0.0 or inverse_depth[sy, sx] * z <= 1.0:
                            open_samples += 1
                free = open_samples / (step * step)
                share *= opacity * free + hidden * (1.0 - free)
                cover[y, x] = max(cover[y, x], share)
    for y in range(y_low, y_high + 1):
        for x in range(x_low, x_high + 1):
            share = cover[y, x]
            if share > 0.0:
                cover[y, x] = 0.0
                for channel in range(3):
                    value = picture[y, x, channel]
                    picture[y, x, channel] = value + share * (colour[channel] - value)
