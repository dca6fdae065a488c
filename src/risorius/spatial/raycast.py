"""Cast rays at several meshes; find what can be seen."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
import numpy.typing as npt
from embreex.mesh_construction import TriangleMesh
from embreex.rtcore_scene import EmbreeScene

from risorius._check import BoolArray, FloatArray, IntArray, as_points, one_of
from risorius.errors import ParameterError, ShapeError
from risorius.mesh.core import TriMesh
from risorius.mesh.surface_point import SurfacePoints
from risorius.spatial.mesh_set import MeshSet
from risorius.spatial.triangles import line_bary

__all__ = ["Cull", "RayHits", "Scene"]

Cull = Literal["nothing", "back", "front"]
# The tree works in single precision on a scene scaled to size 1; this covers its error.
_PRECISION = 2e-6
# Single and double precision may disagree by this much on barycentric coordinates.
_ROUGH = 1e-2
# Trees of this many face masks are kept.
_KEPT_TREES = 8


@dataclass(frozen=True, eq=False)
class RayHits:
    """The nearest hit of every ray.

    Parameters
    ----------
    distance : (q,) float64
        Along the ray, negative behind its origin, inf on a miss [mm].
    mesh, face : (q,) int32
        Mesh of the scene and face of that mesh; -1 on a miss.
    bary : (q, 3) float64
        Barycentric coordinates on that face; NaN on a miss.
    positions : (q, 3) float64
        Hit points; NaN on a miss [mm].
    normals : (q, 3) float64
        Unit normals of the faces, as the faces wind; NaN on a miss.
    """

    distance: FloatArray
    mesh: IntArray
    face: IntArray
    bary: FloatArray
    positions: FloatArray
    normals: FloatArray

    @property
    def hit(self) -> BoolArray:
        """(q,) mask of the rays that hit something."""
        return self.face >= 0

    def surface_points(self) -> SurfacePoints:
        """Return the hits as surface points, (k,) in the order of the rays that hit."""
        rows = self.hit
        return SurfacePoints(self.face[rows], self.bary[rows], self.mesh[rows])


class Scene(MeshSet):
    """Meshes that rays are cast at.

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

    Notes
    -----
    Candidates come from a watertight single precision tree (Embree in its robust mode): a ray
    from inside a closed mesh always hits, also through edges and corners. Faces, barycentric
    coordinates and positions are then computed in double precision. Surfaces closer together
    than about 1e-6 of the scene's size may be taken for each other.
    """

    def __init__(self, meshes: Sequence[TriMesh]) -> None:
        super().__init__(meshes)
        self._trees: dict[bytes, EmbreeScene] = {}

    def cast(
        self,
        origins: npt.ArrayLike,
        directions: npt.ArrayLike,
        *,
        max_distance: float = np.inf,
        both_directions: bool = False,
        face_mask: npt.ArrayLike | None = None,
        cull: Cull = "nothing",
    ) -> RayHits:
        """Return the nearest hit of every ray.

        Parameters
        ----------
        origins : (q, 3) array_like
            Where the rays start [mm].
        directions : (q, 3) or (3,) array_like
            Where they go; any length but zero.
        max_distance : float
            Hits beyond it are misses [mm].
        both_directions : bool
            Also look backwards; the nearer hit counts, on a tie the one ahead.
        face_mask : (f,) bool, optional
            Faces that count, numbered through all meshes; see `mask_of`.
        cull : {"nothing", "back", "front"}
            Pass through faces seen from behind, or from the front.

        Raises
        ------
        ParameterError
            If a direction is zero or `max_distance` is negative.
        """
        start = as_points("origins", origins)
        ahead = _as_directions(directions, len(start))
        one_of("cull", cull, ("nothing", "back", "front"))
        if not max_distance >= 0.0:
            raise ParameterError(f"max_distance: {max_distance} must be at least 0")
        chosen = self.chosen_faces(face_mask)
        nearest = self._nearest(start, ahead, max_distance, chosen, cull)
        if both_directions:
            back = self._nearest(start, -ahead, max_distance, chosen, cull)
            rows = np.flatnonzero(back.distance < nearest.distance)
            nearest.put(rows, back.face[rows], -back.distance[rows], back.bary[rows])
        return self._hits(nearest)

    def _nearest(
        self,
        origins: FloatArray,
        directions: FloatArray,
        max_distance: float,
        chosen: IntArray | None,
        cull: Cull,
    ) -> _Nearest:
        nearest = _Nearest.misses(len(origins))
        if chosen is not None and not len(chosen):
            return nearest
        middle, size = self.bounds
        # Far origins lose digits in single precision: begin just outside the scene.
        passed = np.maximum(np.einsum("ij,ij->i", middle - origins, directions) - size, 0.0)
        step = np.full(len(origins), _PRECISION * size)
        rows = np.flatnonzero(passed <= max_distance)
        while len(rows):
            begin = origins[rows] + passed[rows, None] * directions[rows]
            found, rough = self._first_faces(begin, directions[rows], chosen)
            struck = found >= 0
            rows, found, rough = rows[struck], found[struck], rough[struck]
            corners = self.corners[found]
            bary = _refined(origins[rows], directions[rows], corners, rough)
            positions = np.einsum("kc,kcj->kj", bary, corners)
            length = np.einsum("ij,ij->i", positions - origins[rows], directions[rows])
            skip = self._is_culled(directions[rows], found, cull) | (
                length < passed[rows] - step[rows]
            )
            keep = ~skip & (length <= max_distance)
            nearest.put(rows[keep], found[keep], np.maximum(length[keep], 0.0), bary[keep])
            # No headway means that rounding found the same place again: step further each time.
            step[rows] = np.where(length <= passed[rows], 2.0 * step[rows], step[rows])
            passed[rows] = np.maximum(length, passed[rows]) + step[rows]
            rows = rows[skip & (passed[rows] <= max_distance)]
        return nearest

    def _is_culled(self, directions: FloatArray, faces: IntArray, cull: Cull) -> BoolArray:
        if cull == "nothing":
            return np.zeros(len(faces), bool)
        facing = np.einsum("ij,ij->i", directions, self.face_normals[faces])
        return facing > 0.0 if cull == "back" else facing < 0.0

    def _first_faces(
        self, origins: FloatArray, directions: FloatArray, chosen: IntArray | None
    ) -> tuple[IntArray, FloatArray]:
        """Return the first face of each ray, -1 for none, and rough barycentric coordinates."""
        middle, size = self.bounds
        begin = (origins - middle) / (size if size > 0.0 else 1.0)
        answer = self._tree(chosen).run(
            begin.astype(np.float32), directions.astype(np.float32), output=1
        )
        found = np.asarray(answer["primID"], np.int32)
        if chosen is not None:
            found = np.where(found >= 0, chosen[found], -1)
        u, v = np.asarray(answer["u"], np.float64), np.asarray(answer["v"], np.float64)
        return found, np.stack([1.0 - u - v, u, v], axis=1)

    def _hits(self, nearest: _Nearest) -> RayHits:
        hit = np.flatnonzero(nearest.face >= 0)
        q, found = len(nearest.face), nearest.face[hit]
        mesh, local = np.full(q, -1, np.int32), np.full(q, -1, np.int32)
        positions, normals = np.full((q, 3), np.nan), np.full((q, 3), np.nan)
        mesh[hit], local[hit] = self.mesh_of_face[found], self.local_faces(found)
        positions[hit] = np.einsum("kc,kcj->kj", nearest.bary[hit], self.corners[found])
        normals[hit] = self.face_normals[found]
        return RayHits(nearest.distance, mesh, local, nearest.bary, positions, normals)

    def _tree(self, chosen: IntArray | None) -> EmbreeScene:
        key = b"" if chosen is None else chosen.tobytes()
        if key not in self._trees:
            if len(self._trees) >= _KEPT_TREES:
                del self._trees[next(iter(self._trees))]
            middle, size = self.bounds
            scaled = (self.positions - middle) / (size if size > 0.0 else 1.0)
            faces = self.faces if chosen is None else self.faces[chosen]
            tree = EmbreeScene(robust=True)
            TriangleMesh(tree, scaled.astype(np.float32), np.ascontiguousarray(faces))
            self._trees[key] = tree
        return self._trees[key]


@dataclass(frozen=True, eq=False)
class _Nearest:
    """Nearest faces found so far, numbered through all meshes."""

    face: IntArray
    distance: FloatArray
    bary: FloatArray

    @staticmethod
    def misses(count: int) -> _Nearest:
        return _Nearest(
            np.full(count, -1, np.int32), np.full(count, np.inf), np.full((count, 3), np.nan)
        )

    def put(
        self, rows: npt.NDArray[np.intp], face: IntArray, distance: FloatArray, bary: FloatArray
    ) -> None:
        self.face[rows], self.distance[rows], self.bary[rows] = face, distance, bary


def _refined(
    origins: FloatArray, directions: FloatArray, corners: FloatArray, rough: FloatArray
) -> FloatArray:
    """Return where lines meet triangles that single precision says they hit, never outside."""
    bary, _ = line_bary(origins, directions, corners)
    # Grazing lines have no stable meeting point; there the rough one is the better one.
    off = np.abs(bary - rough).max(axis=1, initial=0.0)
    bary = np.where((off < _ROUGH)[:, None], bary, rough)
    bary = np.clip(bary, 0.0, 1.0)
    return bary / bary.sum(axis=1, keepdims=True)


def _as_directions(value: npt.ArrayLike, count: int) -> FloatArray:
    array = np.asarray(value, dtype=np.float64)
    if array.ndim == 1:
        array = np.broadcast_to(array, (count, *array.shape))
    directions = as_points("directions", array)
    if len(directions) != count:
        raise ShapeError(f"directions: expected {count} rows, one per origin, got {len(array)}")
    length = np.linalg.norm(directions, axis=1, keepdims=True)
    if (length == 0.0).any():
        row = int(np.argmin(length))
        raise ParameterError(f"directions: row {row} is zero; a ray needs a direction")
    return directions / length
