"""Points on a surface that follow it when it deforms."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from risorius._check import FloatArray, IntArray
from risorius.errors import ParameterError, ShapeError
from risorius.mesh.core import TriMesh
from risorius.mesh.normals import vertex_normals

__all__ = ["SurfacePoints"]

# Barycentric coordinates may miss the sum 1 by rounding only.
_SUM_TOLERANCE = 1e-6


@dataclass(frozen=True, eq=False)
class SurfacePoints:
    """Points bound to triangles: position = sum_k bary_k p_k of the face's corners.

    Parameters
    ----------
    faces : (k,) int32
        Face of each point.
    bary : (k, 3) float64
        Barycentric coordinates, each row sums to 1.
    surfaces : (k,) int32, optional
        Which of several meshes each point lies on; 0 for all if left out.

    Raises
    ------
    ShapeError
        On shapes that do not agree.
    ParameterError
        If a row of `bary` is not finite or does not sum to 1, or a face index is negative.

    References
    ----------
    Fratarcangeli 2008, section 4.1 (the document forgets to renormalise the normal).
    """

    faces: IntArray
    bary: FloatArray
    surfaces: IntArray = field(default_factory=lambda: np.zeros(0, np.int32))

    def __post_init__(self) -> None:
        faces = np.ascontiguousarray(self.faces, dtype=np.int32)
        bary = np.ascontiguousarray(self.bary, dtype=np.float64)
        surfaces = np.ascontiguousarray(self.surfaces, dtype=np.int32)
        k = len(faces)
        if faces.shape != (k,) or bary.shape != (k, 3):
            raise ShapeError(
                f"bary: expected shape ({k}, 3) for {k} faces, got {bary.shape} and {faces.shape}"
            )
        if len(surfaces) == 0:
            surfaces = np.zeros(k, np.int32)
        if surfaces.shape != (k,):
            raise ShapeError(f"surfaces: expected shape ({k},), got {surfaces.shape}")
        if (faces < 0).any():
            row = int(np.argmax(faces < 0))
            raise ParameterError(f"faces: point {row} has face {int(faces[row])}; it hit nothing")
        good = np.abs(bary.sum(axis=1) - 1.0) <= _SUM_TOLERANCE
        if not good.all():
            row = int(np.argmin(good))
            raise ParameterError(f"bary: row {row} is {bary[row].tolist()}, its sum must be 1")
        object.__setattr__(self, "faces", faces)
        object.__setattr__(self, "bary", bary)
        object.__setattr__(self, "surfaces", surfaces)

    def __len__(self) -> int:
        return len(self.faces)

    def take(self, rows: npt.ArrayLike) -> SurfacePoints:
        """Return the points of some `rows`: indices (q,) or a mask (k,)."""
        chosen = np.asarray(rows)
        return SurfacePoints(self.faces[chosen], self.bary[chosen], self.surfaces[chosen])

    def interpolate(self, values: npt.ArrayLike, faces: IntArray) -> FloatArray:
        """Return vertex `values` (n,) or (n, d) of the mesh with `faces` at the points.

        Returns
        -------
        (k,) or (k, d) float64
        """
        corners = np.asarray(values, dtype=np.float64)[faces[self.faces]]
        return np.einsum("kc,kc...->k...", self.bary, corners)

    def positions(self, mesh: TriMesh) -> FloatArray:
        """Return the positions (k, 3) on `mesh` in its present shape [mm]."""
        return self.interpolate(mesh.positions, mesh.faces)

    def normals(self, mesh: TriMesh, normals: FloatArray | None = None) -> FloatArray:
        """Return the unit normals (k, 3), interpolated between vertex normals.

        Parameters
        ----------
        mesh : TriMesh
        normals : (n, 3) float64, optional
            Vertex normals of the mesh, computed if left out.

        Notes
        -----
        Zero where the vertex normals cancel or the face has none.
        """
        if normals is None:
            normals = vertex_normals(mesh.positions, mesh.faces)
        blend = self.interpolate(normals, mesh.faces)
        length = np.linalg.norm(blend, axis=1, keepdims=True)
        return blend / np.where(length > 0.0, length, 1.0)

    @staticmethod
    def from_vertices(
        vertices: npt.ArrayLike, faces: IntArray, *, surface: int = 0
    ) -> SurfacePoints:
        """Return points that sit on `vertices` (k,), each in its first face.

        Raises
        ------
        ParameterError
            If a vertex belongs to no face.
        """
        wanted = np.atleast_1d(np.asarray(vertices, dtype=np.int64))
        count = int(max(faces.max(initial=-1), wanted.max(initial=-1))) + 1
        corner_of = np.full(count, -1, np.int64)
        flat = faces.ravel()
        corner_of[flat[::-1]] = np.arange(len(flat))[::-1]
        corner = corner_of[wanted]
        if (corner < 0).any():
            vertex = int(wanted[np.argmax(corner < 0)])
            raise ParameterError(
                f"vertices: vertex {vertex} belongs to no face; a surface point needs one"
            )
        bary = np.zeros((len(wanted), 3))
        bary[np.arange(len(wanted)), corner % 3] = 1.0
        return SurfacePoints(
            (corner // 3).astype(np.int32), bary, np.full(len(wanted), surface, np.int32)
        )
