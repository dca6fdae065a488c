"""What is not linear in a pose: rotations, tissue that keeps its volume."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.sparse import csc_matrix, csr_matrix, diags

from risorius._check import FloatArray, IntArray
from risorius.anatomy.mechanics import Mechanics
from risorius.anatomy.skin import Skin
from risorius.anatomy.swelling import Swelling
from risorius.layered.kernels.turns import best_turns, turn_forces
from risorius.mesh.factorisation import factorise

__all__ = ["Correctives"]

_LENGTH = 5.0
_HOLD_LIDS, _HOLD_STILL = 4.0, 50.0
_ROUNDS = 2
_LEAST_WEIGHT, _MOST_WEIGHT = 0.02, 5.0


@dataclass(frozen=True, eq=False)
class Correctives:
    """Shape of the skin under muscles, beyond the sum of their fields.

    Parameters
    ----------
    skin : Skin
    active : (m,) int32
        Vertices that may move; what follows is numbered among them.
    rest : (m, 3) float64
        Their places at rest [mm].
    starts, columns : (m + 1,) and (e,) int32
        Neighbours of each.
    edge_weight : (e,) float64
        Stiffness of the edges to them.
    hold : (m,) float64
        How strongly each follows the linear field.
    solve : callable
        Solves ``hold u + length^2 L u = right`` for (m, 3) right sides.
    swelling : Swelling
        Of the tissue under the active vertices.
    """

    skin: Skin
    active: IntArray
    rest: FloatArray
    starts: IntArray
    columns: IntArray
    edge_weight: FloatArray
    hold: FloatArray
    solve: Callable[[FloatArray], FloatArray]
    swelling: Swelling

    @staticmethod
    def build(skin: Skin, mechanics: Mechanics) -> Correctives:
        """Prepare the correctives of one head."""
        active = np.flatnonzero((skin.mobility > 0.0) & (skin.mass > 1e-9)).astype(np.int32)
        edges = _positive_edges(csr_matrix(skin.stiff[active][:, active]))
        stiff = diags(np.asarray(edges.sum(axis=1)).ravel()) - edges
        length = _LENGTH * skin.scale
        hold = 1.0 + _HOLD_LIDS * skin.lids + _HOLD_STILL * (1.0 - skin.mobility)
        hold = skin.mass[active] * hold[active]
        matrix = csc_matrix(diags(hold) + length**2 * stiff)
        rest = np.ascontiguousarray(skin.positions[active])
        tissue = Swelling.build(skin, mechanics, active)
        return Correctives(
            skin, active, rest, edges.indptr.astype(np.int32), edges.indices.astype(np.int32),
            length**2 * edges.data, hold, factorise(matrix), tissue,
        )  # fmt: skip

    def shape(self, linear: FloatArray) -> FloatArray:
        """Return the displacement (n, 3) [mm] that the linear one (n, 3) stands for."""
        turned = self._turned(np.ascontiguousarray(linear[self.active]))
        field = linear.copy()
        field[self.active] = turned + self.swelling.out(self.rest + turned)
        return field

    def _turned(self, start: FloatArray) -> FloatArray:
        """Turn the skin locally instead of shearing it.

        Minimises ``sum m h |u - u_lin|^2 + l^2 sum w |(p_i - p_j) - R_i (v_i - v_j)|^2``, with R
        the best rotation of each vertex's edges.
        """
        result = start
        turns = np.zeros((len(start), 3, 3))
        forces = np.zeros_like(start)
        edges = (self.starts, self.columns, self.edge_weight, self.rest)
        for _ in range(_ROUNDS):
            best_turns(*edges, result, turns)
            turn_forces(*edges, turns, forces)
            result = self.solve(self.hold[:, None] * start + forces)
        return result


def _positive_edges(stiff: csr_matrix) -> csr_matrix:
    """Return the weight of every edge (m, m), at least a little.

    Edges of obtuse triangles weigh less than zero in the Laplacian; with them the best rotation
    of a thin vertex star may be a half turn.
    """
    edges = csr_matrix(diags(stiff.diagonal()) - stiff)
    edges.eliminate_zeros()
    edges.data = np.clip(edges.data, _LEAST_WEIGHT, _MOST_WEIGHT)
    return edges
