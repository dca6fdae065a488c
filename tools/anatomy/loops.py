"""Rows of vertices laid by hand around an opening, outermost row last."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

__all__ = ["Loops", "loop_polygons"]


@dataclass(frozen=True)
class Loops:
    """Structured rows around one opening of the left half.

    Parameters
    ----------
    outer : list of (c, 3) ndarray
        Rows on the skin from the margin of the opening outwards; the last one is where the
        free fill begins [mm].
    inner : list of (c, 3) ndarray
        Rows inside the opening, from the margin inwards [mm].
    closed : bool
        Whether the columns run round (eye) or from midline to midline (mouth).
    """

    outer: list
    inner: list
    closed: bool

    @property
    def column_count(self):
        """Number of columns."""
        return len(self.outer[0])

    def rows(self):
        """Return all rows from the outermost to the innermost."""
        return self.outer[::-1] + self.inner


def loop_polygons(rows, *, closed):
    """Return quads (q, 4) between consecutive index rows, and the row pair of each.

    Parameters
    ----------
    rows : list of (c,) int ndarray
        Vertex indices of the rows, outermost first.
    closed : bool
        Whether the last column is joined to the first.
    """
    quads, bands = [], []
    for band, (a, b) in enumerate(pairwise(rows)):
        count = len(a) if closed else len(a) - 1
        k = np.arange(count)
        following = (k + 1) % len(a)
        quads.append(np.column_stack([a[k], b[k], b[following], a[following]]))
        bands.append(np.full(count, band))
    return np.vstack(quads), np.concatenate(bands)
