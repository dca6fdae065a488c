"""Sheet muscles: contour and internal lines, and where they want the vertices of the muscle."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from risorius._check import FloatArray, IntArray
from risorius.anatomy.outwards import unit
from risorius.layered.faithful.action_line import ActionLine, Ground, sample_line
from risorius.layered.faithful.contour import (
    Contour,
    contour_vertices,
    fill_grid,
    harmonic_fill,
    require_apart,
)
from risorius.layered.faithful.parameters import FaithfulParameters
from risorius.layered.muscle import Sheet

__all__ = ["SheetLines", "guarded", "lay_sheet"]


@dataclass(frozen=True, eq=False)
class SheetLines:
    """The lines that a sheet muscle hangs on.

    Parameters
    ----------
    contour : Contour
    inner : mapping of int to ActionLine
        Internal lines by column, from origin to insertion.
    rows, columns : int
        h samples along, w across.
    outward : (h*w, 3) float64
        Directions out of the head at the bottom vertices when it was drawn.
    limit : float
        Largest contraction.
    """

    contour: Contour
    inner: dict[int, ActionLine]
    rows: int
    columns: int
    outward: FloatArray
    limit: float

    @property
    def drawn(self) -> tuple[ActionLine, ...]:
        """All lines: the contour's, then internal ones."""
        return (*self.contour.lines, *self.inner.values())

    @property
    def held(self) -> tuple[IntArray, IntArray]:
        """Bottom vertices (k,) with targets on the origin row, and (l,) along the fibre lines."""
        h, w = self.rows, self.columns
        columns = [0, w - 1, *self.inner]
        fibres = [c + w * np.arange(1, h) for c in columns]
        return np.arange(w, dtype=np.int32), np.concatenate(fibres).astype(np.int32)

    def targets(self, positions: FloatArray, faces: IntArray, contraction: float) -> FloatArray:
        """Return targets (k + l, 3) of the vertices of `held` [mm].

        Fibres shorten towards the origin; the second side of the contour is stored backwards and
        sampled the other way round (errata E12, E13).
        """
        h, w = self.rows, self.columns
        a0, _, a2, a3 = self.contour.lines
        c = min(contraction, self.limit)
        origin = sample_line(a3.places(positions, faces), w)[::-1].copy()
        rows = [origin]
        for column, line in ((0, a0), (w - 1, a2.reversed), *self.inner.items()):
            samples = sample_line(line.places(positions, faces), h, contraction=c)
            origin[column] = samples[0]
            rows.append(samples[1:])
        return np.concatenate(rows)

    def bottom(self, positions: FloatArray, faces: IntArray) -> FloatArray:
        """Return the bottom vertices (h*w, 3) at rest [mm]."""
        known, places = self._samples(positions, positions, faces)
        return fill_grid(known, places, rows=self.rows, columns=self.columns)

    def upwards(self, positions: FloatArray, normals: FloatArray, faces: IntArray) -> FloatArray:
        """Return the directions (h*w, 3) from bottom to top: the surface's, filled in between.

        Parameters
        ----------
        positions, normals : (n, 3) float64
            Of all surfaces, with unit vertex normals.
        faces : (m, 3) int32
        """
        known, found = self._samples(positions, normals, faces)
        found = guarded(unit(found), self.outward[known])
        filled = harmonic_fill(known, found, rows=self.rows, columns=self.columns)
        return unit(filled)

    def _samples(
        self, positions: FloatArray, values: FloatArray, faces: IntArray
    ) -> tuple[IntArray, FloatArray]:
        """Return vertices (k,) with samples and `values` there; fibre lines before cross lines."""
        h, w = self.rows, self.columns
        a0, a1, a2, a3 = contour_vertices(h, w)
        down, insertion, up, origin = self.contour.lines
        lines = [(a1, insertion), (a3, origin), (a0, down), (a2, up)]
        lines += [(c + w * np.arange(h, dtype=np.int32), line) for c, line in self.inner.items()]
        found, is_known = np.zeros((h * w, 3)), np.zeros(h * w, bool)
        for vertices, line in lines:
            places = line.places(positions, faces)
            along = None if values is positions else places
            found[vertices] = sample_line(line.places(values, faces), len(vertices), along=along)
            is_known[vertices] = True
        known = np.flatnonzero(is_known).astype(np.int32)
        return known, found[known]


def guarded(normals: FloatArray, outward: FloatArray) -> FloatArray:
    """Return unit `normals` (n, 3), those that do not point `outward` (n, 3) replaced by it."""
    aligned = np.einsum("nd,nd->n", normals, outward) > 0.5
    return np.where(aligned[:, None], normals, outward)


def lay_sheet(
    sheet: Sheet, line: FloatArray, ground: Ground, *, sections: tuple[int, int]
) -> SheetLines:
    """Lay contour and internal lines of a sheet on the `ground`.

    Parameters
    ----------
    sheet : Sheet
    line : (k, 3) float64
        Its centre line in the ground's frame [mm].
    ground : Ground
    sections : (int, int)
        w and h.

    Raises
    ------
    ShapeError
        If a line has less than two distinct points, the four sides do not meet, or two cross.
    """
    columns, rows = sections
    p: FaithfulParameters = ground.parameters
    across = unit(np.cross(unit(np.gradient(line, axis=0)), ground.out(line)))
    offsets = np.linspace(-1.0, 1.0, columns)
    drawn = line + offsets[:, None, None] * sheet.half_width[:, None] * across
    require_apart((drawn[0], drawn[:, -1], drawn[-1, ::-1], drawn[::-1, 0]))
    sides = (
        ground.lay(drawn[0], name="first side"),
        ground.lay(drawn[-1], name="second side").reversed,
    )
    insertion = ground.lay(drawn[:, -1], name="insertion")
    origin = ground.lay(drawn[::-1, 0], name="origin")
    inner: dict[int, ActionLine] = {}
    if 2.0 * sheet.half_width.mean() > p.wide:
        starts, ends = (
            sample_line(row.places(ground.positions, ground.faces), columns)
            for row in (origin, insertion)
        )
        for c in range(1, columns - 1):
            points = np.concatenate([starts[[columns - 1 - c]], drawn[c, 1:-1], ends[[c]]])
            inner[c] = ground.lay(points, name=f"internal line {c}")
    places = np.linspace(0.0, len(line) - 1.0, rows)
    low = np.minimum(places.astype(int), len(line) - 2)
    share = (places - low)[:, None]
    grid = np.stack([(1.0 - share) * side[low] + share * side[low + 1] for side in drawn], axis=1)
    contour = Contour((sides[0], insertion, sides[1], origin))
    contour.require_closed(ground.positions, ground.faces)
    return SheetLines(
        contour, inner, rows, columns, ground.out(grid.reshape(-1, 3)), p.largest_contraction
    )
