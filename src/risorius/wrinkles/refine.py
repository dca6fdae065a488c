"""A patch of skin, cut into triangles that are finer than its wrinkles."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from risorius._check import BoolArray, FloatArray, IntArray
from risorius.mesh.connectivity import edges
from risorius.mesh.core import TriMesh

__all__ = ["Patch", "refine"]

# Halvings of the edges, at most: a triangle becomes 256.
_MOST_LEVELS = 4


@dataclass(frozen=True, eq=False)
class Patch:
    """Some triangles of a mesh, each cut into 4^k equal ones.

    Parameters
    ----------
    mesh : TriMesh
        The fine triangles [mm].
    parents : (v, 3) int32
        Vertices of the coarse mesh that each fine vertex lies between.
    shares : (v, 3) float64
        Its barycentric coordinates among them [1].
    coarse_face : (m,) int32
        Face of the coarse mesh that each fine face lies in.
    corner_shares : (m, 3, 3) float64
        Barycentric coordinates of the corners of each fine face in that face [1].
    """

    mesh: TriMesh
    parents: IntArray
    shares: FloatArray
    coarse_face: IntArray
    corner_shares: FloatArray

    def carry(self, values: FloatArray) -> FloatArray:
        """Return values (n, ...) of the coarse vertices at the fine ones (v, ...)."""
        return np.einsum("vk,vk...->v...", self.shares, values[self.parents])


def refine(mesh: TriMesh, chosen: BoolArray, length: float) -> Patch:
    """Cut the chosen faces until their mean edge is no longer than `length`.

    Parameters
    ----------
    mesh : TriMesh
    chosen : (m,) bool
        Faces of the patch, at least one.
    length : float
        Of an edge [mm].
    """
    rows = np.flatnonzero(chosen).astype(np.int32)
    faces = mesh.faces[rows]
    pairs = edges(faces)
    mean = float(np.linalg.norm(np.subtract(*mesh.positions[pairs.T]), axis=1).mean())
    levels = int(np.clip(np.ceil(np.log2(max(mean / length, 1.0))), 0, _MOST_LEVELS))
    shares = np.broadcast_to(np.eye(3), (len(faces), 3, 3)).copy()
    used, local = np.unique(faces, return_inverse=True)
    local = local.reshape(-1, 3).astype(np.int32)
    # A fine vertex is a mixture of coarse ones, kept as a dense row over at most three.
    parents = np.stack([used, used, used], axis=1)
    weights = np.tile([1.0, 0.0, 0.0], (len(used), 1))
    owner = np.arange(len(faces), dtype=np.int32)
    for _ in range(levels):
        local, owner, shares, count = _halved(local, owner, shares, len(weights))
        parents, weights = _placed(faces, local, owner, shares, count)
    placed = np.einsum("vk,vkd->vd", weights, mesh.positions[parents])
    return Patch(TriMesh(placed, local), parents.astype(np.int32), weights, rows[owner], shares)


def _halved(
    faces: IntArray, owner: IntArray, shares: FloatArray, count: int
) -> tuple[IntArray, IntArray, FloatArray, int]:
    """Cut every face into four at the middles of its edges."""
    sides = np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1)
    distinct, place = np.unique(sides, axis=0, return_inverse=True)
    first, second, third = (place.reshape(3, -1) + count).astype(np.int32)
    a, b, c = faces.T
    finer = np.concatenate(
        [
            np.stack([a, first, third], axis=1),
            np.stack([b, second, first], axis=1),
            np.stack([c, third, second], axis=1),
            np.stack([first, second, third], axis=1),
        ]
    )
    sa, sb, sc = shares[:, 0], shares[:, 1], shares[:, 2]
    sab, sbc, sca = 0.5 * (sa + sb), 0.5 * (sb + sc), 0.5 * (sc + sa)
    cut = np.concatenate(
        [
            np.stack([sa, sab, sca], axis=1),
            np.stack([sb, sbc, sab], axis=1),
            np.stack([sc, sca, sbc], axis=1),
            np.stack([sab, sbc, sca], axis=1),
        ]
    )
    return finer, np.tile(owner, 4), cut, count + len(distinct)


def _placed(
    coarse: IntArray, faces: IntArray, owner: IntArray, shares: FloatArray, count: int
) -> tuple[IntArray, FloatArray]:
    """Return parents (v, 3) and shares (v, 3) of the vertices, from one face around each."""
    parents = np.zeros((count, 3), np.int32)
    weights = np.zeros((count, 3))
    for corner in range(3):
        parents[faces[:, corner]] = coarse[owner]
        weights[faces[:, corner]] = shares[:, corner]
    return parents, weights
