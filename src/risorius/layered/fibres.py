"""Fibres of the sheet muscles, laid on bone and on one another, and how they shorten."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from risorius._check import FloatArray, IntArray
from risorius.anatomy.outwards import outwards, unit
from risorius.anatomy.skull import Skull
from risorius.anatomy.template import builtin_head
from risorius.layered.muscle import Muscle, Sheet
from risorius.layered.muscle_map import MuscleMap
from risorius.mesh.core import TriMesh
from risorius.spatial.raycast import Scene

__all__ = ["contract", "lay_fibres", "refine"]

SAMPLES = 11
"""Samples along a fibre."""

_OUTSIDE = 60.0
_REACH = 130.0
# A fibre bridges what lies deeper below its chord than this share of the chord (spec 2.3).
_GAP = 0.25
_STEPS = 6
# Farther below than this a muscle does not drop onto its support [mm].
_DROP = 10.0


@dataclass(frozen=True, eq=False)
class _Support:
    scene: Scene | None
    direction: FloatArray | None

    def out(self, points: FloatArray) -> FloatArray:
        if self.direction is None:
            return outwards(points)
        return np.broadcast_to(unit(self.direction), points.shape)

    def heights(self, points: FloatArray) -> FloatArray:
        """Return how far (q,) the support lies outside `points`; NaN where there is none."""
        if self.scene is None:
            return np.full(len(points), np.nan)
        out = self.out(points)
        hits = self.scene.cast(points + _OUTSIDE * out, -out, max_distance=_REACH)
        return np.where(hits.hit, _OUTSIDE - hits.distance, np.nan)


def lay_fibres(
    muscle_map: MuscleMap, skull: Skull, *, kept: Mapping[str, FloatArray] | None = None
) -> dict[str, FloatArray]:
    """Lay the left (or only) fibres of every sheet on what it lies on.

    Parameters
    ----------
    muscle_map : MuscleMap
    skull : Skull
        In the canonical frame of the built-in head; the fibres are given there.
    kept : mapping of str to (s, f, 3) float64, optional
        Fibres that are known already and are not laid again [mm].

    Returns
    -------
    dict of str to array
        (s, f, 3) float64 each: samples from origin to insertion, fibres side by side [mm].
    """
    result: dict[str, FloatArray] = {}
    tops: dict[str, TriMesh] = {}
    bones = skull.surfaces
    known = kept or {}
    for muscle in muscle_map.muscles:
        if not isinstance(muscle.shape, Sheet):
            continue
        meshes = [mesh for name in muscle.on for mesh in bones.get(name, ())]
        meshes += [tops[name] for name in muscle.on if name in tops]
        scene = Scene(meshes) if meshes and muscle.name not in known else None
        support = _Support(scene, muscle.shape.direction)
        fibres = known.get(muscle.name)
        if fibres is None:
            fibres = _lay(muscle, muscle.shape, skull, support)
        result[muscle.name] = fibres
        tops[muscle.name] = _top(fibres, support, muscle.thickness)
    return result


def _lay(muscle: Muscle, sheet: Sheet, skull: Skull, support: _Support) -> FloatArray:
    line = builtin_head().frame.to_canonical(sheet.line)
    if skull.carry is not None:
        line = skull.carry(line)
    across = unit(np.cross(unit(np.gradient(line, axis=0)), support.out(line)))
    fibres: list[FloatArray] = []
    for offset in np.linspace(-1.0, 1.0, muscle.sections[0]):
        points = _on_support(line + offset * sheet.half_width[:, None] * across, support)
        fibres.append(_resampled(_over_support(points, support), SAMPLES))
    return np.stack(fibres, axis=1)


def _on_support(points: FloatArray, support: _Support) -> FloatArray:
    height = support.heights(points)
    # Over holes of the bone (orbit, nose) a muscle stays where it was drawn.
    height = np.where(height > -_DROP, height, 0.0)
    return points + height[:, None] * support.out(points)


def _over_support(points: FloatArray, support: _Support) -> FloatArray:
    """Return the polyline with its chords lifted over, or dropped onto, what lies near them."""
    share = np.linspace(0.0, 1.0, _STEPS, endpoint=False)[:, None]
    rows: list[FloatArray] = []
    for start, end in pairwise(points):
        chord = (1.0 - share) * start + share * end
        height = support.heights(chord)
        near = height > -_GAP * float(np.linalg.norm(end - start))
        rows.append(chord + np.where(near, height, 0.0)[:, None] * support.out(chord))
    return np.concatenate([*rows, points[-1:]])


def _resampled(points: FloatArray, count: int) -> FloatArray:
    length = _lengths(points)
    wanted = np.linspace(0.0, length[-1], count)
    return np.stack([np.interp(wanted, length, points[:, axis]) for axis in range(3)], axis=1)


def _lengths(points: FloatArray) -> FloatArray:
    steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    return np.concatenate([[0.0], np.cumsum(steps)])


def _top(fibres: FloatArray, support: _Support, thickness: float) -> TriMesh:
    points = fibres.reshape(-1, 3)
    return TriMesh(points + thickness * support.out(points), grid_faces(*fibres.shape[:2]))


def grid_faces(rows: int, columns: int) -> IntArray:
    """Return the faces (m, 3) of a grid of `rows` by `columns` vertices."""
    corner = (np.arange(rows - 1)[:, None] * columns + np.arange(columns - 1)).ravel()
    first = np.stack([corner, corner + 1, corner + columns + 1], axis=1)
    second = np.stack([corner, corner + columns + 1, corner + columns], axis=1)
    return np.concatenate([first, second]).astype(np.int32)


def contract(fibres: FloatArray, contraction: float, *, fixed_point: float = 0.0) -> FloatArray:
    """Return fibres (samples, fibres, 3) shortened along themselves [mm].

    The point at arc length l moves to ``l0 + (1 - c)(l - l0)`` with l0 the fixed point: 0 holds
    the origin, a point inside the fibre draws both ends towards it (the brow rises and the upper
    forehead comes down; finding T1).

    Parameters
    ----------
    fibres : (h, w, 3) float64
        h samples along w fibres, origin first [mm].
    contraction : float
        c, 0 to below 1.
    fixed_point : float
        l0 as share of the fibre's length.
    """
    result = np.empty_like(fibres)
    for column in range(fibres.shape[1]):
        length = _lengths(fibres[:, column])
        still = fixed_point * length[-1]
        place = still + (1.0 - contraction) * (length - still)
        for axis in range(3):
            result[:, column, axis] = np.interp(place, length, fibres[:, column, axis])
    return result


def refine(grid: FloatArray, times: int) -> FloatArray:
    """Return the grid (h, w, d) with `times` cells for each, interpolated bilinearly."""
    for axis in (0, 1):
        count = grid.shape[axis]
        place = np.linspace(0.0, count - 1.0, (count - 1) * times + 1)
        low = np.minimum(place.astype(int), count - 2)
        share = (place - low).reshape([-1 if k == axis else 1 for k in range(3)])
        grid = (1.0 - share) * grid.take(low, axis) + share * grid.take(low + 1, axis)
    return grid
