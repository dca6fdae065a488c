"""Fit a skull to a head: landmarks, rays, and no bone outside the skin."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache

import numpy as np
from scipy.spatial import cKDTree

from risorius._check import BoolArray, FloatArray
from risorius.anatomy.outwards import unit
from risorius.anatomy.skull import Skull
from risorius.anatomy.template import SURE_LANDMARKS, builtin_head
from risorius.errors import LandmarkError
from risorius.head.eyes import find_head_lids
from risorius.head.head import Head
from risorius.head.mouth import find_head_lips
from risorius.mesh.core import TriMesh
from risorius.mesh.lids import LidMargins
from risorius.mesh.lips import LipSides
from risorius.mesh.normals import vertex_normals
from risorius.spatial.raycast import Scene
from risorius.warp.rbf import RbfWarp
from risorius.warp.similarity import Similarity, fit_similarity

__all__ = ["MIRROR", "Carry", "FittedSkull", "fit_skull", "hidden_skin"]

MIRROR = np.array([-1.0, 1.0, 1.0])

# Directions (yaw, pitch) [deg] of the extra rays: cranium, temples, cheeks (finding S9).
_RAYS = (
    (0, 60), (0, 30), (30, 60), (-30, 60), (60, 35), (-60, 35), (55, 12), (-55, 12), (125, 20),
    (-125, 20), (180, 10), (180, 45), (120, 60), (-120, 60), (50, -25), (-50, -25), (35, -35),
    (-35, -35), (62, -18), (-62, -18),
)  # fmt: skip
_FEWEST = 8
# Where the rays start, below the eyes of the built-in head [mm].
_RAY_CENTRE = (0.0, -5.0, -65.0)
# Bone is pushed in until it lies this deep: share of its depth in its own head, least, most [mm].
_KEEP, _LEAST, _MOST = 0.9, 3.0, 14.0
_ROUNDS = 5
# Bone farther from the skin than this is left where it is [mm].
_NEAR = 22.0


@dataclass(frozen=True, eq=False)
class Carry:
    """The way from the built-in head's frame to a head; mirror-symmetric if asked for."""

    warp: RbfWarp
    symmetric: bool

    def __call__(self, points: FloatArray) -> FloatArray:
        """Return the images (q, 3) of `points` (q, 3) [mm]."""
        image = self.warp(points)
        if not self.symmetric:
            return image
        return 0.5 * (image + self.warp(points * MIRROR) * MIRROR)


@dataclass(frozen=True, eq=False)
class FittedSkull:
    """A skull inside a head.

    Parameters
    ----------
    cranium, mandible : TriMesh
        In the head's canonical frame.
    scale : float
        Size of the head over that of the built-in one.
    carry : Carry
        From the built-in head's frame to this head; muscles take it.
    """

    cranium: TriMesh
    mandible: TriMesh
    scale: float
    carry: Carry


def fit_skull(skull: Skull, head: Head, *, symmetric: bool, hidden: BoolArray) -> FittedSkull:
    """Carry `skull` into `head`.

    A similarity gives the scale, the sure landmarks and rays in the same directions from inside
    both heads give the warp, and bone that comes too near the skin, or out of it, is pushed in
    along the skin's normals until it lies about as deep as in the built-in head. The rear of the
    head is left alone.

    Parameters
    ----------
    skull : Skull
    head : Head
    symmetric : bool
        Whether the head is mirror-symmetric; then the fit is, too.
    hidden : (n,) bool
        Skin that lies inside: mouth bag, eye sockets.

    Raises
    ------
    LandmarkError
        If head and built-in head share fewer than eight sure landmarks.
    """
    template = builtin_head()
    names = [n for n in SURE_LANDMARKS if n in template.landmarks and n in head.landmarks]
    if len(names) < _FEWEST:
        raise LandmarkError(
            f"landmarks: {len(names)} in common with the built-in head, {_FEWEST} are needed to "
            f"place the skull; add some of {', '.join(SURE_LANDMARKS[:12])}"
        )
    source, target = template.landmarks.positions(names), head.landmarks.positions(names)
    place = fit_similarity(source, target)
    extra = _ray_pairs(template.skin.mesh, head.skin.mesh, place)
    source, target = (np.concatenate(pair) for pair in zip((source, target), extra))
    if symmetric:
        source, target = (np.concatenate([p, p * MIRROR]) for p in (source, target))
        _, first = np.unique(source.round(2), axis=0, return_index=True)
        source, target = source[first], target[first]
    carry = Carry(RbfWarp.fit(source, target, regularisation=1e-9), symmetric)
    foreign = skull.carry is not None
    bones = [
        _pushed_in(bone, carry(bone.positions), head, hidden, place.scale, foreign=foreign)
        for bone in (skull.cranium, skull.mandible)
    ]
    return FittedSkull(bones[0], bones[1], place.scale, carry)


def _ray_pairs(
    source: TriMesh, target: TriMesh, place: Similarity
) -> tuple[FloatArray, FloatArray]:
    """Return where rays from one point inside both heads leave them, where both are hit."""
    yaw, pitch = np.radians(np.array(_RAYS, float)).T
    direction = np.stack(
        [np.sin(yaw) * np.cos(pitch), np.sin(pitch), np.cos(yaw) * np.cos(pitch)], axis=1
    )
    far = np.array(_RAY_CENTRE) + 300.0 * direction
    hits = Scene([source]).cast(far, -direction, max_distance=300.0)
    there = Scene([target]).cast(
        place.apply(far), -direction @ place.rotation.T, max_distance=300.0 * place.scale
    )
    both = hits.hit & there.hit
    return hits.positions[both], there.positions[both]


def _pushed_in(
    bone: TriMesh, points: FloatArray, head: Head, hidden: BoolArray, scale: float, *, foreign: bool
) -> TriMesh:
    own, _, _ = _template_skin().depths(bone.positions)
    # Bone that is shallower in its own head (nose, orbit) has no more to keep than that; a skull
    # that was not made for the built-in head may stick out of it, which is no depth to keep.
    floor = np.full_like(own, _LEAST) if foreign else np.minimum(own, _LEAST)
    least = scale * np.clip(_KEEP * own, floor, _MOST)
    skin = _Skin(head.skin.mesh, hidden)
    for _ in range(_ROUNDS):
        depth, normal, distance = skin.depths(points)
        push = 0.7 * np.maximum(least - depth, 0.0) * (distance < _NEAR * scale)
        points = points - normal * push[:, None]
    return TriMesh(points, bone.faces)


class _Skin:
    def __init__(self, mesh: TriMesh, hidden: BoolArray) -> None:
        used = np.zeros(mesh.vertex_count, bool)
        used[mesh.faces] = True
        self._used = np.flatnonzero(used & ~hidden)
        self._tree = cKDTree(mesh.positions[self._used])
        self._positions = mesh.positions
        self._normals = vertex_normals(mesh.positions, mesh.faces)

    def depths(self, points: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return depth (q,) below the skin, its normal (q, 3) and its distance (q,)."""
        distance, nearest = self._tree.query(points, k=4)
        nearest = self._used[nearest]
        normal = unit(self._normals[nearest].mean(axis=1))
        foot = self._positions[nearest].mean(axis=1)
        depth = np.einsum("qd,qd->q", foot - points, normal)
        return depth, normal, np.asarray(distance)[:, 0]


@cache
def _template_skin() -> _Skin:
    head = builtin_head()
    return _Skin(head.skin.mesh, hidden_skin(find_head_lips(head), find_head_lids(head)))


def hidden_skin(lips: LipSides, margins: Mapping[str, LidMargins]) -> BoolArray:
    """Return the mask (n,) of the skin that lies inside: mouth bag, eye sockets."""
    hidden = lips.inside.copy()
    for margin in margins.values():
        hidden |= margin.slit.inside
    return hidden
