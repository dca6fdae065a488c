"""The report on a mesh's topology; also the place to import all topology functions from."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from risorius._check import FloatArray, IntArray
from risorius.mesh.boundary import boundary_loops
from risorius.mesh.connectivity import (
    Components,
    EdgeFaces,
    Neighbours,
    collapsed_faces,
    components,
    edge_faces,
    edges,
    opposite_corners,
    vertex_neighbours,
)
from risorius.mesh.core import TriMesh
from risorius.mesh.orientation import Orientation, agreeing_edges, orient
from risorius.mesh.volume import capped_volume

__all__ = [
    "Components",
    "EdgeFaces",
    "Neighbours",
    "Orientation",
    "TopologyReport",
    "boundary_loops",
    "capped_volume",
    "collapsed_faces",
    "components",
    "edge_faces",
    "edges",
    "opposite_corners",
    "orient",
    "report",
    "vertex_neighbours",
]

# Twice the area over the square of the longest side; below it a triangle is a line.
_NO_AREA = 1e-12


@dataclass(frozen=True, eq=False)
class TopologyReport:
    """What a mesh is made of and what is wrong with it.

    Parameters
    ----------
    vertex_count, edge_count, face_count : int
        Vertices include unused ones; edges and `euler` leave out faces with a repeated corner.
    component_count : int
        Loose pieces that own a face.
    boundary_loops : list of (k,) int32
        See `boundary_loops`.
    euler : int
        Used vertices - edges + faces.
    genus : int or None
        Total number of handles; None unless the mesh is manifold and its faces agree.
    non_manifold_edges : (k, 2) int32
        Edges of more than two faces.
    non_manifold_vertices : (k,) int32
        Vertices whose faces form more than one fan.
    inconsistent_edges : (k, 2) int32
        Edges that their two faces run along in the same sense.
    degenerate_faces, duplicate_faces : (k,) int32
        Faces with a repeated corner or without area; faces with the corners of an earlier one.
    unused_vertices : (k,) int32
        Vertices of no face.
    """

    vertex_count: int
    edge_count: int
    face_count: int
    component_count: int
    boundary_loops: list[IntArray]
    euler: int
    genus: int | None
    non_manifold_edges: IntArray
    non_manifold_vertices: IntArray
    inconsistent_edges: IntArray
    degenerate_faces: IntArray
    duplicate_faces: IntArray
    unused_vertices: IntArray

    @property
    def is_manifold(self) -> bool:
        """Whether every edge has one or two faces and every vertex a single fan."""
        return not len(self.non_manifold_edges) and not len(self.non_manifold_vertices)

    @property
    def is_closed(self) -> bool:
        """Whether the mesh is a manifold without boundary."""
        return self.is_manifold and not self.boundary_loops and self.face_count > 0

    def sentences(self) -> list[str]:
        """Return the findings as sentences for people, worst last."""
        loops = ", ".join(str(len(loop)) for loop in self.boundary_loops)
        lines = [
            f"{self.vertex_count} vertices, {self.edge_count} edges, {self.face_count} triangles "
            f"in {_count(self.component_count, 'piece')}",
            f"boundary loops (edges): {loops}" if loops else "no boundary: closed",
        ]
        faults = (
            ("unused vertex", "unused vertices", self.unused_vertices),
            ("triangle without area", "triangles without area", self.degenerate_faces),
            ("triangle given twice", "triangles given twice", self.duplicate_faces),
            (
                "edge where neighbours face opposite ways",
                "edges where neighbours face opposite ways",
                self.inconsistent_edges,
            ),
            ("vertex where fans meet", "vertices where fans meet", self.non_manifold_vertices),
            (
                "edge of more than two triangles",
                "edges of more than two triangles",
                self.non_manifold_edges,
            ),
        )
        for one, many, rows in faults:
            if len(rows):
                lines.append(f"{len(rows)} {one if len(rows) == 1 else many}: {_first(rows)}")
        return lines


def report(mesh: TriMesh) -> TopologyReport:
    """Return the topology report of `mesh`."""
    faces, n = mesh.faces, mesh.vertex_count
    table = edge_faces(faces)
    used = np.zeros(n, bool)
    used[faces] = True
    collapsed = collapsed_faces(faces)
    loops = boundary_loops(faces)
    pieces = components(faces, n)
    non_manifold_edges = table.edges[table.counts > 2]
    non_manifold_vertices = _split_vertices(faces, table, n)
    inconsistent = table.edges[(table.counts == 2) & ~agreeing_edges(faces, table)]
    euler = int(used.sum()) - len(table.edges) + int((~collapsed).sum())
    defined = (
        not (len(non_manifold_edges) or len(non_manifold_vertices) or len(inconsistent))
        and not collapsed.any()
    )
    return TopologyReport(
        vertex_count=n,
        edge_count=len(table.edges),
        face_count=len(faces),
        component_count=pieces.piece_count,
        boundary_loops=loops,
        euler=euler,
        genus=(2 * pieces.piece_count - euler - len(loops)) // 2 if defined else None,
        non_manifold_edges=non_manifold_edges,
        non_manifold_vertices=non_manifold_vertices,
        inconsistent_edges=inconsistent,
        degenerate_faces=np.flatnonzero(_without_area(mesh.positions, faces)).astype(np.int32),
        duplicate_faces=_duplicates(faces),
        unused_vertices=np.flatnonzero(~used).astype(np.int32),
    )


def _without_area(positions: FloatArray, faces: IntArray) -> IntArray:
    corners = positions[faces]
    sides = corners[:, [1, 2, 0]] - corners
    longest = np.einsum("ijk,ijk->ij", sides, sides).max(axis=1, initial=0.0)
    doubled = np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1)
    return collapsed_faces(faces) | (doubled <= _NO_AREA * longest)


def _duplicates(faces: IntArray) -> IntArray:
    if not len(faces):
        return np.zeros(0, np.int32)
    _, first = np.unique(np.sort(faces, axis=1), axis=0, return_index=True)
    again = np.ones(len(faces), bool)
    again[first] = False
    return np.flatnonzero(again).astype(np.int32)


def _split_vertices(faces: IntArray, table: EdgeFaces, vertex_count: int) -> IntArray:
    """Return the vertices whose faces fall into several fans around them."""
    sound = np.flatnonzero(~collapsed_faces(faces))
    if not len(sound):
        return np.zeros(0, np.int32)
    # Sides of one edge touch at both of its ends: join their corners there.
    edge = table.face_edges[sound].ravel()
    tail = 3 * np.repeat(sound, 3) + np.tile([0, 1, 2], len(sound))
    head = 3 * np.repeat(sound, 3) + np.tile([1, 2, 0], len(sound))
    flat = faces.ravel()
    forward = flat[tail] == table.edges[edge, 0]
    low, high = np.where(forward, tail, head), np.where(forward, head, tail)
    order = np.argsort(edge, kind="stable")
    same = np.flatnonzero(edge[order][1:] == edge[order][:-1])
    rows = np.concatenate([low[order][same], high[order][same]])
    columns = np.concatenate([low[order][same + 1], high[order][same + 1]])
    graph = coo_matrix((np.ones(len(rows), np.int8), (rows, columns)), shape=(len(flat),) * 2)
    labels = connected_components(graph, directed=False)[1]
    corners = (3 * sound[:, None] + np.arange(3)).ravel()
    fans = np.unique(np.stack([flat[corners], labels[corners]], axis=1), axis=0)
    return np.flatnonzero(np.bincount(fans[:, 0], minlength=vertex_count) > 1).astype(np.int32)


def _count(number: int, noun: str) -> str:
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"


def _first(rows: IntArray, limit: int = 5) -> str:
    text = ", ".join(str(row) for row in rows[:limit].tolist())
    return text if len(rows) <= limit else f"{text}, ..."
