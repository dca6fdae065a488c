"""Make fibres and ellipsoids from a fitted grid."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from scipy.spatial import cKDTree

from risorius._check import FloatArray
from risorius.anatomy.outwards import unit
from risorius.springmuscle.grid import Layer, cell_normals
from risorius.springmuscle.muscle import Fibre
from risorius.springmuscle.recipe import Ring
from risorius.springmuscle.refine import Refined

__all__ = ["make_fibres"]

# Skin vertices that say which lip lies above an ellipsoid, and how many must agree.
_ASKED, _AGREE = 4, 2
# Ellipsoids of a ring this near to the height of the commissures may move both lips [mm].
_LEVEL = 1.0
# Two consecutive control points nearer than this count as one [mm].
_EQUAL = 1e-6


def make_fibres(
    refined: Refined, bones: npt.NDArray[np.int8], layer: Layer, *, closed: bool
) -> tuple[Fibre, ...]:
    """Return one fibre per column of cells, one ellipsoid per cell.

    Control points are the middles of a cell's two cross edges; the ellipsoid fills the cell, inner
    ones are enlarged a little so that they overlap (Kaehler et al. 2001, section 5.3).

    Parameters
    ----------
    refined : Refined
        Grid (r, c, 3).
    bones : (r,) int8
        Bone of every row.
    layer : Layer
    closed : bool
    """
    grid, surface, outline = refined.points, layer.surface, layer.outline
    out = surface.outwards(grid.reshape(-1, 3)).reshape(grid.shape)
    points = 0.5 * (grid[:, :-1] + grid[:, 1:])
    along = np.diff(points, axis=0)
    length = np.linalg.norm(along, axis=2)
    frames = _frames(along, cell_normals(grid, out), out)
    width = np.linalg.norm(np.diff(grid, axis=1), axis=2)
    width = 0.5 * (width[1:] + width[:-1])
    grow_long, grow_wide = _overlaps(length.shape, layer.parameters.overlap, closed)
    half_axes = 0.5 * np.stack(
        [length * grow_long, width * grow_wide, refined.report.thickness], axis=2
    )
    lips = _lips_above(0.5 * (points[1:] + points[:-1]), frames[..., 2], layer)
    shares = _row_shares(layer, refined.rows)
    fibres: list[Fibre] = []
    for column in range(points.shape[1]):
        kept = _distinct(points[:, column])
        cells = np.array([k - 1 for k in kept[1:]])
        aims = None
        if outline.ring is not None:
            aims = ring_aims(points[kept, column], outline.ring, layer)
        fibres.append(
            Fibre(
                points[kept, column],
                bones[kept],
                half_axes[cells, column],
                frames[cells, column],
                lips[cells, column],
                aims,
                None if outline.ring is None else shares[kept],
            )
        )
    return tuple(fibres)


def _distinct(points: FloatArray) -> list[int]:
    """Return the rows of a fibre that differ from the one before."""
    step = np.linalg.norm(np.diff(points, axis=0), axis=1)
    return [0, *(int(k) + 1 for k in np.flatnonzero(step > _EQUAL))]


def _frames(along: FloatArray, normals: FloatArray, out: FloatArray) -> FloatArray:
    """Return frames (r - 1, c - 1, 3, 3): along the fibre, along the skin, out of it."""
    first = unit(along)
    middle = 0.25 * (out[1:, 1:] + out[:-1, 1:] + out[1:, :-1] + out[:-1, :-1])
    flat = np.linalg.norm(normals, axis=2, keepdims=True) < 0.5
    third = np.where(flat, middle, normals)
    third = unit(third - (third * first).sum(axis=2, keepdims=True) * first)
    return np.stack([first, np.cross(third, first), third], axis=3)


def _overlaps(
    shape: tuple[int, ...], overlap: float, closed: bool
) -> tuple[FloatArray, FloatArray]:
    long, wide = np.ones(shape), np.ones(shape)
    if closed:
        long[:] = overlap
    elif shape[0] > 2:
        long[1:-1] = overlap
    if shape[1] > 2:
        wide[:, 1:-1] = overlap
    return long, wide


def _lips_above(centres: FloatArray, normals: FloatArray, layer: Layer) -> npt.NDArray[np.int8]:
    """Return the lip (r - 1, c - 1) that the skin above every ellipsoid belongs to."""
    surface = layer.surface
    # A ring is split down to the commissures; what ends there may move both lips.
    labels = surface.lips if layer.outline.ring is None else surface.sides
    seen = np.flatnonzero(~surface.hidden)
    above = centres + normals * layer.start(centres)[..., None]
    near = cKDTree(surface.mesh.positions[seen]).query(above.reshape(-1, 3), k=_ASKED)[1]
    voters = labels[seen[near]].astype(np.int32)
    votes = voters.sum(axis=1)
    lips = np.where(np.abs(votes) >= _AGREE, np.sign(votes), 0)
    if layer.outline.ring is not None:
        # Where the skin is at odds, beside the commissures, height above them decides.
        marks = surface.measure.landmarks
        above_line = centres[..., 1].ravel() - 0.5 * (marks["2.4"] + marks["2.5"])[1]
        odd = (lips == 0) & voters.any(axis=1) & (np.abs(above_line) > _LEVEL * surface.scale)
        lips = np.where(odd, np.sign(above_line).astype(np.int32), lips)
    return lips.reshape(centres.shape[:2]).astype(np.int8)


def _row_shares(layer: Layer, rows: FloatArray) -> FloatArray:
    """Return the share of the contraction at each of the grid's `rows` (r,)."""
    ring = layer.outline.ring
    if ring is None or not ring.shares:
        return np.ones(len(rows))
    drawn = [*ring.shares, *ring.shares[:1]] if ring.closed else ring.shares
    return np.interp(rows, np.arange(len(drawn)), drawn)


def ring_aims(points: FloatArray, ring: Ring, layer: Layer) -> FloatArray:
    """Return where the points (p, 3) of a sphincter are drawn to.

    The centre, moved ahead of the lips; or the nearest place, sideways, on a line that bends from
    its ends through the centre, as lids close to a line and not to a point (finding S6); or their
    own places turned about that line.
    """
    surface, parameters = layer.surface, layer.parameters
    ahead = np.array([0.0, 0.0, ring.ahead * surface.scale if parameters.ahead else 0.0])
    centre = ring.centre.place(surface.measure) + ahead
    aims = np.tile(centre, (len(points), 1))
    if not (ring.line and parameters.lines):
        return aims
    left, right = (point.place(surface.measure) + ahead for point in ring.line)
    place = points[:, 0] - centre[0]
    ends = np.where(place[:, None] > 0.0, left, right)
    span = ends[:, 0] - centre[0]
    share = np.clip(place / np.where(span == 0.0, 1.0, span), 0.0, 1.0)
    aims[:, 0] = centre[0] + share * span
    aims[:, 1:] = centre[1:] + (ends[:, 1:] - centre[1:]) * (share**2)[:, None]
    return _turned(points, aims, np.radians(ring.turn)) if ring.turn else aims


def _turned(points: FloatArray, axis: FloatArray, angle: float) -> FloatArray:
    """Return `points` (p, 3) turned about the horizontal axes through `axis` (p, 3), front down.

    Along the tangent: fibres go straight to their aims, a circle would carry the lip backwards.
    """
    turned = points.copy()
    up, ahead = (points - axis)[:, 1:].T
    turned[:, 1] -= angle * ahead
    turned[:, 2] += angle * up
    return turned
