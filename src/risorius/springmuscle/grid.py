"""From an outline to a first grid below the skin."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from risorius._check import BoolArray, FloatArray, IntArray
from risorius.anatomy.outwards import unit
from risorius.errors import LandmarkError, ParameterError
from risorius.springmuscle.fit_parameters import FitParameters
from risorius.springmuscle.kernels.layer import cast_lines
from risorius.springmuscle.recipe import MuscleOutline, thickness_at
from risorius.springmuscle.surface import SkinSurface

__all__ = ["Layer", "Layout", "Patch", "cell_normals", "find_patch", "grid_normals", "lay_out"]

# Samples of the outline by which skin under it is found, per side of a cell.
_SAMPLES = 8
# Skin within this distance of the outline may be fitted under; more where triangles are large
# [mm at the reference width; share of a triangle's size].
_NEAR, _OWN = 9.0, 1.2
# Only skin facing the outline counts.
_FACING = 0.15
# Skin farther from a point than this along its normal is not the skin above it [mm].
_REACH = 18.0
_EQUAL = 1e-6


@dataclass(frozen=True, eq=False)
class Layout:
    """An outline with all rows filled up and laid on the skin.

    Parameters
    ----------
    points : (r, c, 3) float64
        A ring's first row is repeated at the end [mm].
    closed : bool
    found : (r, c) bool
        Points whose projection met the skin.
    """

    points: FloatArray
    closed: bool
    found: BoolArray


@dataclass(frozen=True, eq=False)
class Layer:
    """The layer that a muscle lies in.

    Parameters
    ----------
    outline : MuscleOutline
        What it sets goes before the parameters.
    surface : SkinSurface
    parameters : FitParameters
    """

    outline: MuscleOutline
    surface: SkinSurface
    parameters: FitParameters

    @property
    def least(self) -> float:
        """Least thickness of the muscle [mm]."""
        return self._thickness[0] * self.surface.scale

    @property
    def most(self) -> float:
        """Greatest thickness of the muscle [mm]."""
        return self._thickness[1] * self.surface.scale

    @property
    def _thickness(self) -> tuple[float, float]:
        own = self.outline.settings.thickness
        return own or (self.parameters.least, self.parameters.most)

    def skin(self, points: FloatArray) -> FloatArray:
        """Return the thickness (...,) of the skin at `points` (..., 3) [mm]."""
        own = self.outline.settings.skin
        value = self.parameters.skin if own is None else own
        flat = thickness_at(value, points.reshape(-1, 3), self.surface.measure)
        return flat.reshape(points.shape[:-1])

    def start(self, points: FloatArray) -> FloatArray:
        """Return the depth (q,) for `points` (q, 3): tau_s + (tau_min + tau_max) / 4 [mm]."""
        return self.skin(points) + 0.25 * (self.least + self.most)

    def range(self, points: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return least and greatest depth (q,) of the middle of a muscle at `points` (q, 3) [mm].

        Halves, as its thickness reaches to both sides (erratum E4).
        """
        skin = self.skin(points)
        return skin + 0.5 * self.least, skin + 0.5 * self.most


@dataclass(frozen=True, eq=False)
class Patch:
    """The skin above one muscle: k triangles.

    Parameters
    ----------
    faces : (k,) int32
        Of the skin's mesh.
    corners : (k, 3, 3) float64
        [mm].
    normals : (k, 3) float64
    middles : (k, 3) float64
        [mm].
    radii : (k,) float64
        Of the triangles around their middles [mm].
    taken : (k,) bool
        Triangles that muscles are fitted under; the others, walls of folds, only hide what lies
        behind them.
    edge : float
        Mean length of an edge [mm].
    reach : float
        Farthest that skin is looked for along a normal [mm].
    """

    faces: IntArray
    corners: FloatArray
    normals: FloatArray
    middles: FloatArray
    radii: FloatArray
    taken: BoolArray
    edge: float
    reach: float

    def cast(self, points: FloatArray, directions: FloatArray) -> tuple[FloatArray, IntArray]:
        """Return signed distance (q,) to the skin along `directions`, and the triangle; nan, -1."""
        distances, hit = np.full(len(points), np.nan), np.full(len(points), -1, np.int32)
        cast_lines(
            np.ascontiguousarray(points), np.ascontiguousarray(directions), self.corners,
            self.normals, self.middles, self.radii, self.taken, self.reach, distances, hit,
        )  # fmt: skip
        return distances, hit

    def place(
        self, points: FloatArray, normals: FloatArray, depth: FloatArray, jump: float
    ) -> tuple[FloatArray, BoolArray]:
        """Move `points` (q, 3) along `normals` to `depth` (q,) below the skin.

        Points that would go farther than `jump`, or meet no skin, stay; the mask (q,) tells which.
        """
        distance, hit = self.cast(points, normals)
        way = np.where(hit >= 0, distance - depth, 0.0)
        kept = (hit < 0) | (np.abs(way) > jump)
        way = np.where(kept, 0.0, way)
        return points + normals * way[:, None], kept


def lay_out(outline: MuscleOutline, surface: SkinSurface) -> Layout:
    """Place the rows of an outline on a head, fill them up and lay them on the skin.

    Shorter rows get as many points as the longest one, evenly by arc length.

    Raises
    ------
    LandmarkError
        If the head lacks a landmark that the outline needs.
    ParameterError
        If a row's points coincide, or two rows cross.
    """
    try:
        rows = [np.array([p.place(surface.measure) for p in row]) for row in outline.rows]
    except LandmarkError as error:
        raise LandmarkError(f"outline {outline.name}: {error}") from None
    count = max(len(row) for row in rows)
    filled = [_filled(row, count, f"outline {outline.name}: row {n}") for n, row in enumerate(rows)]
    points = np.array(filled)
    _require_uncrossed(points, surface, outline.name)
    closed = outline.ring is not None and outline.ring.closed
    if closed:
        points = np.concatenate([points, points[:1]])
    flat, found = surface.project(points.reshape(-1, 3))
    return Layout(flat.reshape(points.shape), closed, found.reshape(points.shape[:2]))


def _filled(row: FloatArray, count: int, where: str) -> FloatArray:
    steps = np.linalg.norm(np.diff(row, axis=0), axis=1)
    if (steps <= _EQUAL).any():
        number = int(np.argmin(steps))
        raise ParameterError(f"{where}: points {number} and {number + 1} coincide; move one")
    place = np.concatenate([[0.0], np.cumsum(steps)])
    wanted = np.linspace(0.0, place[-1], count)
    return np.stack([np.interp(wanted, place, row[:, axis]) for axis in range(3)], axis=1)


def _require_uncrossed(points: FloatArray, surface: SkinSurface, name: str) -> None:
    """Raise if two rows cross, or the first and the last column between them."""
    first, last = points[:, 0], points[:, -1]
    out = surface.outwards(points.mean(axis=1))
    for row in range(len(points) - 1):
        a, b, c, d = first[row], last[row], first[row + 1], last[row + 1]
        if _cross(a, b, c, d, out[row]) or _cross(a, c, b, d, out[row]):
            raise ParameterError(
                f"outline {name}: rows {row} and {row + 1} cross; list the points of every row "
                "from the same side"
            )


def _cross(a: FloatArray, b: FloatArray, c: FloatArray, d: FloatArray, out: FloatArray) -> bool:
    """Return whether the segments a-b and c-d cross, seen along `out`."""

    def turn(p: FloatArray, q: FloatArray, r: FloatArray) -> float:
        return float(np.cross(q - p, r - p) @ out)

    return turn(a, b, c) * turn(a, b, d) < 0.0 and turn(c, d, a) * turn(c, d, b) < 0.0


def find_patch(layout: Layout, surface: SkinSurface, parameters: FitParameters) -> Patch:
    """Collect the visible triangles under an outline that face it, and tell walls of folds."""
    samples = _outline_samples(layout.points)
    scale, middles = surface.scale, surface.face_tree.data
    reach = _NEAR * scale
    box = samples.min(axis=0) - 2.0 * reach, samples.max(axis=0) + 2.0 * reach
    radii = surface.face_radii
    rows = np.flatnonzero(
        ((middles > box[0] - radii[:, None]) & (middles < box[1] + radii[:, None])).all(axis=1)
    )
    distance, nearest = cKDTree(samples).query(middles[rows])
    out = surface.outwards(samples[nearest])
    normals = surface.face_normals[rows]
    kept = distance < np.maximum(reach, _OWN * 2.0 * radii[rows])
    kept &= np.einsum("kd,kd->k", normals, out) > _FACING
    rows = rows[kept].astype(np.int32)
    taken = surface.face_turns[rows] > np.cos(np.radians(parameters.turn))
    corners = np.ascontiguousarray(surface.corners[rows])
    sides = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2)[taken]
    edge = float(sides.mean()) if len(sides) else reach
    return Patch(
        surface.visible[rows], corners, np.ascontiguousarray(surface.face_normals[rows]),
        np.ascontiguousarray(middles[rows]), np.ascontiguousarray(radii[rows]), taken, edge,
        _REACH * scale,
    )  # fmt: skip


def _outline_samples(points: FloatArray) -> FloatArray:
    share = np.linspace(0.0, 1.0, _SAMPLES)
    u, v = (axis.ravel()[:, None] for axis in np.meshgrid(share, share, indexing="ij"))
    cells = [points[:-1, :-1], points[:-1, 1:], points[1:, :-1], points[1:, 1:]]
    a, b, c, d = (cell.reshape(-1, 1, 3) for cell in cells)
    blend = (1 - u) * ((1 - v) * a + v * b) + u * ((1 - v) * c + v * d)
    return blend.reshape(-1, 3)


def cell_normals(points: FloatArray, out: FloatArray) -> FloatArray:
    """Return the unit normals (r - 1, c - 1, 3) of the cells of a grid (r, c, 3).

    Those of the plane that balances the four corners, ``(P11 - P00) x (P01 - P10)``, on the side
    of `out` (r, c, 3); 0 for cells without area.
    """
    normals = unit(np.cross(points[1:, 1:] - points[:-1, :-1], points[:-1, 1:] - points[1:, :-1]))
    towards = out[1:, 1:] + out[:-1, 1:] + out[1:, :-1] + out[:-1, :-1]
    side = np.einsum("rcd,rcd->rc", normals, towards)
    return np.where(side < 0.0, -1.0, 1.0)[..., None] * normals


def grid_normals(points: FloatArray, surface: SkinSurface, closed: bool) -> FloatArray:
    """Return the unit normals (r, c, 3) of a grid: the mean of the cells at each point.

    Cells without area take no part; where none has any, `SkinSurface.outwards` stands in.
    """
    out = surface.outwards(points.reshape(-1, 3)).reshape(points.shape)
    cells = cell_normals(points, out)
    total = np.zeros_like(points)
    total[:-1, :-1] += cells
    total[1:, :-1] += cells
    total[:-1, 1:] += cells
    total[1:, 1:] += cells
    if closed:
        total[0] = total[-1] = total[0] + total[-1]
    empty = np.linalg.norm(total, axis=2, keepdims=True) < 1e-6
    return unit(np.where(empty, out, total))
