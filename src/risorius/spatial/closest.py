"""Closest points on surfaces, and signed distances to closed ones."""

from __future__ import annotations

from dataclasses import dataclass

import igl
import numpy as np
import numpy.typing as npt

from risorius._check import FloatArray, IntArray, as_number, as_points
from risorius.errors import ShapeError
from risorius.mesh.core import TriMesh
from risorius.mesh.surface_point import SurfacePoints
from risorius.spatial.face_tree import FaceTree
from risorius.spatial.mesh_set import MeshSet
from risorius.spatial.triangles import closest_bary

__all__ = ["ClosestPoints", "closest_points", "signed_distance", "winding_numbers"]


@dataclass(frozen=True, eq=False)
class ClosestPoints:
    """The closest surface point of every query.

    Parameters
    ----------
    distance : (q,) float64
        inf where no face was allowed [mm].
    mesh, face : (q,) int32
        Mesh of the set and face of that mesh; -1 where no face was allowed.
    bary : (q, 3) float64
        Barycentric coordinates on that face, or NaN.
    positions : (q, 3) float64
        The closest points, or NaN [mm].
    """

    distance: FloatArray
    mesh: IntArray
    face: IntArray
    bary: FloatArray
    positions: FloatArray

    def surface_points(self) -> SurfacePoints:
        """Return the surface points of the queries (k,) that found one, in their order."""
        rows = self.face >= 0
        return SurfacePoints(self.face[rows], self.bary[rows], self.mesh[rows])


def closest_points(
    surface: TriMesh | MeshSet,
    points: npt.ArrayLike,
    *,
    face_mask: npt.ArrayLike | None = None,
    normals: npt.ArrayLike | None = None,
    max_angle: float = 90.0,
) -> ClosestPoints:
    """Return the closest surface points.

    Parameters
    ----------
    surface : TriMesh or MeshSet
        A `Scene` is a mesh set.
    points : (q, 3) array_like
        Query points [mm].
    face_mask : (f,) bool, optional
        Faces that count, numbered through all meshes.
    normals : (q, 3) array_like, optional
        Only faces whose normal is within `max_angle` of the query's count: the other lip, the
        inside of the cheek do not.
    max_angle : float
        Used with `normals` [deg].

    Notes
    -----
    Where an edge or a corner is closest, any of its faces may be named. Faces without area count
    as segments; with `normals` they do not count. O((q + f) log f); by normal somewhat slower.
    """
    scene, queries = MeshSet.of(surface), as_points("points", points)
    chosen = scene.chosen_faces(face_mask)
    if normals is None:
        allowed = np.arange(scene.face_count, dtype=np.int32) if chosen is None else chosen
        return _answers(scene, queries, _nearest_faces(scene, queries, allowed))
    wanted = as_points("normals", normals)
    if len(wanted) != len(queries):
        raise ShapeError(f"normals: expected {len(queries)} rows, one per point, got {len(wanted)}")
    least = float(np.cos(np.radians(as_number("max_angle", max_angle, low=0.0, high=180.0))))
    length = np.linalg.norm(wanted, axis=1, keepdims=True)
    wanted = wanted / np.where(length > 0.0, length, 1.0)
    sound = (scene.face_normals != 0.0).any(axis=1)
    if chosen is not None:
        sound &= np.isin(np.arange(scene.face_count), chosen)
    found = _by_normal(scene, queries, wanted, np.flatnonzero(sound).astype(np.int32), least)
    return _answers(scene, queries, found)


def signed_distance(mesh: TriMesh, points: npt.ArrayLike) -> FloatArray:
    """Return the distances (q,) to a closed mesh, negative inside [mm].

    Parameters
    ----------
    mesh : TriMesh
        A closed mesh such as a tooth or an eyeball; it may consist of several, and its faces may
        look inwards. Small holes are bridged sensibly.
    points : (q, 3) array_like
        Query points [mm].

    Notes
    -----
    Inside is where the winding number exceeds one half in size.
    """
    queries = as_points("points", points)
    distance = closest_points(mesh, queries).distance
    inside = np.abs(winding_numbers(mesh, queries)) > 0.5
    return np.where(inside, -distance, distance)


def winding_numbers(mesh: TriMesh, points: npt.ArrayLike) -> FloatArray:
    """Return how often (q,) the mesh wraps around each of `points` (q, 3).

    1 inside a closed mesh whose faces look outwards, 0 outside, in between near holes.

    References
    ----------
    Barill et al. 2018, "Fast winding numbers for soups and clouds".
    """
    queries = as_points("points", points)
    if not len(queries) or not mesh.face_count:
        return np.zeros(len(queries))
    numbers = igl.fast_winding_number(mesh.positions, mesh.faces.astype(np.int64), queries)
    return np.asarray(numbers, np.float64)


def _nearest_faces(scene: MeshSet, points: FloatArray, allowed: IntArray) -> IntArray:
    if not len(allowed) or not len(points):
        return np.full(len(points), -1, np.int32)
    faces = scene.faces[allowed].astype(np.int64)
    _, found, _ = igl.point_mesh_squared_distance(points, scene.positions, faces)
    return allowed[np.asarray(found).ravel()]


def _answers(scene: MeshSet, points: FloatArray, face: IntArray) -> ClosestPoints:
    q = len(points)
    distance, bary = np.full(q, np.inf), np.full((q, 3), np.nan)
    mesh, local = np.full(q, -1, np.int32), np.full(q, -1, np.int32)
    positions = np.full((q, 3), np.nan)
    rows = np.flatnonzero(face >= 0)
    corners = scene.corners[face[rows]]
    bary[rows] = closest_bary(points[rows], corners)
    positions[rows] = np.einsum("kc,kcj->kj", bary[rows], corners)
    distance[rows] = np.linalg.norm(points[rows] - positions[rows], axis=1)
    mesh[rows], local[rows] = scene.mesh_of_face[face[rows]], scene.local_faces(face[rows])
    return ClosestPoints(distance, mesh, local, bary, positions)


def _by_normal(
    scene: MeshSet, points: FloatArray, normals: FloatArray, allowed: IntArray, least: float
) -> IntArray:
    """Return the closest allowed face whose normal agrees, -1 if there is none."""
    found = _nearest_faces(scene, points, allowed)
    if not len(allowed) or not len(points):
        return found
    # The closest face of all often agrees already; only the others need the search.
    agrees = np.einsum("ij,ij->i", scene.face_normals[found], normals) >= least
    rows = np.flatnonzero(~agrees)
    if len(rows):
        tree = FaceTree(scene.corners[allowed], scene.face_normals[allowed])
        best = tree.closest(points[rows], normals[rows], least)
        found[rows] = np.where(best >= 0, allowed[best], -1)
    return found
