"""Skin does not fold over itself: where too much of it comes together it gives way around."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_matrix, csr_matrix

from risorius._check import BoolArray, FloatArray, IntArray
from risorius.anatomy.outwards import unit
from risorius.anatomy.skin import Skin

__all__ = ["Unfolding"]

# A face seen from outside keeps at least this share of its area, or its surroundings give way.
_LEAST = 0.15
# Faces that look away from their surroundings at rest already, by this cosine, do not count.
_ALIGNED = 0.35
# Rounds at most; in each, passes over the normals around a face, over where to give way, and
# over the motion that is taken there.
_ROUNDS, _AROUND, _SPREAD, _EASE = 5, 2, 2, 3
_DONE = 0.02


@dataclass(frozen=True, eq=False)
class Unfolding:
    """The shown skin that may fold, bound to a skin of n vertices.

    Parameters
    ----------
    vertices : (k,) int32
        Vertices of the skin; what follows is numbered among them.
    rest : (k, 3) float64
        Their places at rest [mm].
    faces : (f, 3) int32
        Faces between them.
    counts : (f,) bool
        Faces that look the way that their surroundings look at rest.
    out, size : (f, 3) and (f,) float64
        Direction of the surroundings of each face at rest, and the area seen along it [mm^2].
    around : (k, f) csr_matrix
        Sums over the faces of each vertex.
    average : (k, k) csr_matrix
        `Skin.average` among the vertices.
    free : (k,) float64
        How far a vertex may give way: 0 at the rim.
    """

    vertices: IntArray
    rest: FloatArray
    faces: IntArray
    counts: BoolArray
    out: FloatArray
    size: FloatArray
    around: csr_matrix
    average: csr_matrix
    free: FloatArray

    @staticmethod
    def build(skin: Skin) -> Unfolding:
        """Bind the moving skin that can be seen."""
        moving = (skin.mobility > 0.0) & (skin.mass > 1e-9)
        faces = skin.mesh.faces[moving[skin.mesh.faces].all(axis=1)]
        vertices, local = np.unique(faces, return_inverse=True)
        faces = np.ascontiguousarray(local.reshape(-1, 3).astype(np.int32))
        shape = (len(vertices), len(faces))
        entries = (np.ones(faces.size), (faces.ravel(), np.repeat(np.arange(len(faces)), 3)))
        around = csr_matrix(coo_matrix(entries, shape=shape))
        average = csr_matrix(skin.average[vertices][:, vertices])
        rest = np.ascontiguousarray(skin.positions[vertices])
        blank = np.zeros(len(faces))
        whole = Unfolding(
            vertices.astype(np.int32), rest, faces, blank > 0.0, rest, blank, around, average,
            np.zeros(len(vertices)),
        )  # fmt: skip
        cross = whole._crosses(rest)
        out = whole._surroundings(cross)
        size = np.einsum("fd,fd->f", cross, out)
        # Lids turn about the eyeball and have contact of their own.
        shown = ~(skin.hidden | (skin.lids > 0.5))[vertices][faces].any(axis=1)
        counts = shown & (size > _ALIGNED * np.linalg.norm(cross, axis=1))
        free = (1.0 - skin.lids[vertices]) * np.minimum(4.0 * skin.mobility[vertices], 1.0)
        return Unfolding(
            whole.vertices, rest, faces, counts, out, size, around, average, free,
        )  # fmt: skip

    def relieve(self, moved: FloatArray) -> FloatArray:
        """Return the displacement (n, 3) [mm] without the folds of `moved` (n, 3) [mm].

        Where a face is about to turn its back, it and the skin around take the mean motion of
        their neighbours, until nothing folds.
        """
        own = moved[self.vertices]
        eased = own
        for _ in range(_ROUNDS):
            fold = self._folding(self.rest + eased)
            if fold is None:
                break
            give = np.minimum(2.0 * (self.around @ fold), 1.0)
            for _ in range(_SPREAD):
                give = self.average @ give
            give = np.minimum(2.0 * give, 1.0) * self.free
            mean = eased
            for _ in range(_EASE):
                mean = self.average @ mean
            eased = eased + give[:, None] * (mean - eased)
        if eased is own:
            return moved
        result = moved.copy()
        result[self.vertices] = eased
        return result

    def _folding(self, positions: FloatArray) -> FloatArray | None:
        """Return 0 on faces (f,) that keep their area up to 1 on those without; None if all do."""
        cross = self._crosses(positions)
        least = _LEAST * self.size
        # Cheap first: against the surroundings at rest.
        if not ((np.einsum("fd,fd->f", cross, self.out) < least) & self.counts).any():
            return None
        seen = np.einsum("fd,fd->f", cross, self._surroundings(cross))
        fold = np.clip((least - seen) / np.maximum(least, 1e-12), 0.0, 1.0) * self.counts
        return fold if fold.max() > _DONE else None

    def _crosses(self, positions: FloatArray) -> FloatArray:
        first = positions[self.faces[:, 0]]
        a, b = positions[self.faces[:, 1]] - first, positions[self.faces[:, 2]] - first
        result = np.empty_like(a)
        for axis in range(3):
            i, j = (axis + 1) % 3, (axis + 2) % 3
            result[:, axis] = a[:, i] * b[:, j] - a[:, j] * b[:, i]
        return result

    def _surroundings(self, cross: FloatArray) -> FloatArray:
        """Return the mean direction (f, 3) of the faces around each face."""
        normal = self.around @ cross
        for _ in range(_AROUND):
            normal = self.average @ normal
        normal = unit(normal)
        return unit(normal[self.faces].sum(axis=1))
