"""A part of a head: its own compact, welded triangle mesh and the way back to the input."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from risorius._check import FloatArray, IntArray
from risorius.mesh.core import TriMesh

__all__ = ["PART_KINDS", "Part"]

PART_KINDS = (
    "skin",
    "eye_left",
    "eye_right",
    "teeth_upper",
    "teeth_lower",
    "gums",
    "tongue",
    "mouth_inside",
    "lashes_left",
    "lashes_right",
    "attached",
    "other",
)
"""Every part a head may have.

`attached` (brows, beard, tear lines) moves with the skin beneath, `other` with the skull.
"""


@dataclass(frozen=True, eq=False)
class Part:
    """One part of a head.

    Parameters
    ----------
    kind : str
        One of `PART_KINDS`.
    mesh : TriMesh
        Compact mesh in the canonical frame [mm]; coincident seam vertices are welded.
    source : (k,) int32
        Input vertices that belong to the part.
    welded : (k,) int32
        Vertex of `mesh` for each of them.
    """

    kind: str
    mesh: TriMesh
    source: IntArray
    welded: IntArray

    @property
    def vertex_count(self) -> int:
        """Number of vertices of the welded mesh."""
        return self.mesh.vertex_count

    def first_source(self) -> IntArray:
        """Return one input vertex (w,) for each welded vertex."""
        first = np.zeros(self.mesh.vertex_count, np.int32)
        first[self.welded[::-1]] = self.source[::-1]
        return first

    def from_source(self, vertices: npt.ArrayLike, *, vertex_count: int) -> IntArray:
        """Return the welded vertex (k,) of input `vertices` (k,), -1 where not in this part."""
        table = np.full(vertex_count, -1, np.int32)
        table[self.source] = self.welded
        return table[np.asarray(vertices)]

    def spread(self, values: npt.ArrayLike, out: FloatArray) -> None:
        """Write per-vertex `values` (w, ...) of the part into the rows of `out` (n, ...)."""
        out[self.source] = np.asarray(values)[self.welded]
