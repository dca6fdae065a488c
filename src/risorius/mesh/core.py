"""The triangle mesh that every computation works on."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from risorius._check import FloatArray, IntArray, as_faces, as_points

__all__ = ["TriMesh"]


@dataclass(frozen=True, eq=False)
class TriMesh:
    """Triangle mesh: positions and counter-clockwise faces seen from outside.

    Parameters
    ----------
    positions : (n, 3) array_like
        Vertex positions; inside the package in the canonical frame [mm].
    faces : (m, 3) array_like of int
        Vertex indices of each triangle.

    Raises
    ------
    ShapeError
        On wrong shapes, non-finite positions or indices out of range.
    """

    positions: FloatArray
    faces: IntArray

    def __post_init__(self) -> None:
        positions = as_points("positions", self.positions)
        faces = as_faces("faces", self.faces, vertex_count=len(positions))
        object.__setattr__(self, "positions", positions)
        object.__setattr__(self, "faces", faces)

    @property
    def vertex_count(self) -> int:
        """Number of vertices."""
        return len(self.positions)

    @property
    def face_count(self) -> int:
        """Number of triangles."""
        return len(self.faces)

    @cached_property
    def size(self) -> float:
        """Diagonal of the axis-aligned bounding box of the used vertices [mm]."""
        if not len(self.faces):
            return 0.0
        used = self.positions[np.unique(self.faces)]
        return float(np.linalg.norm(used.max(axis=0) - used.min(axis=0)))

    def at(self, positions: npt.ArrayLike) -> TriMesh:
        """Return the same topology at other `positions` (n, 3)."""
        return TriMesh(np.asarray(positions, dtype=np.float64), self.faces)
