"""Distances and paths on the surface.

Dijkstra's distance runs along edges, as published; it is never shorter than the true one. The
heat method crosses faces and is the improved option.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import dijkstra

from risorius._check import FloatArray, IntArray
from risorius.errors import MeshError, ParameterError, ShapeError
from risorius.mesh.connectivity import components, edges
from risorius.mesh.core import TriMesh

__all__ = [
    "Barrier",
    "HeatDistance",
    "NearestSource",
    "dijkstra_distance",
    "heat_distance",
    "nearest_source",
    "path_through",
    "shortest_path",
]


@dataclass(frozen=True, eq=False)
class Barrier:
    """What paths may not cross, for example the contact line of the lips.

    Parameters
    ----------
    vertices : (k,) int32 or (n,) bool
        Paths may end at these vertices but not run through them; a source among them is free.
    edges : (k, 2) int32
        Paths may not use these edges, in either direction.
    """

    vertices: npt.ArrayLike = ()
    edges: npt.ArrayLike = ()


class NearestSource(NamedTuple):
    """Distance to the nearest of several sources.

    Parameters
    ----------
    distance : (n,) float64
        inf where no source is reached [mm].
    source : (n,) int32
        The nearest source, -1 where none is reached.
    """

    distance: FloatArray
    source: IntArray


def dijkstra_distance(
    positions: FloatArray,
    faces: IntArray,
    sources: npt.ArrayLike,
    *,
    limit: float = np.inf,
    blocked: Barrier | None = None,
) -> FloatArray:
    """Return the distance (n,) along edges to the nearest of `sources` [mm]; inf out of reach.

    Parameters
    ----------
    positions : (n, 3) float64
        Vertices [mm].
    faces : (m, 3) int32
    sources : (k,) int
        Vertices at distance 0.
    limit : float
        Distances beyond it are not followed and come back as inf [mm].
    blocked : Barrier, optional
        What paths may not cross.

    Notes
    -----
    The length of the shortest path on edges: at least the geodesic distance, and up to a few
    tens of percent more against the grain of the mesh.
    """
    return nearest_source(positions, faces, sources, limit=limit, blocked=blocked).distance


def nearest_source(
    positions: FloatArray,
    faces: IntArray,
    sources: npt.ArrayLike,
    *,
    limit: float = np.inf,
    blocked: Barrier | None = None,
) -> NearestSource:
    """Return the distance along edges and the nearest of `sources` (k,) itself.

    Parameters and distance are those of `dijkstra_distance`.
    """
    seeds = _as_vertices("sources", sources, len(positions))
    graph = _edge_graph(positions, faces, blocked, seeds)
    distance, _, nearest = dijkstra(
        graph, indices=seeds, limit=limit, min_only=True, return_predecessors=True
    )
    return NearestSource(distance, np.maximum(nearest, -1).astype(np.int32))


class HeatDistance:
    """Geodesic distances by the heat method on one mesh, factored once.

    Parameters
    ----------
    positions : (n, 3) float64
        Vertices [mm].
    faces : (m, 3) int32

    Notes
    -----
    Runs on an intrinsic Delaunay triangulation, which also accepts poor and non-manifold meshes.
    Within a few percent of the true distance; smooth, not exact at the source.

    References
    ----------
    Crane, Weischedel, Wardetzky 2013, "Geodesics in heat".
    """

    def __init__(self, positions: FloatArray, faces: IntArray) -> None:
        import potpourri3d

        self._pieces = components(faces, len(positions)).of_vertex
        self._used = np.flatnonzero(self._pieces >= 0)
        local = np.zeros(len(positions), np.int32)
        local[self._used] = np.arange(len(self._used))
        self._local = local
        self._solver = (
            potpourri3d.MeshHeatMethodDistanceSolver(positions[self._used], local[faces])
            if len(faces)
            else None
        )

    def distance(self, sources: npt.ArrayLike) -> FloatArray:
        """Return the distance (n,) to the nearest of `sources` [mm]; inf on other pieces."""
        seeds = _as_vertices("sources", sources, len(self._pieces))
        result = np.full(len(self._pieces), np.inf)
        on_surface = seeds[self._pieces[seeds] >= 0]
        if self._solver is not None and len(on_surface):
            raw = self._solver.compute_distance_multisource(self._local[on_surface].tolist())
            result[self._used] = raw
            result[~np.isin(self._pieces, self._pieces[on_surface])] = np.inf
            # The method fixes the field up to a constant; the sources are its zero.
            result = np.maximum(result - result[on_surface].min(), 0.0)
        result[seeds] = 0.0
        return result


def heat_distance(positions: FloatArray, faces: IntArray, sources: npt.ArrayLike) -> FloatArray:
    """Return the geodesic distance (n,) by the heat method [mm]; see `HeatDistance`."""
    return HeatDistance(positions, faces).distance(sources)


def shortest_path(
    mesh: TriMesh, start: int, goal: int, *, blocked: Barrier | None = None
) -> IntArray:
    """Return the vertices (k,) of the shortest edge path from `start` to `goal`, both included.

    Raises
    ------
    MeshError
        If no path exists.
    """
    return path_through(mesh, (start, goal), blocked=blocked)


def path_through(
    mesh: TriMesh,
    waypoints: Sequence[int],
    *,
    closed: bool = False,
    blocked: Barrier | None = None,
) -> IntArray:
    """Return the shortest edge path (k,) that visits `waypoints` in order.

    Parameters
    ----------
    mesh : TriMesh
    waypoints : sequence of int
        Vertices to visit, at least one.
    closed : bool
        Also return from the last to the first; the first is not repeated at the end.
    blocked : Barrier, optional
        What the path may not cross; it may start and end every stretch on a blocked vertex.

    Raises
    ------
    MeshError
        If two waypoints are not connected.

    Notes
    -----
    The stretches are shortest each for itself; the whole may touch itself.
    """
    stops = _as_vertices("waypoints", waypoints, mesh.vertex_count)
    if closed:
        stops = np.append(stops, stops[0])
    path = [int(stops[0])]
    for start, goal in zip(stops[:-1].tolist(), stops[1:].tolist()):
        graph = _edge_graph(mesh.positions, mesh.faces, blocked, np.array([start]))
        _, before = dijkstra(graph, indices=start, return_predecessors=True)
        if start != goal and before[goal] < 0:
            raise MeshError(
                f"path: vertices {start} and {goal} are not connected on the mesh; choose "
                "waypoints on one piece and on one side of every barrier"
            )
        stretch = [goal]
        while stretch[-1] != start:
            stretch.append(int(before[stretch[-1]]))
        path.extend(stretch[-2::-1])
    return np.asarray(path[:-1] if closed and len(path) > 1 else path, np.int32)


def _as_vertices(name: str, value: npt.ArrayLike, vertex_count: int) -> IntArray:
    vertices = np.atleast_1d(np.asarray(value))
    if vertices.ndim != 1 or not len(vertices):
        raise ShapeError(f"{name}: expected at least one vertex index, got shape {vertices.shape}")
    if not np.issubdtype(vertices.dtype, np.integer):
        raise ShapeError(f"{name}: expected integers, got {vertices.dtype}")
    if vertices.min() < 0 or vertices.max() >= vertex_count:
        raise ParameterError(f"{name}: vertex indices must lie in 0..{vertex_count - 1}")
    return vertices.astype(np.int32)


def _edge_graph(
    positions: FloatArray, faces: IntArray, blocked: Barrier | None, free: IntArray
) -> csr_matrix:
    pairs = edges(faces)
    n = len(positions)
    if blocked is not None:
        banned = np.sort(np.asarray(blocked.edges, dtype=np.int64).reshape(-1, 2), axis=1)
        keys = pairs[:, 0].astype(np.int64) * n + pairs[:, 1]
        pairs = pairs[~np.isin(keys, banned[:, 0] * n + banned[:, 1])]
    length = np.linalg.norm(positions[pairs[:, 0]] - positions[pairs[:, 1]], axis=1)
    both = np.concatenate([pairs, pairs[:, ::-1]])
    length = np.concatenate([length, length])
    if blocked is not None:
        closed = np.zeros(n, bool)
        where = np.asarray(blocked.vertices)
        closed[where if where.dtype == bool else where.astype(np.int64)] = True
        closed[free] = False
        leaves = ~closed[both[:, 0]]
        both, length = both[leaves], length[leaves]
    return csr_matrix((length, (both[:, 0], both[:, 1])), shape=(n, n))
