"""Smooth fields on a neighbourhood of the skin, zero beyond it."""

from __future__ import annotations

import numpy as np

from risorius._check import BoolArray, FloatArray, IntArray
from risorius.mesh.core import TriMesh
from risorius.mesh.laplacian import SmoothField

__all__ = ["LocalField"]

_STIFF = 60.0


class LocalField:
    """Spreads values from `lines` over the skin around them; see `SmoothField`.

    Parameters
    ----------
    mesh : TriMesh
    near : (n,) bool
        Where the field may differ from zero.
    lines : sequence of (k,) int32
        Vertices that follow their values.
    length, bend : float
        Of `SmoothField` [mm].
    """

    def __init__(
        self, mesh: TriMesh, near: BoolArray, lines: tuple[IntArray, ...], *, length: float,
        bend: float,
    ) -> None:  # fmt: skip
        inner = near.copy()
        for line in lines:
            inner[line] = True
        faces = mesh.faces[inner[mesh.faces].any(axis=1)]
        self.vertices = np.unique(faces).astype(np.int32)
        row = np.zeros(mesh.vertex_count, np.int32)
        row[self.vertices] = np.arange(len(self.vertices))
        self._rim = ~inner[self.vertices]
        stiffness = np.where(self._rim, _STIFF, 0.0)
        for line in lines:
            stiffness[row[line]] = _STIFF
        local = TriMesh(mesh.positions[self.vertices], row[faces])
        self._field = SmoothField(local, stiffness, length=length, bend=bend)

    def solve(self, values: FloatArray) -> FloatArray:
        """Return the field (k, d) at `vertices` for `values` (n, d) of the whole skin."""
        result = self._field.solve(values[self.vertices])
        result[self._rim] = 0.0
        return result
