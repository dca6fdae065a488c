"""Teeth, tongue, eyes and lashes: their own motion, about the target's own pivots."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from risorius._check import FloatArray, IntArray
from risorius.anatomy.follow import Follower, follow_skin
from risorius.cloning.subject import Subject
from risorius.head.part import Part
from risorius.head.part_geometry import fit_sphere
from risorius.mesh.connectivity import components
from risorius.warp.rbf import RbfWarp
from risorius.warp.similarity import Similarity, fit_similarity

__all__ = ["PartCarrier", "PartMotion", "carriers"]

_ON_SKIN = ("lashes_left", "lashes_right", "attached")
# What a part takes its motion from if the source has none of its kind.
_INSTEAD = {
    "tongue": ("gums", "teeth_lower"),
    "gums": ("teeth_upper",),
    "teeth_lower": ("gums",),
    "mouth_inside": ("gums",),
}
_WITH_CHIN = ("teeth_lower", "tongue")
# Skin around the chin that tells the jaw's motion, as a share of the face's height.
_CHIN = 0.07
_NEIGHBOURS = 4
# Lashes whose vertices lie as near as this to the source's, laid over them, are the same [mm].
_ALIKE = 0.3


@dataclass(frozen=True, eq=False)
class PartMotion:
    """What is known of one shape when a part is carried.

    Parameters
    ----------
    part : (j, 3) float64 or None
        Displacement of the source's part [mm].
    source_skin : (v, 3) float64
        Displacement of the source's skin [mm].
    target_skin, target_rest : (n, 3) float64
        Displacement and rest positions of the target's skin [mm].
    """

    part: FloatArray | None
    source_skin: FloatArray
    target_skin: FloatArray
    target_rest: FloatArray


@dataclass(frozen=True, eq=False)
class PartCarrier:
    """Carries the motion of one part of the target.

    The motion of the source's part is split into the best rigid motion and the rest. The rigid
    motion acts about the target part's own pivot; the rest is interpolated from the source's
    nearest vertices, after its part was laid over the target's.

    Parameters
    ----------
    part : Part
        Of the target.
    origin : Part or None
        Of the source.
    skin : Follower or None
        Target skin that carries the part; used where `origin` is None.
    under : Follower or None
        Source skin under the source's part, where both lie on the skin: what the part does
        beyond following it is taken over as well.
    is_rigid : bool
        Whether only the rigid motion of `skin`'s vertices is taken over (a jaw by its chin).
    pivots : (2, 3) float64
        Of the source's and of the target's part [mm].
    nearest, weights : (k, 4)
        Source vertices for each target vertex.
    """

    part: Part
    origin: Part | None
    skin: Follower | None
    under: Follower | None
    is_rigid: bool
    pivots: FloatArray
    nearest: IntArray
    weights: FloatArray

    def carry(self, similarity: Similarity, motion: PartMotion) -> FloatArray:
        """Return the displacement (k, 3) of the target's part [mm]."""
        points, deltas = self.part.mesh.positions, motion.part
        if self.skin is not None:
            if self.is_rigid:
                return self._with_chin(motion)
            followed = self.skin.displace(motion.target_skin)
            if self.under is None or deltas is None:
                return followed
            own = (deltas - self.under.displace(motion.source_skin)) @ similarity.linear.T
            return followed + np.einsum("ks,ksj->kj", self.weights, own[self.nearest])
        if self.origin is None or deltas is None:
            return np.zeros_like(points)
        if not deltas.any():
            return np.zeros_like(points)
        start = self.origin.mesh.positions
        moved = fit_similarity(start, start + deltas, allow_scale=False)
        pivot, own = self.pivots
        shift = moved.apply(pivot[None])[0] - pivot
        turn = similarity.rotation @ moved.rotation @ similarity.rotation.T
        left = (start + deltas - moved.apply(start)) @ similarity.linear.T
        rigid = (points - own) @ (turn - np.eye(3)).T + similarity.linear @ shift
        return rigid + np.einsum("ks,ksj->kj", self.weights, left[self.nearest])

    def _with_chin(self, motion: PartMotion) -> FloatArray:
        assert self.skin is not None
        points = self.part.mesh.positions
        used = np.unique(self.skin.vertices)
        moved, rest = motion.target_skin[used], motion.target_rest[used]
        if not moved.any():
            return np.zeros_like(points)
        return fit_similarity(rest, rest + moved, allow_scale=False).apply(points) - points


def carriers(
    source: Subject, target: Subject, similarity: Similarity, warp: RbfWarp
) -> tuple[dict[str, PartCarrier], list[str]]:
    """Bind every part of the target but the skin; also return what stays at rest, in words."""
    result: dict[str, PartCarrier] = {}
    notes: list[str] = []
    for kind, part in target.head.parts.items():
        if kind == "skin":
            continue
        if kind in _ON_SKIN:
            own = source.head.part(kind)
            result[kind] = _on_skin(kind, part, own, source, target, similarity)
            continue
        origin = source.head.part(kind)
        if origin is not None:
            laid = _fit_box(origin, part, similarity)
            result[kind] = _like(kind, part, origin, laid, similarity.rotation)
            continue
        other = next((k for k in _INSTEAD.get(kind, ()) if source.head.part(k)), None)
        if other is not None:
            substitute = source.head.parts[other]
            laid = warp(similarity.apply(substitute.mesh.positions))
            result[kind] = _like(kind, part, substitute, laid, similarity.rotation)
        elif kind in _WITH_CHIN and "2.1" in target.head.landmarks:
            result[kind] = _with_chin(part, target)
            notes.append(f"{kind}: the source has none; it moves with the chin")
        elif kind != "other":
            notes.append(f"{kind}: the source has none; it stays at rest")
    return result, notes


def _on_skin(
    kind: str,
    part: Part,
    origin: Part | None,
    source: Subject,
    target: Subject,
    similarity: Similarity,
) -> PartCarrier:
    skin = _follow(kind, part, target)
    if origin is not None:
        laid = _fit_box(origin, part, similarity)
        nearest, weights = _neighbours(part, laid)
        apart = np.linalg.norm(laid[nearest[:, 0]] - part.mesh.positions, axis=1)
        if float(np.median(apart)) < _ALIKE:
            under = _follow(kind, origin, source)
            return PartCarrier(part, origin, skin, under, False, np.zeros((2, 3)), nearest, weights)
    return PartCarrier(part, None, skin, None, False, np.zeros((2, 3)), *_nothing())


def _follow(kind: str, part: Part, subject: Subject) -> Follower:
    """Bind a part to the skin; each loose piece of the lashes to the margin of one lid."""
    points = part.mesh.positions
    margins = subject.lids.get({"lashes_left": "l", "lashes_right": "r"}.get(kind, ""))
    if margins is None:
        seen = np.flatnonzero(~subject.inside).astype(np.int32)
        return follow_skin(points, subject.mesh, only=seen)
    lines = (margins.slit.upper, margins.slit.lower)
    bound = [follow_skin(points, subject.mesh, only=line, neighbours=3) for line in lines]
    away = [cKDTree(subject.mesh.positions[line]).query(points)[0] for line in lines]
    pieces = components(part.mesh.faces, len(points)).of_vertex
    vertices, weights = bound[0].vertices.copy(), bound[0].weights.copy()
    for piece in range(int(pieces.max(initial=-1)) + 1):
        rows = pieces == piece
        if np.mean(away[1][rows]) < np.mean(away[0][rows]):
            vertices[rows], weights[rows] = bound[1].vertices[rows], bound[1].weights[rows]
    return Follower(vertices, weights)


def _with_chin(part: Part, target: Subject) -> PartCarrier:
    seen = np.flatnonzero(~target.inside).astype(np.int32)
    chin = target.head.landmarks.position("2.1")
    away = np.linalg.norm(target.mesh.positions[seen] - chin, axis=1)
    near = seen[away < _CHIN * target.head.height]
    near = near if len(near) >= 4 else seen[np.argsort(away)[:12]]
    skin = follow_skin(target.mesh.positions[near], target.mesh, only=near)
    return PartCarrier(part, None, skin, None, True, np.zeros((2, 3)), *_nothing())


def _like(kind: str, part: Part, origin: Part, laid: FloatArray, turn: FloatArray) -> PartCarrier:
    nearest, weights = _neighbours(part, laid)
    # Both boxes stand as the source's does.
    own = _pivot(kind, part.mesh.positions @ turn) @ turn.T
    pivots = np.stack([_pivot(kind, origin.mesh.positions), own])
    return PartCarrier(part, origin, None, None, False, pivots, nearest, weights)


def _nothing() -> tuple[IntArray, FloatArray]:
    return np.zeros((0, _NEIGHBOURS), np.int32), np.zeros((0, _NEIGHBOURS))


def _neighbours(part: Part, laid: FloatArray) -> tuple[IntArray, FloatArray]:
    count = min(_NEIGHBOURS, len(laid))
    distance, nearest = cKDTree(laid).query(part.mesh.positions, k=count)
    weights = 1.0 / np.maximum(np.asarray(distance).reshape(-1, count), 1e-9) ** 2
    weights /= weights.sum(axis=1, keepdims=True)
    return np.asarray(nearest, np.int32).reshape(-1, count), weights


def _pivot(kind: str, points: FloatArray) -> FloatArray:
    if kind.startswith("eye") and len(points) >= 12:
        centre, radius, residual = fit_sphere(points)
        if residual < 0.2 * radius:
            return centre
    return 0.5 * (points.min(axis=0) + points.max(axis=0))


def _fit_box(origin: Part, part: Part, similarity: Similarity) -> FloatArray:
    """Return the source part's vertices, its bounding box laid over the target part's."""
    moved = similarity.apply(origin.mesh.positions)
    low, high = moved.min(axis=0), moved.max(axis=0)
    goal_low, goal_high = part.mesh.positions.min(axis=0), part.mesh.positions.max(axis=0)
    scale = (goal_high - goal_low) / np.maximum(high - low, 1e-9)
    return goal_low + (moved - low) * scale
