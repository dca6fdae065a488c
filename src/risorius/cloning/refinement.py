"""The published correspondence: contours, then rays from the moving vertices, pass by pass."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from risorius._check import BoolArray, FloatArray, IntArray
from risorius.cloning.landmark_pairs import LandmarkPairs
from risorius.cloning.mapping import Mapping, identity_filling
from risorius.cloning.parameters import CloneParameters
from risorius.cloning.polyline import nearest_on_line
from risorius.cloning.subject import Subject
from risorius.mesh.core import TriMesh
from risorius.mesh.normals import face_normals, vertex_normals
from risorius.spatial.closest import closest_points
from risorius.spatial.raycast import Scene
from risorius.warp.rbf import RbfWarp

__all__ = ["Refinement", "ray_length", "ray_mapping", "refine"]

# Hits nearer than this share of the face's height teach nothing (unnecessary pairs).
_TINY = 1e-4
# Hits whose normal differs by more are on another sheet [deg].
_TURNED = 60.0


@dataclass(frozen=True, eq=False)
class Refinement:
    """The refined warp.

    Parameters
    ----------
    rest : TriMesh
        The source's skin, moved by the similarity [mm].
    warp : RbfWarp
        From there onto the target.
    centre_count, pass_count : int
        Pairs in the end, passes that were made.
    misses : tuple of float
        Mean distance of the moving vertices to the target along their rays, before each pass
        and after the last [mm].
    ray : float
        Length of the rays [mm].
    """

    rest: TriMesh
    warp: RbfWarp
    centre_count: int
    pass_count: int
    misses: tuple[float, ...]
    ray: float


def ray_length(target: Subject, share: float) -> float:
    """Return the length of the rays, `share` of ENS0, the eyes' height over the nose [mm].

    Without landmark 9.15 the tip of the nose (9.3) or two thirds of the eye distance stand in.
    """
    marks = target.head.landmarks
    eyes = marks.positions(("3.7", "3.11", "3.8", "3.12"))
    base = next((name for name in ("9.15", "9.3") if name in marks), None)
    if base is not None:
        return share * abs(float(eyes[:, 1].mean() - marks.position(base)[1]))
    return share * 0.67 * float(np.linalg.norm(eyes[:2].mean(axis=0) - eyes[2:].mean(axis=0)))


def refine(
    source: Subject,
    target: Subject,
    pairs: LandmarkPairs,
    moving: BoolArray,
    parameters: CloneParameters,
) -> Refinement:
    """Fit the warp as published (thesis 6.2, spec 2.4 and 2.5, errata E5, E6, S1).

    Parameters
    ----------
    source, target : Subject
    pairs : LandmarkPairs
    moving : (v,) bool
        Source vertices that may become centres.
    parameters : CloneParameters

    Notes
    -----
    With `parameters.smoothing` 0 the ray hits are interpolated exactly, as published, which
    tears dense meshes; with `centre_gap` 0 every moving vertex may become a centre.
    """
    rest = source.mesh.at(pairs.similarity.apply(source.mesh.positions))
    height = target.head.height
    gap = max(parameters.centre_gap * height, 1e-6 * height)
    centres = _Centres(gap, parameters.smoothing)
    centres.add_all(pairs.similarity.apply(pairs.source), pairs.target)
    warp = centres.fit()
    lines, theirs = source.lines(), target.lines()
    for name in (name for name in lines if name in theirs):
        points = rest.positions[lines[name]]
        goals = nearest_on_line(warp(points), target.mesh.positions[theirs[name]])
        centres.add_all(points, goals)
    warp = centres.fit()
    rays = _Rays(source, target, ray_length(target, parameters.ray_share))
    movable = np.flatnonzero(moving & ~source.inside).astype(np.int32)
    misses: list[float] = []
    passes = 0
    while passes < parameters.passes and len(movable):
        hits, goals, distance = rays.cast(warp(rest.positions), rest.faces, movable)
        misses.append(float(distance[hits].mean()) if hits.any() else 0.0)
        useful = np.flatnonzero(hits & (distance > _TINY * height))
        worst = useful[np.argsort(-distance[useful], kind="stable")]
        added = centres.update(
            movable[worst], rest.positions, goals[worst], most=parameters.centres_per_pass
        )
        passes += 1
        if not added:
            break
        warp = centres.fit()
    if len(movable):
        hits, _, distance = rays.cast(warp(rest.positions), rest.faces, movable)
        misses.append(float(distance[hits].mean()) if hits.any() else 0.0)
    return Refinement(rest, warp, len(centres.source), passes, tuple(misses), rays.length)


class _Centres:
    """The pairs of the warp, no two of them too close together."""

    def __init__(self, gap: float, smoothing: float) -> None:
        self.source: list[FloatArray] = []
        self.target: list[FloatArray] = []
        self._row_of: dict[int, int] = {}
        self._gap, self._smoothing = gap, smoothing

    def add_all(self, source: FloatArray, target: FloatArray) -> None:
        for p, q in zip(source, target):
            if self._is_free(p, 1e-3 * self._gap if not self._smoothing else self._gap):
                self.source.append(p)
                self.target.append(q)

    def update(
        self, vertices: IntArray, positions: FloatArray, goals: FloatArray, *, most: int
    ) -> int:
        """Move the targets of known vertices, add up to `most` new ones; return how many."""
        added = 0
        tree = cKDTree(np.array(self.source))
        fresh: list[FloatArray] = []
        for vertex, goal in list(zip(vertices.tolist(), goals))[: 4 * most]:
            row = self._row_of.get(vertex)
            if row is not None:
                self.target[row] = goal
                continue
            point = positions[vertex]
            if added >= most or tree.query(point)[0] < self._gap:
                continue
            if fresh and np.linalg.norm(np.array(fresh) - point, axis=1).min() < self._gap:
                continue
            self._row_of[vertex] = len(self.source)
            self.source.append(point)
            self.target.append(goal)
            fresh.append(point)
            added += 1
        return added

    def fit(self) -> RbfWarp:
        return RbfWarp.fit(
            np.array(self.source), np.array(self.target), regularisation=self._smoothing
        )

    def _is_free(self, point: FloatArray, gap: float) -> bool:
        if not self.source:
            return True
        return bool(np.linalg.norm(np.array(self.source) - point, axis=1).min() > gap)


class _Rays:
    """Rays along the normals, both ways, that keep to their side of the lips."""

    def __init__(self, source: Subject, target: Subject, length: float) -> None:
        self.length = length
        self._scene = Scene([target.mesh])
        seen = ~target.face_inside
        self._side = source.side
        self._masks = {
            side: seen if side == 0 else seen & (target.face_side * side >= 0)
            for side in (0, 1, -1)
        }

    def cast(
        self, positions: FloatArray, faces: IntArray, vertices: IntArray
    ) -> tuple[BoolArray, FloatArray, FloatArray]:
        """Return which vertices hit (k,), the places (k, 3) and the distances (k,) [mm]."""
        normals = vertex_normals(positions, faces, weighting="uniform")
        hit = np.zeros(len(vertices), bool)
        goals, distance = np.zeros((len(vertices), 3)), np.zeros(len(vertices))
        for side, mask in self._masks.items():
            rows = np.flatnonzero((self._side[vertices] == side) & normals[vertices].any(axis=1))
            if not len(rows) or not mask.any():
                continue
            chosen = vertices[rows]
            found = self._scene.cast(
                positions[chosen],
                normals[chosen],
                max_distance=self.length,
                both_directions=True,
                face_mask=mask,
            )
            facing = np.einsum("ij,ij->i", found.normals, normals[chosen])
            good = found.hit & (facing > np.cos(np.radians(_TURNED)))
            hit[rows] = good
            goals[rows[good]] = found.positions[good]
            distance[rows[good]] = np.abs(found.distance[good])
        return hit, goals, distance


def ray_mapping(source: Subject, target: Subject, fitted: TriMesh, length: float) -> Mapping:
    """Map target vertices along their normals onto the fitted source (spec 2.6).

    A vertex whose rays miss takes the nearest point within the rays' length that faces alike;
    without one it stays at rest.
    """
    mesh = target.mesh
    normals = vertex_normals(mesh.positions, mesh.faces, weighting="uniform")
    scene = Scene([fitted])
    n = mesh.vertex_count
    face, bary = np.zeros(n, np.int32), np.zeros((n, 3))
    distance, places = np.full(n, np.inf), mesh.positions.copy()
    fronts = face_normals(fitted.positions, fitted.faces)
    least = float(np.cos(np.radians(_TURNED)))
    for side in (0, 1, -1):
        mask = source.face_side * side >= 0
        rows = np.flatnonzero((target.side == side) & normals.any(axis=1))
        if not len(rows) or not mask.any():
            continue
        found = scene.cast(
            mesh.positions[rows],
            normals[rows],
            max_distance=length,
            both_directions=True,
            face_mask=mask,
        )
        facing = np.einsum("ij,ij->i", fronts[found.face], normals[rows])
        good = found.hit & (facing > least)
        hit = rows[good]
        face[hit], bary[hit] = found.face[good], found.bary[good]
        distance[hit], places[hit] = np.abs(found.distance[good]), found.positions[good]
        lost = rows[~good]
        near = closest_points(
            fitted, mesh.positions[lost], face_mask=mask, normals=normals[lost], max_angle=_TURNED
        )
        close = near.distance < length
        hit = lost[close]
        face[hit], bary[hit] = near.face[close], near.bary[close]
        distance[hit], places[hit] = near.distance[close], near.positions[close]
    corners = fitted.faces[face]
    weight = np.isfinite(distance).astype(np.float64)
    offset = places[:, None] - fitted.positions[corners]
    return Mapping(corners, bary, distance, weight, offset, identity_filling(n))
