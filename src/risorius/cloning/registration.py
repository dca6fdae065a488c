"""The registration: the source's skin comes to lie on the target's, smoothly, side by side."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from risorius._check import BoolArray, FloatArray, IntArray
from risorius.cloning.polyline import nearest_on_line, nearest_on_segments
from risorius.cloning.rough_fit import RoughFit
from risorius.cloning.subject import Subject
from risorius.mesh.connectivity import edge_faces
from risorius.mesh.core import TriMesh
from risorius.mesh.laplacian import SmoothField
from risorius.mesh.normals import NormalsOperator
from risorius.spatial.closest import closest_points

__all__ = ["Registration", "register"]

_SIDES = (0, 1, -1)


@dataclass(frozen=True)
class _Stage:
    """Rounds of one stiffness.

    `normal` is the length that a full turn of the normal counts for when partners are looked
    for [mm]; 0 takes closest points. `bend` and `length` are those of `SmoothField` [mm].
    """

    rounds: int
    normal: float
    bend: float
    length: float


_STAGES = (
    _Stage(4, 20.0, 40.0, 25.0),
    _Stage(1, 0.0, 8.0, 5.0),
    _Stage(1, 0.0, 4.0, 3.0),
    _Stage(1, 0.0, 3.0, 2.0),
)
# Partners farther off than this, or turned farther, are none [mm], [deg].
_FARTHEST, _TURNED = 12.0, 60.0
# Open borders (eye holes, a cut neck) match only if they are this near [mm].
_BORDER = 4.0
_LINE_PULL = 3.0
_LOOSE = 1e-6


@dataclass(frozen=True, eq=False)
class Registration:
    """The source's skin on the target's.

    Parameters
    ----------
    mesh : TriMesh
        The source's faces, registered [mm].
    residual : (n,) float64
        Distance to the target; NaN where a vertex has no partner [mm].
    """

    mesh: TriMesh
    residual: FloatArray


def register(source: Subject, target: Subject, fit: RoughFit) -> Registration:
    """Move the warped source onto the target.

    Every round looks for a partner of each vertex that is seen: the same side of the lips, a
    like normal; contact lines and open borders look for theirs on the target's. The step towards
    them is smoothed by a Laplacian solve, stiff first and softer later. What lies behind lips and
    lids follows the rim.
    """
    positions = fit.warp(fit.positions)
    rest = TriMesh(fit.positions, source.mesh.faces)
    partners = _Partners(source, target, fit)
    normals = NormalsOperator(rest.faces, rest.vertex_count)
    for stage in _STAGES:
        field = None
        for _ in range(stage.rounds):
            step, pull = partners.steps(positions, normals(positions), normal=stage.normal)
            if field is None:
                field = SmoothField(
                    rest, np.maximum(pull, _LOOSE), length=stage.length, bend=stage.bend
                )
            positions = positions + field.solve(step)
    step, pull = partners.steps(positions, normals(positions), normal=0.0)
    residual = np.where(pull > 0.0, np.linalg.norm(step, axis=1), np.nan)
    return Registration(TriMesh(positions, rest.faces), residual)


class _Partners:
    """Finds where each source vertex should go."""

    def __init__(self, source: Subject, target: Subject, fit: RoughFit) -> None:
        self._target = target.mesh
        seen = ~source.inside
        ours = source.side
        if source.lips is None or target.lips is None:
            ours = np.zeros_like(ours)
        self._rows = {side: np.flatnonzero(seen & (ours == side)) for side in _SIDES}
        self._masks = {side: _allowed(target, side) for side in _SIDES}
        self._samples: dict[int, tuple[FloatArray, FloatArray]] = {
            side: _samples(target.mesh, self._masks[side]) for side in _SIDES
        }
        a, b = source.lines(), target.lines()
        self._lines = [(a[name], self._target.positions[b[name]]) for name in fit.lines]
        self._border = np.unique(_border(source.mesh))
        self._target_border = _border(target.mesh)
        self._is_border = np.zeros(source.mesh.vertex_count, bool)
        self._is_border[self._border] = True

    def steps(
        self, positions: FloatArray, normals: FloatArray, *, normal: float
    ) -> tuple[FloatArray, FloatArray]:
        """Return the wanted step (n, 3) of each vertex [mm] and how much it counts (n,)."""
        goal = np.full_like(positions, np.nan)
        for side in _SIDES:
            rows = self._rows[side]
            if not len(rows):
                continue
            if normal > 0.0:
                goal[rows] = self._by_normal(side, positions[rows], normals[rows], normal)
            else:
                goal[rows] = closest_points(
                    self._target,
                    positions[rows],
                    normals=normals[rows],
                    max_angle=_TURNED,
                    face_mask=self._masks[side],
                ).positions
        step = goal - positions
        found = np.linalg.norm(step, axis=1) < _FARTHEST
        found &= ~self._is_border
        step[~found] = 0.0
        pull = found.astype(np.float64)
        self._match_borders(positions, step, pull)
        for line, points in self._lines:
            step[line] = nearest_on_line(positions[line], points) - positions[line]
            pull[line] = _LINE_PULL
        return step, pull

    def _by_normal(
        self, side: int, points: FloatArray, normals: FloatArray, length: float
    ) -> FloatArray:
        places, directions = self._samples[side]
        tree = cKDTree(np.concatenate([places, length * directions], axis=1))
        nearest = tree.query(np.concatenate([points, length * normals], axis=1), workers=-1)[1]
        return places[nearest]

    def _match_borders(self, positions: FloatArray, step: FloatArray, pull: FloatArray) -> None:
        if not (len(self._border) and len(self._target_border)):
            return
        start = positions[self._border]
        move = nearest_on_segments(start, self._target.positions, self._target_border) - start
        near = np.linalg.norm(move, axis=1) < _BORDER
        step[self._border[near]] = move[near]
        pull[self._border[near]] = 1.0


def _allowed(target: Subject, side: int) -> BoolArray:
    seen = ~target.face_inside
    return seen if side == 0 else seen & (target.face_side * side >= 0)


def _border(mesh: TriMesh) -> IntArray:
    table = edge_faces(mesh.faces)
    return table.edges[table.counts == 1]


def _samples(mesh: TriMesh, faces: BoolArray) -> tuple[FloatArray, FloatArray]:
    """Return points (k, 3) spread over the chosen faces, and their normals."""
    normals = NormalsOperator(mesh.faces, mesh.vertex_count)(mesh.positions)
    chosen = mesh.faces[faces]
    groups = [np.unique(chosen)[:, None], chosen, chosen[:, :2], chosen[:, 1:], chosen[:, [0, 2]]]
    points = np.concatenate([mesh.positions[group].mean(axis=1) for group in groups])
    directions = np.concatenate([normals[group].mean(axis=1) for group in groups])
    length = np.linalg.norm(directions, axis=1, keepdims=True)
    return points, directions / np.maximum(length, 1e-9)
