"""Soft tissue keeps its volume: it swells out where skin is pushed together."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_matrix, csr_matrix

from risorius._check import FloatArray, IntArray
from risorius.anatomy.mechanics import Mechanics
from risorius.anatomy.outwards import unit
from risorius.anatomy.skin import Skin
from risorius.anatomy.tissue import swelling_depth
from risorius.mesh.connectivity import edges

__all__ = ["Swelling"]

# Passes over the areas; together with those over the swelling they reach equally far on every
# mesh: so many on a head whose edges round the mouth are so long [mm].
_PASSES = 6
_REFERENCE_PASSES, _REFERENCE_EDGE, _MOST_PASSES = 9.0, 3.75, 30
_NEAR, _FAR = 18.0, 45.0
_MOST_IN, _MOST_OUT = -3.0, 7.0


@dataclass(frozen=True, eq=False)
class Swelling:
    """Tissue under m vertices of a skin.

    Parameters
    ----------
    faces : (f, 3) int32
        Faces between these vertices, numbered among them.
    around : (m, f) csr_matrix
        Sums over the faces of each vertex.
    average : (m, m) csr_matrix
        `Skin.average` among them.
    depth : (m,) float64
        Thickness of swelling tissue [mm], faded where skin does not move.
    area : (m,) float64
        Smoothed vertex areas at rest [mm^2].
    fade : (m,) float64
        0 at the rim of the skin that moves, 1 inside.
    scale : float
        Size of the head over that of the built-in one.
    passes : int
        How often the swelling is averaged with its neighbours.
    """

    faces: IntArray
    around: csr_matrix
    average: csr_matrix
    depth: FloatArray
    area: FloatArray
    fade: FloatArray
    scale: float
    passes: int

    @staticmethod
    def build(skin: Skin, mechanics: Mechanics, active: IntArray) -> Swelling:
        """Measure the tissue under the vertices `active` (m,)."""
        faces = _faces_between(skin, active)
        entries = (np.ones(faces.size), (faces.ravel(), np.repeat(np.arange(len(faces)), 3)))
        around = csr_matrix(coo_matrix(entries, shape=(len(active), len(faces))))
        average = csr_matrix(skin.average[active][:, active])
        depth = (swelling_depth(skin, mechanics) * skin.mobility * skin.scale)[active]
        crosses = _crosses(np.ascontiguousarray(skin.positions[active]), faces)
        area = around @ np.linalg.norm(crosses, axis=1)
        for _ in range(_PASSES):
            area = average @ area
        fade = np.minimum(4.0 * skin.mobility[active], 1.0)
        return Swelling(faces, around, average, depth, area, fade, skin.scale, _passes(skin))

    def out(self, positions: FloatArray) -> FloatArray:
        """Return how tissue moves out (m, 3) where the skin at `positions` (m, 3) shrank [mm]."""
        cross = _crosses(positions, self.faces)
        size = np.sqrt((cross * cross).sum(axis=1))
        sums = self.around @ np.column_stack([cross, size])
        for _ in range(_PASSES):
            sums = self.average @ sums
        ratio = np.clip(sums[:, 3] / np.maximum(self.area, 1e-9), 0.5, 1.6)
        ratio[self.area <= 1e-9] = 1.0
        most_in, most_out = _MOST_IN * self.scale, _MOST_OUT * self.scale
        out = np.clip(self.depth * (1.0 / ratio - 1.0), most_in, most_out)
        for _ in range(self.passes):
            out = self.average @ out
        return (out * self.fade)[:, None] * unit(sums[:, :3])


def _passes(skin: Skin) -> int:
    """Return the passes over the swelling that reach as far as on other meshes."""
    near = (skin.mouth.distance > _NEAR) & (skin.mouth.distance < _FAR) & ~skin.hidden
    pairs = edges(skin.mesh.faces)
    pairs = pairs[near[pairs].all(axis=1)]
    if not len(pairs):
        return 3
    length = np.linalg.norm(skin.positions[pairs[:, 0]] - skin.positions[pairs[:, 1]], axis=1)
    finer = _REFERENCE_EDGE * skin.scale / max(float(np.median(length)), 1e-9)
    return int(np.clip(round(_REFERENCE_PASSES * finer**2) - _PASSES, 3, _MOST_PASSES))


def _faces_between(skin: Skin, active: IntArray) -> IntArray:
    """Return the faces (f, 3) whose corners are all active, numbered among these."""
    local = np.full(len(skin.positions), -1, np.int32)
    local[active] = np.arange(len(active))
    faces = skin.mesh.faces
    if skin.partner is not None:
        # Together with the mirror image of the triangulation, so that sides are cut alike.
        faces = np.concatenate([faces, skin.partner[faces[:, ::-1]]])
    faces = local[faces]
    return np.ascontiguousarray(faces[(faces >= 0).all(axis=1)])


def _crosses(positions: FloatArray, faces: IntArray) -> FloatArray:
    """Return a sixth of the cross product of two sides (f, 3): a third of each face's area."""
    first, second, third = (positions[faces[:, corner]] for corner in range(3))
    a, b = second - first, third - first
    result = np.empty_like(a)
    for axis in range(3):
        i, j = (axis + 1) % 3, (axis + 2) % 3
        result[:, axis] = (a[:, i] * b[:, j] - a[:, j] * b[:, i]) / 6.0
    return result
