"""Who touches whom in a triangle mesh: edges, faces of an edge, neighbours, loose pieces.

A face with a repeated corner (left behind by welding) owns no edges: it counts as absent here,
so that it can neither invent a border nor make an edge non-manifold.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from risorius._check import BoolArray, IntArray

__all__ = [
    "Components",
    "EdgeFaces",
    "Neighbours",
    "collapsed_faces",
    "components",
    "edge_faces",
    "edges",
    "opposite_corners",
    "vertex_neighbours",
]


@dataclass(frozen=True, eq=False)
class EdgeFaces:
    """Every undirected edge once, with the faces that share it.

    Parameters
    ----------
    edges : (e, 2) int32
        Vertex pairs, smaller index first, in lexicographic order.
    faces : (e, 2) int32
        The first two faces of each edge in face order, -1 where there is none.
    counts : (e,) int32
        Number of faces of each edge: 1 on a border, 2 inside, more where it is not manifold.
    face_edges : (m, 3) int32
        Edge from corner k to corner k + 1 of each face; -1 for faces with a repeated corner.
    """

    edges: IntArray
    faces: IntArray
    counts: IntArray
    face_edges: IntArray


class Components(NamedTuple):
    """Loose pieces of a mesh, numbered by their smallest vertex.

    Parameters
    ----------
    of_vertex : (n,) int32
        Piece of each vertex, -1 for unused vertices.
    of_face : (m,) int32
        Piece of each face.
    """

    of_vertex: IntArray
    of_face: IntArray

    @property
    def piece_count(self) -> int:
        """Number of pieces that own a face."""
        return int(self.of_vertex.max(initial=-1)) + 1


class Neighbours(NamedTuple):
    """One-ring neighbours in compressed rows.

    Parameters
    ----------
    indptr : (n + 1,) int32
        The neighbours of vertex v are ``indices[indptr[v]:indptr[v + 1]]``, in ascending order.
    indices : (k,) int32
    """

    indptr: IntArray
    indices: IntArray

    def of(self, vertex: int) -> IntArray:
        """Return the neighbours (k,) of one vertex."""
        return self.indices[self.indptr[vertex] : self.indptr[vertex + 1]]


def collapsed_faces(faces: IntArray) -> BoolArray:
    """Return the mask (m,) of faces with a repeated corner."""
    return (
        (faces[:, 0] == faces[:, 1]) | (faces[:, 1] == faces[:, 2]) | (faces[:, 2] == faces[:, 0])
    )


def edges(faces: IntArray) -> IntArray:
    """Return every undirected edge (e, 2) once, smaller index first, lexicographic order."""
    return edge_faces(faces).edges


def edge_faces(faces: IntArray) -> EdgeFaces:
    """Return the edges of `faces` (m, 3) and up to two faces of each.

    Notes
    -----
    Cost is one sort of 3 m numbers. Edges with more than two faces keep the first two.
    """
    sound = np.flatnonzero(~collapsed_faces(faces))
    start = faces[sound].ravel().astype(np.int64)
    end = faces[sound][:, [1, 2, 0]].ravel().astype(np.int64)
    span = int(faces.max(initial=-1)) + 1
    keys, edge_of_side = np.unique(
        np.minimum(start, end) * span + np.maximum(start, end), return_inverse=True
    )
    count = len(keys)
    pairs = np.stack([keys // max(span, 1), keys % max(span, 1)], axis=1).astype(np.int32)
    counts = np.bincount(edge_of_side, minlength=count).astype(np.int32)
    order = np.argsort(edge_of_side, kind="stable")
    first = np.cumsum(counts) - counts
    owner = np.repeat(sound, 3)[order]
    two = np.full((count, 2), -1, np.int32)
    two[:, 0] = owner[first]
    shared = counts > 1
    two[shared, 1] = owner[first[shared] + 1]
    face_edges = np.full((len(faces), 3), -1, np.int32)
    face_edges[sound] = edge_of_side.reshape(-1, 3)
    return EdgeFaces(pairs, two, counts, face_edges)


def opposite_corners(faces: IntArray, table: EdgeFaces | None = None) -> IntArray:
    """Return the vertices (e, 2) that face each edge in its first two faces, -1 where none.

    Parameters
    ----------
    faces : (m, 3) int32
    table : EdgeFaces, optional
        The edges of `faces`, to save the second computation.
    """
    table = edge_faces(faces) if table is None else table
    result = np.full((len(table.edges), 2), -1, np.int32)
    for side in range(2):
        rows = np.flatnonzero(table.faces[:, side] >= 0)
        corners = faces[table.faces[rows, side]]
        # The corner that is left: the sum of all three less the two of the edge.
        result[rows, side] = corners.sum(axis=1) - table.edges[rows].sum(axis=1)
    return result


def vertex_neighbours(faces: IntArray, vertex_count: int) -> Neighbours:
    """Return the one-ring neighbours of every vertex in compressed rows."""
    pairs = edges(faces)
    rows = np.concatenate([pairs[:, 0], pairs[:, 1]])
    columns = np.concatenate([pairs[:, 1], pairs[:, 0]])
    order = np.lexsort((columns, rows))
    indptr = np.zeros(vertex_count + 1, np.int32)
    np.cumsum(np.bincount(rows, minlength=vertex_count), out=indptr[1:])
    return Neighbours(indptr, columns[order])


def components(faces: IntArray, vertex_count: int) -> Components:
    """Return the loose pieces, joined through shared vertices.

    Returns
    -------
    of_vertex : (n,) int32
        Piece of each vertex, numbered by the piece's smallest vertex; -1 for unused vertices.
    of_face : (m,) int32
        Piece of each face.
    """
    if not len(faces):
        return Components(np.full(vertex_count, -1, np.int32), np.zeros(0, np.int32))
    rows, columns = faces[:, [0, 1]].ravel(), faces[:, [1, 2]].ravel()
    graph = coo_matrix(
        (np.ones(len(rows), np.int8), (rows, columns)), shape=(vertex_count, vertex_count)
    )
    labels = connected_components(graph, directed=False)[1]
    used = np.unique(faces)
    _, first, dense = np.unique(labels[used], return_index=True, return_inverse=True)
    rank = np.empty(len(first), np.int32)
    rank[np.argsort(first)] = np.arange(len(first))
    of_vertex = np.full(vertex_count, -1, np.int32)
    of_vertex[used] = rank[dense]
    return Components(of_vertex, of_vertex[faces[:, 0]])
