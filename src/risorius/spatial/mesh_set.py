"""Several meshes seen as one, for ray casting and closest points."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import cached_property

import numpy as np
import numpy.typing as npt

from risorius._check import BoolArray, FloatArray, IntArray
from risorius.errors import MeshError, ParameterError, ShapeError
from risorius.mesh.core import TriMesh
from risorius.mesh.normals import face_normals

__all__ = ["MeshSet"]


class MeshSet:
    """Meshes under one roof: queries run over all of their faces at once.

    Faces are numbered through all meshes in order; answers are given as mesh and face of that
    mesh. A scene is a snapshot: build a new one when a mesh has moved.

    Parameters
    ----------
    meshes : sequence of TriMesh
        At least one face in all.

    Raises
    ------
    MeshError
        If there is no face.
    """

    def __init__(self, meshes: Sequence[TriMesh]) -> None:
        self.meshes = tuple(meshes)
        counts = [mesh.face_count for mesh in self.meshes]
        if not sum(counts):
            raise MeshError("meshes: they have no face; give at least one triangle")
        starts = np.cumsum([0, *(mesh.vertex_count for mesh in self.meshes)])
        self.positions: FloatArray = np.concatenate([mesh.positions for mesh in self.meshes])
        self.faces: IntArray = np.concatenate(
            [mesh.faces + start for mesh, start in zip(self.meshes, starts[:-1])]
        ).astype(np.int32)
        self.mesh_of_face: IntArray = np.repeat(np.arange(len(counts), dtype=np.int32), counts)
        self._first_face = np.cumsum([0, *counts[:-1]])

    @staticmethod
    def of(surface: TriMesh | MeshSet) -> MeshSet:
        """Return `surface` as a mesh set."""
        return surface if isinstance(surface, MeshSet) else MeshSet([surface])

    @property
    def face_count(self) -> int:
        """Number of faces of all meshes."""
        return len(self.faces)

    @cached_property
    def corners(self) -> FloatArray:
        """(f, 3, 3) corner positions of all faces [mm]."""
        return self.positions[self.faces]

    @cached_property
    def face_normals(self) -> FloatArray:
        """(f, 3) unit normals of all faces."""
        return face_normals(self.positions, self.faces)

    @cached_property
    def bounds(self) -> tuple[FloatArray, float]:
        """Middle (3,) of the bounding box of all faces and its diagonal [mm]."""
        low = self.corners.min(axis=(0, 1))
        high = self.corners.max(axis=(0, 1))
        return 0.5 * (low + high), float(np.linalg.norm(high - low))

    def mask_of(self, meshes: Iterable[int]) -> BoolArray:
        """Return the mask (f,) of all faces of some `meshes`, for `face_mask` of a query."""
        chosen = list(meshes)
        for mesh in chosen:
            if not 0 <= mesh < len(self.meshes):
                raise ParameterError(f"meshes: {mesh} is not in 0..{len(self.meshes) - 1}")
        return np.isin(self.mesh_of_face, chosen)

    def local_faces(self, faces: IntArray) -> IntArray:
        """Return the number (k,) within its own mesh of each of some `faces` (k,) of all."""
        return (faces - self._first_face[self.mesh_of_face[faces]]).astype(np.int32)

    def chosen_faces(self, face_mask: npt.ArrayLike | None) -> IntArray | None:
        """Return the faces (k,) that a mask (f,) leaves, None for all of them."""
        if face_mask is None:
            return None
        mask = np.asarray(face_mask)
        if mask.dtype != bool or mask.shape != (self.face_count,):
            raise ShapeError(
                f"face_mask: expected ({self.face_count},) bool, one entry per face of all "
                f"meshes, got {mask.shape} {mask.dtype}"
            )
        return np.flatnonzero(mask).astype(np.int32)
