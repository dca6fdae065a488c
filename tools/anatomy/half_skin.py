"""The left half of the skin and what is known of its build."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from .brow import Brow
from .loops import loop_polygons
from .topology import half_edges

__all__ = ["HalfSkin", "Labels", "SkinAssembly"]


@dataclass(frozen=True)
class Labels:
    """Where each polygon comes from.

    Parameters
    ----------
    kind : list of str
        "fill", "ear", "mouth", "eye" or "brow".
    band, column : list of int
        Row pair and column of the polygons of the loops, -1 elsewhere.
    """

    kind: list = field(default_factory=list)
    band: list = field(default_factory=list)
    column: list = field(default_factory=list)

    def add(self, kind, bands, columns):
        """Label further polygons, one per entry of `kind`."""
        self.kind.extend(kind)
        self.band.extend(int(b) for b in bands)
        self.column.extend(int(c) for c in columns)


@dataclass(frozen=True)
class HalfSkin:
    """Left half of the skin.

    Parameters
    ----------
    positions : (n, 3) ndarray
        Vertices [mm].
    polygons : list of tuple of int
    labels : Labels
    mouth_rows, eye_rows : list of (c,) int ndarray
        Vertex indices of the loops, outermost first.
    mouth_margin, eye_margin : int
        Position of the margin of the opening in the rows.
    brow : Brow
    brow_start : int
        Vertex of the first point of the eyebrow's outline.
    """

    positions: np.ndarray
    polygons: list
    labels: Labels
    mouth_rows: list
    eye_rows: list
    mouth_margin: int
    eye_margin: int
    brow: Brow
    brow_start: int


class SkinAssembly:
    """Collects vertices and polygons of the left half, the free part first.

    Parameters
    ----------
    fill : Fill
    """

    def __init__(self, fill):
        self.polygons = [tuple(face) for face in fill.faces.tolist()]
        self.labels = Labels()
        nowhere = np.full(len(self.polygons), -1)
        kind = ["ear" if ear else "fill" for ear in fill.in_ear]
        self.labels.add(kind, nowhere, nowhere)
        self._edges = set(map(tuple, half_edges(fill.faces).tolist()))
        self._stacks = [fill.positions]
        self._count = len(fill.positions)

    def positions(self):
        """Return all vertices (n, 3), those near the midline on it [mm]."""
        positions = np.vstack(self._stacks)
        positions[np.abs(positions[:, 0]) < 1e-4, 0] = 0.0
        return positions

    def _new(self, points):
        self._stacks.append(points)
        self._count += len(points)
        return np.arange(self._count - len(points), self._count)

    def add_loops(self, kind, loops, start):
        """Add the rows of `loops` whose outermost row begins at the vertex `start`.

        Returns
        -------
        rows : list of (c,) int ndarray
            Vertices, outermost row first.
        turned : bool
            Whether the polygons had to be turned to face outwards.
        """
        first = start + np.arange(loops.column_count)
        rows = [first, *(self._new(row) for row in loops.rows()[1:])]
        quads, bands = loop_polygons(rows, closed=loops.closed)
        # the row shared with the fill must run against its edges
        turned = (int(quads[0, 0]), int(quads[0, 3])) not in self._edges
        if turned:
            quads = quads[:, ::-1]
        self.polygons += map(tuple, _shorter_diagonal(quads, self.positions()).tolist())
        columns = np.tile(np.arange(len(quads) // (len(rows) - 1)), len(rows) - 1)
        self.labels.add([kind] * len(quads), bands, columns)
        return rows, turned

    def add_closing(self, row, *, turned, band):
        """Close the mouth bag between the columns of its last `row`."""
        closing = _closing(row, turned=turned)
        self.polygons += closing
        self.labels.add(["mouth"] * len(closing), [band] * len(closing), range(len(closing)))

    def add_brow(self, brow, start):
        """Add the inside of the eyebrow whose outline begins at the vertex `start`."""
        inner = self._new(brow.inner)
        vertices = np.concatenate([start + np.arange(len(brow.ring)), inner])
        self.polygons += [tuple(vertices[list(quad)].tolist()) for quad in brow.quads]
        nowhere = [-1] * len(brow.quads)
        self.labels.add(["brow"] * len(brow.quads), nowhere, nowhere)


def _shorter_diagonal(quads, positions):
    """Return `quads` started so that the fan diagonal is the shorter one."""
    first = np.linalg.norm(positions[quads[:, 0]] - positions[quads[:, 2]], axis=1)
    second = np.linalg.norm(positions[quads[:, 1]] - positions[quads[:, 3]], axis=1)
    return np.where((first <= second)[:, None], quads, np.roll(quads, -1, axis=1))


def _closing(row, *, turned):
    """Return the polygons between the upper and the lower columns of `row`."""
    count = len(row) // 2
    upper, lower, corner = row[:count].tolist(), row[:count:-1].tolist(), int(row[count])
    polygons = [(upper[k], lower[k], lower[k + 1], upper[k + 1]) for k in range(count - 1)]
    polygons.append((upper[-1], lower[-1], corner))
    return [polygon[::-1] for polygon in polygons] if turned else polygons
