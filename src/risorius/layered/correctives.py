"""What is not linear in a pose: rotations, tissue that keeps its volume."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.sparse import csc_matrix, csr_matrix, diags

from risorius._check import FloatArray, IntArray
from risorius.anatomy.mechanics import Mechanics
from risorius.layered.kernels.turns import best_turns, turn_forces
from risorius.layered.outwards import unit
from risorius.layered.skin import Skin
from risorius.layered.tissue import swelling_depth
from risorius.mesh.factorisation import factorise
from risorius.mesh.normals import vertex_normals

__all__ = ["Correctives"]

_LENGTH = 5.0
_HOLD_LIDS, _HOLD_STILL = 4.0, 50.0
_ROUNDS = 2
_AREA_PASSES, _NORMAL_PASSES, _SWELL_PASSES = 6, 6, 3
_MOST_IN, _MOST_OUT = -3.0, 7.0


@dataclass(frozen=True, eq=False)
class Correctives:
    """Shape of the skin under muscles, beyond the sum of their fields.

    Parameters
    ----------
    skin : Skin
    active : (m,) int32
        Vertices that may move; what follows is numbered among them.
    starts, columns : (m + 1,) and (e,) int32
        Neighbours of each.
    edge_weight : (e,) float64
        Stiffness of the edges to them.
    hold : (m,) float64
        How strongly each follows the linear field.
    solve : callable
        Solves ``hold u + length^2 L u = right`` for (m, 3) right sides.
    depth : (n,) float64
        Thickness of swelling tissue [built-in mm].
    area : (n,) float64
        Smoothed vertex areas at rest [mm^2].
    """

    skin: Skin
    active: IntArray
    starts: IntArray
    columns: IntArray
    edge_weight: FloatArray
    hold: FloatArray
    solve: Callable[[FloatArray], FloatArray]
    depth: FloatArray
    area: FloatArray

    @staticmethod
    def build(skin: Skin, mechanics: Mechanics) -> Correctives:
        """Prepare the correctives of one head."""
        active = np.flatnonzero((skin.mobility > 0.0) & (skin.mass > 1e-9)).astype(np.int32)
        stiff = csr_matrix(skin.stiff[active][:, active])
        length = _LENGTH * skin.scale
        hold = 1.0 + _HOLD_LIDS * skin.lids + _HOLD_STILL * (1.0 - skin.mobility)
        hold = skin.mass[active] * hold[active]
        matrix = csc_matrix(diags(hold) + length**2 * stiff)
        edges = stiff - diags(stiff.diagonal())
        edges.eliminate_zeros()
        edges = csr_matrix(edges)
        area = _areas(skin, skin.positions)
        return Correctives(
            skin, active, edges.indptr.astype(np.int32), edges.indices.astype(np.int32),
            -(length**2) * edges.data, hold, factorise(matrix),
            swelling_depth(skin, mechanics), skin.smoothed(area, _AREA_PASSES),
        )  # fmt: skip

    def shape(self, linear: FloatArray) -> FloatArray:
        """Return the displacement (n, 3) [mm] that the linear one (n, 3) stands for."""
        skin = self.skin
        moved = self._turned(linear)
        return moved + self._swelling(skin.positions + moved)

    def _turned(self, linear: FloatArray) -> FloatArray:
        """Turn the skin locally instead of shearing it.

        Minimises ``sum m h |u - u_lin|^2 + l^2 sum w |(p_i - p_j) - R_i (v_i - v_j)|^2``, with R
        the best rotation of each vertex's edges.
        """
        start = linear[self.active]
        rest = self.skin.positions[self.active]
        result = start
        turns = np.zeros((len(start), 3, 3))
        forces = np.zeros_like(start)
        edges = (self.starts, self.columns, self.edge_weight, rest)
        for _ in range(_ROUNDS):
            best_turns(*edges, result, turns)
            turn_forces(*edges, turns, forces)
            result = self.solve(self.hold[:, None] * start + forces)
        field = linear.copy()
        field[self.active] = result
        return field

    def _swelling(self, positions: FloatArray) -> FloatArray:
        """Return how tissue that keeps its volume moves out where its area shrinks (n, 3)."""
        skin = self.skin
        ratio = skin.smoothed(_areas(skin, positions), _AREA_PASSES) / np.maximum(self.area, 1e-9)
        ratio = np.where(self.area > 1e-9, np.clip(ratio, 0.5, 1.6), 1.0)
        out = np.clip(self.depth * (1.0 / ratio - 1.0), _MOST_IN, _MOST_OUT) * skin.scale
        out = skin.smoothed(out, _SWELL_PASSES) * skin.mobility
        normals = skin.smoothed(vertex_normals(positions, skin.mesh.faces), _NORMAL_PASSES)
        return out[:, None] * unit(normals)


def _areas(skin: Skin, positions: FloatArray) -> FloatArray:
    corners = positions[skin.mesh.faces]
    cross = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    third = np.repeat(np.sqrt((cross * cross).sum(axis=1)) / 6.0, 3)
    return np.bincount(skin.mesh.faces.ravel(), third, len(positions)).astype(np.float64, copy=False)
