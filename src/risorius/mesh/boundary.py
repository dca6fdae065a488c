"""Ordered boundary loops of a triangle mesh."""

from __future__ import annotations

import numpy as np

from risorius._check import IntArray
from risorius.mesh.connectivity import EdgeFaces, edge_faces

__all__ = ["boundary_loops"]


def boundary_loops(faces: IntArray) -> list[IntArray]:
    """Return the boundary loops, each as its vertices (k,) in order.

    A loop is closed (its last vertex is joined to its first), visits no vertex twice, starts at
    its smallest vertex and runs along the sides of its faces, so that the surface lies on its
    left seen from outside. Loops are ordered by their first vertex.

    Notes
    -----
    At a pinch vertex (two borders meet in one vertex) the walk follows the fan of faces that it
    came along, and a loop that would visit a vertex twice is split there. Border edges that
    close to no loop, which happens only next to non-manifold edges, are left out. Every border
    edge is used once, so the walk always ends.
    """
    table = edge_faces(faces)
    border = np.flatnonzero(table.counts == 1)
    unused = dict.fromkeys(border.tolist())
    by_vertex: dict[int, list[int]] = {}
    for edge in border.tolist():
        for vertex in table.edges[edge].tolist():
            by_vertex.setdefault(vertex, []).append(edge)
    loops: list[list[int]] = []
    while unused:
        edge = next(iter(unused))
        loops.extend(_walk(faces, table, edge, unused, by_vertex))
    turned = [_from_smallest(loop) for loop in loops]
    turned.sort(key=lambda loop: loop.tolist())
    return turned


def _from_smallest(loop: list[int]) -> IntArray:
    array = np.asarray(loop, np.int32)
    return np.roll(array, -int(np.argmin(array)))


def _walk(
    faces: IntArray,
    table: EdgeFaces,
    edge: int,
    unused: dict[int, None],
    by_vertex: dict[int, list[int]],
) -> list[list[int]]:
    """Follow the border from `edge` until it closes or ends; return the simple loops on it."""
    tail, head = _direction(faces, table, edge)
    path, place = [tail], {tail: 0}
    loops: list[list[int]] = []
    while True:
        del unused[edge]
        if head in place:
            start = place[head]
            loops.append(path[start:])
            for vertex in path[start + 1 :]:
                del place[vertex]
            del path[start + 1 :]
        else:
            place[head] = len(path)
            path.append(head)
        following = _next_edge(faces, table, edge, head)
        if following not in unused:
            following = next((other for other in by_vertex[head] if other in unused), -1)
        if following < 0:
            return loops
        first, second = table.edges[following].tolist()
        edge, head = following, second if first == head else first


def _direction(faces: IntArray, table: EdgeFaces, edge: int) -> tuple[int, int]:
    """Return tail and head of a border edge in the sense of its face."""
    face = int(table.faces[edge, 0])
    corner = int(np.flatnonzero(table.face_edges[face] == edge)[0])
    return int(faces[face, corner]), int(faces[face, (corner + 1) % 3])


def _next_edge(faces: IntArray, table: EdgeFaces, edge: int, vertex: int) -> int:
    """Return the border edge at the far end of the fan of faces around `vertex`, or -1."""
    face = int(table.faces[edge, 0])
    seen: set[int] = set()
    while face not in seen:
        seen.add(face)
        around = [
            int(table.face_edges[face, corner])
            for corner in range(3)
            if vertex in (faces[face, corner], faces[face, (corner + 1) % 3])
        ]
        edge = around[0] if around[1] == edge else around[1]
        if table.counts[edge] == 1:
            return edge
        first, second = table.faces[edge].tolist()
        face = second if first == face else first
    return -1
