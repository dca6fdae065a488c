"""Edges, borders, components and mirror images of index meshes."""

from __future__ import annotations

import numpy as np
from scipy.sparse import coo_matrix, diags
from scipy.sparse.csgraph import connected_components

__all__ = [
    "adjacency",
    "border_loops",
    "compact",
    "half_edges",
    "largest_component",
    "mirrored",
    "vertex_mean",
]


def half_edges(faces):
    """Return (3 m, 2) directed edges of triangles (m, 3), edge k of all faces together."""
    return np.vstack([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])


def border_loops(faces):
    """Return the border of a triangle mesh as a list of directed vertex loops."""
    present = set(map(tuple, half_edges(faces).tolist()))
    follow = {a: b for a, b in sorted(present) if (b, a) not in present}
    loops = []
    while follow:
        loop = [next(iter(follow))]
        step = follow.pop(loop[0])
        while step != loop[0]:
            loop.append(step)
            step = follow.pop(step)
        loops.append(np.array(loop))
    return loops


def adjacency(faces, vertex_count):
    """Return the symmetric 0/1 vertex adjacency matrix (n, n)."""
    edges = half_edges(faces)
    matrix = coo_matrix((np.ones(len(edges)), edges.T), (vertex_count, vertex_count)).tocsr()
    matrix.data[:] = 1.0
    return matrix.maximum(matrix.T)


def vertex_mean(faces, vertex_count):
    """Return the matrix (n, n) that averages the neighbours of each vertex."""
    matrix = adjacency(faces, vertex_count)
    return diags(1.0 / np.maximum(np.asarray(matrix.sum(axis=1)).ravel(), 1.0)) @ matrix


def compact(positions, faces):
    """Drop unused vertices; return positions, faces and the old index of each vertex."""
    used, inverse = np.unique(faces, return_inverse=True)
    return positions[used], inverse.reshape(faces.shape), used


def largest_component(faces, vertex_count):
    """Return the faces of the component with the most vertices."""
    label = connected_components(adjacency(faces, vertex_count))[1]
    return faces[label[faces[:, 0]] == np.bincount(label[faces[:, 0]]).argmax()]


def mirrored(positions, faces):
    """Mirror a half mesh (x >= 0) and weld it along x = 0; return positions and faces."""
    middle = np.abs(positions[:, 0]) < 1e-6
    positions = np.where(middle[:, None] & [True, False, False], 0.0, positions)
    image = np.arange(len(positions))
    image[~middle] = len(positions) + np.arange((~middle).sum())
    both = np.vstack([positions, positions[~middle] * [-1, 1, 1]])
    return both, np.vstack([faces, image[faces][:, ::-1]])
