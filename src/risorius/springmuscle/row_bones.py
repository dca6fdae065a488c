"""Which bone each row of a grid hangs on."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import dijkstra

from risorius._check import FloatArray, IntArray
from risorius.springmuscle.bones import SkinBones
from risorius.springmuscle.grid import Patch
from risorius.springmuscle.muscle import JAW, SKULL
from risorius.springmuscle.surface import SkinSurface

__all__ = ["GrownBones", "grow_bones", "row_bones"]


@dataclass(frozen=True, eq=False)
class GrownBones:
    """Bone of every skin vertex, or of the attached vertex that is the fewest edges away.

    Parameters
    ----------
    bones : (n,) int8
        0 where no attached vertex can be reached.
    """

    bones: npt.NDArray[np.int8]


def grow_bones(surface: SkinSurface, skin_bones: SkinBones) -> GrownBones:
    """Grow the attachment over skin without bone, never from one lip to the other.

    The published rule grows the one-ring of a vertex until it meets an attached one; here all are
    grown at once.
    """
    attached = np.flatnonzero(skin_bones.bones > 0)
    count = len(skin_bones.bones)
    if not len(attached):
        return GrownBones(np.zeros(count, np.int8))
    near = surface.neighbours
    start = np.repeat(np.arange(count), np.diff(near.indptr))
    same = surface.sides[start] * surface.sides[near.indices] >= 0
    graph = coo_matrix(
        (np.ones(int(same.sum())), (start[same], near.indices[same])), shape=(count, count)
    ).tocsr()
    _, _, sources = dijkstra(
        graph, indices=attached, unweighted=True, min_only=True, return_predecessors=True
    )
    bones = np.where(sources >= 0, skin_bones.bones[np.maximum(sources, 0)], 0)
    return GrownBones(bones.astype(np.int8))


def row_bones(
    points: FloatArray,
    normals: FloatArray,
    patch: Patch,
    surface: SkinSurface,
    grown: GrownBones,
    *,
    closed: bool,
    mirror: bool,
) -> npt.NDArray[np.int8]:
    """Return the bone (r,) of every row of a grid (r, c, 3): `SKULL` or `JAW`.

    A ray from each point through the skin names the nearest corner of the triangle it meets, that
    names a bone, and the majority of the row decides; a tie or no vote takes the nearest rows that
    have one, and in the end the skull (Kaehler et al. 2001, section 5.4). With `mirror`, rows vote
    together with their mirror images.
    """
    balance = _votes(points, normals, patch, surface, grown)
    if mirror:
        middle = points.mean(axis=1)
        apart = np.linalg.norm(middle[:, None] - middle[None] * [-1.0, 1.0, 1.0], axis=2)
        balance = balance + balance[apart.argmin(axis=1)]
    if closed:
        balance[0] = balance[-1] = balance[0] + balance[-1]
    decided = np.flatnonzero(balance)
    rows = len(points)
    if not len(decided):
        return np.full(rows, SKULL, np.int8)
    apart = np.abs(np.arange(rows)[:, None] - decided[None])
    if closed:
        apart = np.minimum(apart, rows - 1 - apart)
    nearest = apart == apart.min(axis=1, keepdims=True)
    chosen = (nearest * np.sign(balance[decided])).sum(axis=1)
    return np.where(chosen > 0, JAW, SKULL).astype(np.int8)


def _votes(
    points: FloatArray,
    normals: FloatArray,
    patch: Patch,
    surface: SkinSurface,
    grown: GrownBones,
) -> IntArray:
    """Return by how many points (r,) of each row the jaw leads."""
    rows, columns = points.shape[:2]
    distance, hit = patch.cast(points.reshape(-1, 3), normals.reshape(-1, 3))
    met = hit >= 0
    places = points.reshape(-1, 3)[met] + distance[met, None] * normals.reshape(-1, 3)[met]
    corner = ((patch.corners[hit[met]] - places[:, None]) ** 2).sum(axis=2).argmin(axis=1)
    vertices = surface.mesh.faces[patch.faces[hit[met]], corner]
    votes = np.zeros(rows * columns, np.int8)
    votes[met] = grown.bones[vertices]
    votes = votes.reshape(rows, columns)
    return ((votes == JAW).sum(axis=1) - (votes == SKULL).sum(axis=1)).astype(np.int32)
