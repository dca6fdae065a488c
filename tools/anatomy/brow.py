"""The eyebrow: a strip of quads whose outline the free part of the skin respects."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .fields import smooth_curve
from .projecting import lift

__all__ = ["Brow", "brow"]

_COLUMNS = 15
# inner to outer end in the front view: x, y of the middle line, half height [mm]
_LINE = np.array(
    [(11, 17.2, 1.9), (19, 19.0, 2.7), (29, 21.2, 2.7), (38.5, 22.2, 2.2), (48, 19.8, 1.6),
     (56, 15, 1.1)],
    float,
)  # fmt: skip


@dataclass(frozen=True)
class Brow:
    """Left eyebrow.

    Parameters
    ----------
    ring : (r, 3) ndarray
        Outline: lower edge to the outer end, upper edge back to the inner end [mm].
    inner : (k, 3) ndarray
        Vertices of the middle line that are not in the outline [mm].
    quads : list of tuple of int
        Counter-clockwise from the front; vertices of `ring`, then those of `inner`.
    inner_end, outer_end, top : int
        Vertices of `ring` at the ends and at the highest point.
    """

    ring: np.ndarray
    inner: np.ndarray
    quads: list
    inner_end: int
    outer_end: int
    top: int


def brow():
    """Return the left eyebrow."""
    line = smooth_curve(_LINE, _COLUMNS)
    along = np.gradient(line[:, :2], axis=0)
    across = np.column_stack([-along[:, 1], along[:, 0]])
    across /= np.linalg.norm(across, axis=1)[:, None]
    half = line[:, 2:]
    lower, middle, upper = (lift(line[:, :2] + s * half * across) for s in (-1.0, 0.0, 1.0))
    n = _COLUMNS
    # the ends stick out a little, so that the outline has no corner of 180 degrees
    ends = lift(line[[0, -1], :2] + np.array([[-1.0], [1.4]]) * along[[0, -1]] * 0.35)
    ring = np.vstack([lower, ends[1:], upper[::-1], ends[:1]])
    low = list(range(n))
    high = [2 * n - k for k in range(n)]
    mid = [2 * n + 1, *(2 * n + 2 + np.arange(n - 2)).tolist(), n]
    quads = [
        (int(a[k]), int(a[k + 1]), int(b[k + 1]), int(b[k]))
        for a, b in ((low, mid), (mid, high))
        for k in range(n - 1)
    ]
    top = high[int(upper[:, 1].argmax())]
    return Brow(ring, middle[1:-1], quads, mid[0], mid[-1], top)
