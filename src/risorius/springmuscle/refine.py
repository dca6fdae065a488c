"""Divide a grid until its cells lie in the layer between skin and bone."""

from __future__ import annotations

from copy import deepcopy
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from risorius._check import BoolArray, FloatArray
from risorius.springmuscle.fit_parameters import FitParameters
from risorius.springmuscle.grid import Layer, Layout, Patch, grid_normals
from risorius.springmuscle.kernels.layer import measure_cells
from risorius.springmuscle.muscle import FitReport
from risorius.springmuscle.surface import SkinSurface

__all__ = ["Refined", "refine"]

# Refinement stops when this many passes have not brought the worst error below this share.
_PATIENCE, _GAIN = 4, 0.8
# Triangles whose extents say how small a cell may be.
_AROUND = 12
# How much of the way to the middle of their range points go per round, and how far at most.
_STEP, _FARTHEST = 0.5, 1.5
# Rounds in which points without skin go between their neighbours.
_ROUNDS = 12
# Rows of a cut closer to the middle of the face than this share of a cell are one cut.
_MIDDLE = 0.02


@dataclass(frozen=True, eq=False)
class Refined:
    """A grid in the layer.

    Parameters
    ----------
    points, normals : (r, c, 3) float64
        [mm], and unit vectors.
    rows : (r,) float64
        Row of the outline that each row stems from; inserted ones lie between two.
    report : FitReport
    """

    points: FloatArray
    normals: FloatArray
    rows: FloatArray
    report: FitReport


@dataclass
class _Cells:
    """What is known of the cells of a grid, (r - 1, c - 1) each."""

    near: FloatArray
    far: FloatArray
    near_place: FloatArray
    far_place: FloatArray
    counts: npt.NDArray[np.int64]
    final: BoolArray
    dirty: BoolArray

    @staticmethod
    def unknown(rows: int, columns: int) -> _Cells:
        shape = (rows - 1, columns - 1)
        return _Cells(
            np.zeros(shape), np.zeros(shape), np.zeros((*shape, 2)), np.zeros((*shape, 2)),
            np.zeros((*shape, 3), np.int64), np.zeros(shape, bool), np.ones(shape, bool),
        )  # fmt: skip

    def divided(self, at: int, axis: int) -> None:
        """Double row or column `at` of cells."""
        for name in ("near", "far", "near_place", "far_place", "counts", "final", "dirty"):
            values = getattr(self, name)
            doubled = np.insert(values, at, np.take(values, at, axis=axis), axis=axis)
            setattr(self, name, doubled)
        for row in (at, at + 1):
            where = (row, slice(None)) if axis == 0 else (slice(None), row)
            self.final[where] = False
            self.dirty[where] = True


@dataclass
class _Work:
    """A grid on its way."""

    layer: Layer
    patch: Patch
    surface: SkinSurface
    parameters: FitParameters
    closed: bool
    mirror: bool
    points: FloatArray
    normals: FloatArray
    rows: FloatArray
    cells: _Cells
    afloat: BoolArray
    missed: int = 0
    passes: int = 0
    stopped: Literal["fits", "small", "stagnation", "limit"] = "limit"
    worst: list[float] = field(default_factory=list[float])
    best: tuple[float, Any] = (-1.0, None)

    def remember(self) -> None:
        """Keep the grid if more of its samples lie inside than ever before."""
        counts = self.cells.counts
        inside = float(counts[..., 2].sum()) / max(float(counts[..., 1].sum()), 1.0)
        if inside > self.best[0]:
            state = (self.points, self.normals, self.rows, self.afloat, self.cells)
            self.best = inside, deepcopy(state)

    def recall(self) -> None:
        """Go back to the best grid."""
        if self.best[1] is not None:
            self.points, self.normals, self.rows, self.afloat, self.cells = self.best[1]

    def renew_normals(self) -> None:
        before = self.normals
        self.normals = grid_normals(self.points, self.surface, self.closed)
        if before.shape == self.normals.shape:
            moved = (before != self.normals).any(axis=2)
            corners = moved[1:, 1:] | moved[:-1, 1:] | moved[1:, :-1] | moved[:-1, :-1]
            self.cells.dirty |= corners

    def measure(self) -> tuple[FloatArray, FloatArray]:
        """Measure the dirty cells; return the allowed range (r - 1, c - 1) each."""
        middle = 0.25 * (
            self.points[1:, 1:]
            + self.points[:-1, 1:]
            + self.points[1:, :-1]
            + self.points[:-1, :-1]
        )
        low, high = self.layer.range(middle)
        cells, patch = self.cells, self.patch
        measure_cells(
            np.ascontiguousarray(self.points), np.ascontiguousarray(self.normals), cells.dirty,
            patch.corners, patch.normals, patch.middles, patch.radii, patch.taken, patch.edge,
            patch.reach, low, high, cells.near, cells.far, cells.near_place, cells.far_place,
            cells.counts,
        )  # fmt: skip
        cells.dirty[:] = False
        return low, high

    def put(self, rows: BoolArray, normals: FloatArray) -> None:
        """Place the points of the mask `rows` (r, c) below the skin."""
        depth = self.layer.start(self.points[rows])
        jump = self.parameters.jump * self.surface.scale
        placed, kept = self.patch.place(self.points[rows], normals[rows], depth, jump)
        self.points[rows] = placed
        self.afloat[rows] = kept
        self.missed += int(kept.sum())
        if self.closed:
            self.points[-1] = self.points[0]


def refine(layout: Layout, layer: Layer, patch: Patch, *, mirror: bool) -> Refined:
    """Place a grid below the skin and divide it where it leaves its layer.

    Parameters
    ----------
    layout : Layout
    layer : Layer
    patch : Patch
    mirror : bool
        Whether the muscle crosses the middle of a symmetric face: every cut gets its mirror image.

    Notes
    -----
    Kaehler et al. 2001, section 5: the cell with the worst error is divided at its worst sample,
    with the whole row or column, so that the grid stays regular. The depth range is the corrected
    one (erratum E4). Only one cut is made per pass, cells smaller than two triangles stay whole,
    and refinement ends when it gains nothing (finding S5).
    """
    surface, parameters = layer.surface, layer.parameters
    rows, columns = layout.points.shape[:2]
    work = _Work(
        layer, patch, surface, parameters, layout.closed, mirror, layout.points.copy(),
        grid_normals(layout.points, surface, layout.closed), np.arange(rows, dtype=np.float64),
        _Cells.unknown(rows, columns), np.zeros((rows, columns), bool),
    )  # fmt: skip
    work.put(np.ones((rows, columns), bool), work.normals)
    _divide_long(work)
    while work.passes < parameters.passes and _divide_worst(work):
        pass
    if parameters.settle and work.afloat.any():
        _lay_between(work)
    for _ in range(parameters.settle):
        _settle(work)
    if parameters.settle:
        work.renew_normals()
        work.measure()
        work.remember()
        work.recall()
    return _finished(work)


def _divide_long(work: _Work) -> None:
    """Divide rows and columns whose cells are longer or wider than the parameters allow."""
    scale = work.surface.scale
    for axis, longest, most in (
        (0, work.parameters.segment * scale, work.parameters.rows),
        (1, work.parameters.breadth * scale, work.parameters.columns),
    ):
        number = 0
        while number < work.points.shape[axis] - 1:
            steps = np.linalg.norm(np.diff(work.points, axis=axis), axis=2)
            length = float(np.take(steps, number, axis=axis).mean())
            parts = int(np.ceil(length / longest)) if longest > 0.0 else 1
            parts = min(parts, most - work.points.shape[axis] + 1)
            for part in range(parts, 1, -1):
                _cut(work, axis, number, 1.0 / part)
                number += 1
            number += 1
    work.renew_normals()


def _divide_worst(work: _Work) -> bool:
    """Make the pass's one cut; return whether there was something to divide."""
    work.passes += 1
    work.renew_normals()
    low, high = work.measure()
    work.remember()
    near, far = _errors(work, low, high)
    worst = np.maximum(near, far)
    worst[work.cells.final | (work.cells.counts[..., 1] == 0)] = 0.0
    while True:
        r, c = np.unravel_index(int(np.argmax(worst)), worst.shape)
        value = float(worst[r, c])
        if value <= 0.0:
            work.stopped = "small" if work.cells.final.any() else "fits"
            return False
        cut = _cut_of(work, int(r), int(c), bool(far[r, c] >= near[r, c]))
        if cut != (None, None):
            break
        work.cells.final[r, c] = True
        worst[r, c] = 0.0
    work.worst.append(value)
    history = work.worst
    if len(history) > _PATIENCE + 1 and min(history[-_PATIENCE:]) >= _GAIN * min(
        history[:-_PATIENCE]
    ):
        work.stopped = "stagnation"
        work.recall()
        return False
    u, v = cut
    if u is not None:
        _cut_mirrored(work, int(r), u)
    if v is not None:
        _cut(work, 1, int(c), v)
    return True


def _errors(work: _Work, low: FloatArray, high: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return e_near and e_far; too great a spread counts in full, which forces a division."""
    cells = work.cells
    near = np.maximum(0.0, np.maximum(low - cells.near, cells.near - high))
    far = np.maximum(0.0, np.maximum(low - cells.far, cells.far - high))
    forced = np.abs(cells.far - cells.near) > work.layer.least
    near = np.where(forced, np.abs(cells.near), near)
    far = np.where(forced, np.abs(cells.far), far)
    return near, far


def _cut_of(work: _Work, r: int, c: int, at_far: bool) -> tuple[float | None, float | None]:
    """Return where to cut the row and the column of a cell, None where it is too small."""
    place = (work.cells.far_place if at_far else work.cells.near_place)[r, c]
    points, patch = work.points, work.patch
    corner = points[r : r + 2, c : c + 2]
    nearest = np.argsort(np.linalg.norm(patch.middles - corner.mean(axis=(0, 1)), axis=1))
    triangles = patch.corners[nearest[:_AROUND]]
    result: list[float | None] = []
    for axis, most in ((0, work.parameters.rows), (1, work.parameters.columns)):
        way = np.diff(corner, axis=axis).reshape(2, 3).mean(axis=0)
        length = float(np.linalg.norm(way))
        extent = float(np.ptp(triangles @ (way / max(length, 1e-12)), axis=1).mean())
        extent *= work.parameters.part
        if length < 2.0 * extent or points.shape[axis] >= most or length == 0.0:
            result.append(None)
        else:
            result.append(float(np.clip(place[axis], extent / length, 1.0 - extent / length)))
    return result[0], result[1]


def _cut_mirrored(work: _Work, r: int, u: float) -> None:
    """Cut a row of cells, and its mirror image on the other side of the face."""
    if not work.mirror:
        _cut(work, 0, r, u)
        return
    middle = 0.5 * (work.points[1:] + work.points[:-1]).mean(axis=1)
    other = int(np.argmin(np.linalg.norm(middle - middle[r] * [-1.0, 1.0, 1.0], axis=1)))
    if other == r:
        _cut(work, 0, r, 0.5)
        return
    first, second = sorted(((r, u), (other, 1.0 - u)), reverse=True)
    _cut(work, 0, first[0], first[1])
    _cut(work, 0, second[0], second[1])


def _cut(work: _Work, axis: int, at: int, share: float) -> None:
    """Insert a row (axis 0) or column of points into cells `at`, and place it below the skin."""
    before, after = np.take(work.points, [at, at + 1], axis=axis).swapaxes(0, axis)
    points = np.insert(work.points, at + 1, (1.0 - share) * before + share * after, axis=axis)
    first, second = np.take(work.normals, [at, at + 1], axis=axis).swapaxes(0, axis)
    between = (1.0 - share) * first + share * second
    length = np.linalg.norm(between, axis=-1, keepdims=True)
    between = between / np.where(length > 0.0, length, 1.0)
    work.normals = np.insert(work.normals, at + 1, between, axis=axis)
    work.points = points
    work.afloat = np.insert(work.afloat, at + 1, True, axis=axis)
    fresh = np.zeros(points.shape[:2], bool)
    fresh[(at + 1, slice(None)) if axis == 0 else (slice(None), at + 1)] = True
    if axis == 0:
        place = (1.0 - share) * work.rows[at] + share * work.rows[at + 1]
        work.rows = np.insert(work.rows, at + 1, place)
    work.cells.divided(at, axis)
    work.put(fresh, work.normals)


def _lay_between(work: _Work) -> None:
    """Lay the points that found no skin between their neighbours: under a fold, across it."""
    for _ in range(_ROUNDS):
        total, count = np.zeros_like(work.points), np.zeros_like(work.points[..., :1])
        for to, of in ((np.s_[1:], np.s_[:-1]), (np.s_[:-1], np.s_[1:])):
            total[to] += work.points[of]
            count[to] += 1.0
            total[:, to] += work.points[:, of]
            count[:, to] += 1.0
        work.points[work.afloat] = (total / count)[work.afloat]
    if work.closed:
        work.points[-1] = work.points[0]
    work.cells.dirty[:] = True


def _settle(work: _Work) -> None:
    """Move every point along its normal to the middle of what its cells leave it."""
    work.renew_normals()
    low, high = work.measure()
    work.remember()
    known = work.cells.counts[..., 1] > 0
    excess = 0.5 * (work.cells.near + work.cells.far - low - high)
    out = np.maximum(low - work.cells.near, work.cells.far - high)
    excess = np.where(known & (out > -0.1 * (high - low)), excess, 0.0)
    total, count = np.zeros_like(work.points[..., 0]), np.zeros_like(work.points[..., 0])
    for a, b in ((0, 0), (0, 1), (1, 0), (1, 1)):
        rows = slice(a, a + excess.shape[0]), slice(b, b + excess.shape[1])
        total[rows] += excess
        count[rows] += 1.0
    if work.closed:
        total[0] = total[-1] = total[0] + total[-1]
        count[0] = count[-1] = count[0] + count[-1]
    most = _FARTHEST * work.surface.scale
    way = np.clip(_STEP * total / count, -most, most)
    work.points = work.points + way[..., None] * work.normals
    work.cells.dirty[:] = True


def _finished(work: _Work) -> Refined:
    work.renew_normals()
    low, high = work.measure()
    cells, layer = work.cells, work.layer
    hit = cells.counts[..., 1] > 0
    near = np.maximum(0.0, np.maximum(low - cells.near, cells.near - high))
    far = np.maximum(0.0, np.maximum(low - cells.far, cells.far - high))
    depth = np.where(hit, cells.near - (low - 0.5 * layer.least), 0.5 * layer.least)
    thickness = np.clip(2.0 * depth, layer.least, layer.most)
    asked, total, inside = (int(number) for number in cells.counts.sum(axis=(0, 1)))
    report = FitReport(
        np.where(hit, near, 0.0),
        np.where(hit, far, 0.0),
        thickness,
        cells.final,
        inside / total if total else 0.0,
        work.passes,
        work.missed,
        work.stopped,
        total / asked,
    )
    return Refined(work.points, work.normals, work.rows, report)
