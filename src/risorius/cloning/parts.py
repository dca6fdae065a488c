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
from risorius.warp.rbf import RbfWarp
from risorius.warp.similarity import Similarity, fit_similarity

__all__ = ["PartCarrier", "carriers"]

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
    is_rigid: bool
    pivots: FloatArray
    nearest: IntArray
    weights: FloatArray

    def carry(
        self, similarity: Similarity, deltas: FloatArray | None, skin: FloatArray, rest: FloatArray
    ) -> FloatArray:
        """Return the displacement (k, 3) of the target's part [mm].

        Parameters
        ----------
        similarity : Similarity
            From the source's frame to the target's.
        deltas : (j, 3) float64 or None
            Displacement of the source's part [mm].
        skin, rest : (n, 3) float64
            Displacement and rest positions of the target's skin [mm].
        """
        points = self.part.mesh.positions
        if self.origin is None or deltas is None:
            if self.skin is None:
                return np.zeros_like(points)
            if not self.is_rigid:
                return self.skin.displace(skin)
            used = np.unique(self.skin.vertices)
            if not skin[used].any():
                return np.zeros_like(points)
            moved = fit_similarity(rest[used], rest[used] + skin[used], allow_scale=False)
            return moved.apply(points) - points
        if not deltas.any():
            return np.zeros_like(points)
        start = self.origin.mesh.positions
        motion = fit_similarity(start, start + deltas, allow_scale=False)
        pivot, own = self.pivots
        shift = motion.apply(pivot[None])[0] - pivot
        turn = similarity.rotation @ motion.rotation @ similarity.rotation.T
        left = (start + deltas - motion.apply(start)) @ similarity.linear.T
        rigid = (points - own) @ (turn - np.eye(3)).T + similarity.linear @ shift
        return rigid + np.einsum("ks,ksj->kj", self.weights, left[self.nearest])


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
            result[kind] = _on_skin(part, target, is_rigid=False)
            continue
        origin = source.head.part(kind)
        if origin is not None:
            result[kind] = _like(kind, part, origin, _fit_box(origin, part, similarity))
            continue
        other = next((k for k in _INSTEAD.get(kind, ()) if source.head.part(k)), None)
        if other is not None:
            substitute = source.head.parts[other]
            laid = warp(similarity.apply(substitute.mesh.positions))
            result[kind] = _like(kind, part, substitute, laid)
        elif kind in _WITH_CHIN and "2.1" in target.head.landmarks:
            result[kind] = _on_skin(part, target, is_rigid=True)
            notes.append(f"{kind}: the source has none; it moves with the chin")
        elif kind != "other":
            notes.append(f"{kind}: the source has none; it stays at rest")
    return result, notes


def _on_skin(part: Part, target: Subject, *, is_rigid: bool) -> PartCarrier:
    seen = np.flatnonzero(~target.inside).astype(np.int32)
    points = part.mesh.positions
    if is_rigid:
        chin = target.head.landmarks.position("2.1")
        near = np.linalg.norm(target.mesh.positions[seen] - chin, axis=1)
        close = seen[near < _CHIN * target.head.height]
        seen = close if len(close) >= 4 else seen[np.argsort(near)[:12]]
        points = target.mesh.positions[seen]
    follower = follow_skin(points, target.mesh, only=seen)
    none = np.zeros((0, _NEIGHBOURS))
    return PartCarrier(
        part, None, follower, is_rigid, np.zeros((2, 3)), none.astype(np.int32), none
    )


def _like(kind: str, part: Part, origin: Part, laid: FloatArray) -> PartCarrier:
    count = min(_NEIGHBOURS, len(laid))
    distance, nearest = cKDTree(laid).query(part.mesh.positions, k=count)
    distance = np.asarray(distance).reshape(-1, count)
    weights = 1.0 / np.maximum(distance, 1e-9) ** 2
    weights /= weights.sum(axis=1, keepdims=True)
    pivots = np.stack([_pivot(kind, origin), _pivot(kind, part)])
    nearest = np.asarray(nearest, np.int32).reshape(-1, count)
    return PartCarrier(part, origin, None, False, pivots, nearest, weights)


def _pivot(kind: str, part: Part) -> FloatArray:
    points = part.mesh.positions
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
