"""How muscles that hold the mouth corner see the lips."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_matrix

from risorius._check import FloatArray, IntArray
from risorius.anatomy.smooth_step import smooth_step
from risorius.mesh.lips import LipSides

__all__ = ["LipHold"]

# How often an effect is averaged in the mouth corner.
_CALM_PASSES = 10


@dataclass(frozen=True, eq=False)
class LipHold:
    """Body of the lips and calm of the mouth corner, computed once for a skin of n vertices.

    Parameters
    ----------
    body : (n,) float64
        How far a vertex belongs to the body of the lips: 1 in their middle.
    corner : (k,) int32
        Vertices near a mouth corner.
    near : (k,) float64
        How far an effect is averaged there.
    averaged : (k, n) csr_matrix
        The average over the neighbours, taken ten times.
    """

    body: FloatArray
    corner: IntArray
    near: FloatArray
    averaged: csr_matrix

    @staticmethod
    def of(lips: LipSides, positions: FloatArray, averaging: csr_matrix) -> LipHold:
        """Return the hold of a mouth.

        Parameters
        ----------
        lips : LipSides
        positions : (n, 3) float64
            Skin at rest [mm].
        averaging : (n, n) csr_matrix
            Averages a field over the neighbours of each vertex.
        """
        corners = positions[list(lips.slit.corners)]
        middle, half = corners[:, 0].mean(), 0.5 * lips.width
        beside = np.abs(positions[:, 0] - middle) / half
        close = smooth_step(1.0 - (lips.distance - 0.25 * lips.width) / (0.5 * lips.width))
        body = close * smooth_step((1.0 - beside) / 0.7)
        near = smooth_step(1.0 - lips.to_corner / (0.4 * lips.width))
        corner = np.flatnonzero(near > 0.0).astype(np.int32)
        averaged = averaging[corner]
        for _ in range(_CALM_PASSES - 1):
            averaged = averaged @ averaging
        return LipHold(body, corner, near[corner], averaged.tocsr())

    def calmed(self, effect: FloatArray) -> FloatArray:
        """Return an effect (n,) averaged with its neighbours in the mouth corners.

        Lining and skin meet there in small triangles, which would fold where one lags.
        """
        result = effect.copy()
        here = effect[self.corner]
        result[self.corner] = here + self.near * (self.averaged @ effect - here)
        return result
