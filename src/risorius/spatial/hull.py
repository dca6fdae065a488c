"""Convex hulls: inside, how deep, and where to leave."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.spatial import ConvexHull, QhullError

from risorius._check import BoolArray, FloatArray, as_points
from risorius.errors import MeshError, ParameterError
from risorius.mesh.core import TriMesh

__all__ = ["Hull", "convex_hull"]

# Points thinner than this share of their extent have no hull with an inside.
_THINNEST = 1e-9
# Points within this share of the size of the surface count as on it.
_ROUNDING = 1e-12
# At most this many distances are held at once.
_PAIRS_AT_ONCE = 1 << 20


@dataclass(frozen=True, eq=False)
class Hull:
    """A convex solid.

    Parameters
    ----------
    mesh : TriMesh
        Its surface, faces outwards, only vertices of the hull.
    plane_normals : (f, 3) float64
        Unit outward normals of the planes that bound it.
    plane_offsets : (f,) float64
        ``plane_normals @ x <= plane_offsets`` holds inside [mm].
    """

    mesh: TriMesh
    plane_normals: FloatArray
    plane_offsets: FloatArray

    def depth(self, points: npt.ArrayLike) -> FloatArray:
        """Return how deep (q,) each of `points` (q, 3) lies below the nearest plane [mm].

        Positive inside: the distance to the surface. Negative outside: the distance to the
        farthest plane that the point violates, at most the distance to the solid.
        """
        queries = as_points("points", points)
        return np.concatenate([below.min(axis=1) for below in self._below(queries)])

    def inside(self, points: npt.ArrayLike, *, margin: float = 0.0) -> BoolArray:
        """Return which points (q,) lie inside or on the surface, deeper than `margin` [mm]."""
        return self.depth(points) >= margin - _ROUNDING * self.mesh.size

    def exit_along(self, points: npt.ArrayLike, direction: npt.ArrayLike) -> FloatArray:
        """Return how far (q,) points travel along a direction until they are out [mm].

        Parameters
        ----------
        points : (q, 3) array_like
            Points [mm].
        direction : (3,) or (q, 3) array_like
            Where they leave; any length but zero.

        Returns
        -------
        (q,) float64
            0 for points that are not inside.
        """
        queries = as_points("points", points)
        towards = as_points("direction", np.atleast_2d(direction))
        length = np.linalg.norm(towards, axis=1, keepdims=True)
        if (length == 0.0).any():
            raise ParameterError("direction: it is zero; points need a direction to leave along")
        towards = np.broadcast_to(towards / length, queries.shape)
        result = np.zeros(len(queries))
        done = 0
        for below in self._below(queries):
            rows = slice(done, done + len(below))
            rate = towards[rows] @ self.plane_normals.T
            travel = np.where(rate > 0.0, below / np.where(rate > 0.0, rate, 1.0), np.inf)
            result[rows] = np.where(below.min(axis=1) > 0.0, travel.min(axis=1), 0.0)
            done += len(below)
        return result

    def _below(self, points: FloatArray) -> Iterator[FloatArray]:
        """Yield the distances (k, f) below every plane, a block of points at a time."""
        block = 1 + _PAIRS_AT_ONCE // len(self.plane_offsets)
        for start in range(0, max(len(points), 1), block):
            yield self.plane_offsets - points[start : start + block] @ self.plane_normals.T


def convex_hull(points: npt.ArrayLike) -> Hull:
    """Return the convex hull of `points`.

    Parameters
    ----------
    points : (n, 3) array_like
        At least four, not in one plane [mm].

    Raises
    ------
    MeshError
        If the points have no extent in some direction.
    """
    given = as_points("points", points)
    if len(given) < 4:
        raise MeshError(f"hull: {len(given)} points enclose nothing; give at least four")
    spread = np.linalg.svd(given - given.mean(axis=0), compute_uv=False)
    if spread[2] <= _THINNEST * spread[0]:
        raise MeshError(
            f"hull: the {len(given)} points lie in one plane or on one line and enclose nothing; "
            "give points with depth"
        )
    try:
        hull = ConvexHull(given)
    except QhullError as error:
        reason = str(error).partition("\n")[0]
        raise MeshError(f"hull: {len(given)} points have none ({reason})") from None
    # Facets of more than three corners come as several triangles with one equation.
    planes = np.unique(hull.equations, axis=0)
    vertices = np.sort(hull.vertices)
    local = np.zeros(len(given), np.int32)
    local[vertices] = np.arange(len(vertices))
    faces = local[hull.simplices]
    corners = given[hull.simplices]
    turning = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    inward = np.einsum("ij,ij->i", turning, hull.equations[:, :3]) < 0.0
    faces[inward] = faces[inward][:, [0, 2, 1]]
    return Hull(TriMesh(given[vertices], faces), planes[:, :3], -planes[:, 3])
