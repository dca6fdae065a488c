"""Hexahedral muscle meshes: boxes of two layers of vertices, and rings of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from risorius._check import FloatArray, IntArray
from risorius.errors import MeshError
from risorius.layered.faithful.parameters import RingStiffness, SheetStiffness
from risorius.mesh.core import TriMesh
from risorius.solvers.constraints import Bends, Distances, Volume
from risorius.solvers.gradients import volume_value
from risorius.solvers.surface import rest_distances, surface_bends

__all__ = ["MuscleMesh", "box_mesh", "ring_mesh"]


@dataclass(frozen=True, eq=False)
class MuscleMesh:
    """The closed surface of a muscle and its net of distances.

    Vertex ``r w + c`` is at the bottom, ``r w + c + h w`` above it.

    Parameters
    ----------
    rows, columns : int
        h along the fibres of a sheet, or from the inner to the outer line of a ring; w across,
        or around.
    faces : (m, 3) int32
        Outwards.
    pairs : (k, 2) int32
        Vertices that keep their distance.
    pair_stiffness : (k,) float64
    bend, volume : float
        Their stiffness.
    """

    rows: int
    columns: int
    faces: IntArray
    pairs: IntArray
    pair_stiffness: FloatArray
    bend: float
    volume: float

    @property
    def bottom_count(self) -> int:
        """Number of bottom vertices."""
        return self.rows * self.columns

    def outwards(self, positions: FloatArray, *, name: str) -> MuscleMesh:
        """Return the mesh with its faces turned outwards at `positions`.

        Raises
        ------
        MeshError
            If it encloses nothing.
        """
        volume = volume_value(positions, self.faces)
        if not abs(volume) > 0.0:
            raise MeshError(f"muscle {name}: its mesh encloses nothing; check contour, thickness")
        if volume > 0.0:
            return self
        return MuscleMesh(
            self.rows, self.columns, np.ascontiguousarray(self.faces[:, ::-1]), self.pairs,
            self.pair_stiffness, self.bend, self.volume,
        )  # fmt: skip

    def constraints(self, positions: FloatArray) -> tuple[Distances, Bends, Volume]:
        """Return what holds between the vertices, at rest at `positions`."""
        distances = rest_distances(positions, self.pairs, 0.0)
        distances = Distances(distances.particles, distances.rest, self.pair_stiffness)
        bends = surface_bends(TriMesh(positions, self.faces), self.bend)
        rest = volume_value(positions, self.faces)
        return distances, bends, Volume(self.faces, float(rest), self.volume)


def _net(rows: int, columns: int, *, is_ring: bool) -> tuple[IntArray, IntArray]:
    """Return the faces of the closed surface and the quads (k, 4) of the bottom grid."""
    index = np.arange(rows * columns, dtype=np.int32).reshape(rows, columns)
    if is_ring:
        index = np.concatenate([index, index[:, :1]], axis=1)
    n = rows * columns
    quads = np.stack(
        [index[:-1, :-1], index[:-1, 1:], index[1:, 1:], index[1:, :-1]], axis=-1
    ).reshape(-1, 4)
    bottom = np.concatenate([quads[:, [0, 2, 1]], quads[:, [0, 3, 2]]])
    walls = [np.stack([index[0, :-1], index[0, 1:]], axis=1)]
    walls.append(np.stack([index[-1, 1:], index[-1, :-1]], axis=1))
    if not is_ring:
        walls.append(np.stack([index[1:, 0], index[:-1, 0]], axis=1))
        walls.append(np.stack([index[:-1, -1], index[1:, -1]], axis=1))
    a, b = np.concatenate(walls).T
    sides = np.concatenate([np.stack([a, b, b + n], axis=1), np.stack([a, b + n, a + n], axis=1)])
    return np.concatenate([bottom, bottom[:, ::-1] + n, sides]).astype(np.int32), quads


def _joined(
    tables: Sequence[tuple[npt.NDArray[np.integer[Any]], float]],
) -> tuple[IntArray, FloatArray]:
    pairs = np.concatenate([table for table, _ in tables]).astype(np.int32)
    return pairs, np.concatenate([np.full(len(table), k) for table, k in tables])


def box_mesh(rows: int, columns: int, stiffness: SheetStiffness) -> MuscleMesh:
    """Return the mesh of a sheet muscle (spec 2.5, 2.7)."""
    faces, quads = _net(rows, columns, is_ring=False)
    index, n = np.arange(rows * columns).reshape(rows, columns), rows * columns
    across = np.stack([index[:, :-1].ravel(), index[:, 1:].ravel()], axis=1)
    along = np.stack([index[:-1].ravel(), index[1:].ravel()], axis=1)
    rim = np.unique(np.concatenate([index[0], index[-1], index[:, 0], index[:, -1]]))
    pairs, k = _joined(
        [
            (across + n, stiffness.across_upper),
            (along + n, stiffness.along_upper),
            (np.stack([rim, rim + n], axis=1), stiffness.connection),
            (quads[:, [0, 2]], 0.0),
            (quads[:, [1, 3]], 0.0),
        ]
    )
    return MuscleMesh(rows, columns, faces, pairs, k, stiffness.bend, stiffness.volume)


def ring_mesh(rows: int, columns: int, stiffness: RingStiffness) -> MuscleMesh:
    """Return the mesh of a sphincter, its seam welded (spec 2.5, 2.7)."""
    faces, quads = _net(rows, columns, is_ring=True)
    index, n = np.arange(rows * columns).reshape(rows, columns), rows * columns
    across = np.stack([index[:-1].ravel(), index[1:].ravel()], axis=1)
    rim = np.unique(np.concatenate([index[0], index[-1]]))
    shear = np.concatenate([quads[:, [0, 2]], quads[:, [1, 3]]])
    pairs, k = _joined(
        [
            (across + n, stiffness.across_upper),
            (np.stack([rim, rim + n], axis=1), stiffness.connection),
            (shear + n, stiffness.shear_upper),
            (shear, stiffness.shear_lower),
        ]
    )
    return MuscleMesh(rows, columns, faces, pairs, k, stiffness.bend, stiffness.volume)
