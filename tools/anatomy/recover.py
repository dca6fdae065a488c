"""Force given edges into a plane triangulation by flips."""

from __future__ import annotations

import numpy as np

from .topology import half_edges

__all__ = ["recover_edges"]

_MOST_FLIPS = 200


def _side(a, b, c):
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def _crosses(p, q, a, b):
    return _side(p, q, a) * _side(p, q, b) < 0 and _side(a, b, p) * _side(a, b, q) < 0


def _opposite(faces, a, b):
    """Return the faces on both sides of the edge a-b and their third corners."""
    of_edge = np.flatnonzero((faces == a).any(axis=1) & (faces == b).any(axis=1))
    corners = [int(faces[f][(faces[f] != a) & (faces[f] != b)][0]) for f in of_edge]
    return of_edge, corners


def _crossing_edge(faces, points, p, q):
    """Return an edge that crosses p-q and may be flipped, with its faces and their corners."""
    near = np.unique(np.sort(half_edges(faces), axis=1), axis=0)
    low = np.minimum(points[p], points[q])
    high = np.maximum(points[p], points[q])
    ends = points[near]
    overlap = (ends.max(axis=1) >= low).all(axis=1) & (ends.min(axis=1) <= high).all(axis=1)
    for a, b in near[overlap].tolist():
        if {a, b} & {p, q} or not _crosses(points[p], points[q], points[a], points[b]):
            continue
        of_edge, corners = _opposite(faces, a, b)
        if len(of_edge) != 2:
            continue
        c, d = corners
        if _crosses(points[c], points[d], points[a], points[b]):
            return a, b, of_edge, corners
    return None


def recover_edges(faces, points, edges):
    """Return counter-clockwise `faces` (m, 3) that contain all `edges` (k, 2).

    Parameters
    ----------
    faces : (m, 3) int ndarray
        Delaunay triangles of `points`.
    points : (n, 2) ndarray
    edges : (k, 2) int ndarray
        Segments that do not cross each other.
    """
    faces = faces.copy()
    n = len(points)
    existing = np.sort(half_edges(faces), axis=1)
    missing = ~np.isin(np.sort(edges, axis=1) @ [n, 1], existing @ [n, 1])
    for p, q in edges[missing].tolist():
        for _ in range(_MOST_FLIPS):
            found = _crossing_edge(faces, points, p, q)
            if found is None:
                break
            a, b, of_edge, (c, d) = found
            for face, corners in zip(of_edge, ((c, d, a), (d, c, b))):
                if _side(points[corners[0]], points[corners[1]], points[corners[2]]) < 0:
                    corners = corners[::-1]
                faces[face] = corners
    return faces
