"""How stiff the edges of a mesh must be, so that they stretch like one piece of rubber."""

from __future__ import annotations

import numpy as np

from risorius._check import FloatArray, IntArray
from risorius.mesh.connectivity import collapsed_faces
from risorius.mesh.core import TriMesh

__all__ = ["edge_stiffness"]


def edge_stiffness(
    mesh: TriMesh, edges: IntArray, *, least_length: float = 0.0, least: float = 0.0
) -> FloatArray:
    """Return the stiffness (e,) of `edges` (e, 2) for a membrane with E h = 1.

    ``k_e = E h sum_{T containing e} area(T) / L_0^2`` (Van Gelder 1998): a uniform stretch then
    costs the same on every triangulation.

    Parameters
    ----------
    mesh : TriMesh
    edges : (e, 2) int32
        Each from its lower to its higher vertex.
    least_length, least : float
        Floors of L_0 and of k in terms of their medians: slivers would otherwise decide how long
        a stable step may be.
    """
    # Collapsed faces own no edges.
    faces = mesh.faces[~collapsed_faces(mesh.faces)]
    corners = mesh.positions[faces]
    cross = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    area = 0.5 * np.linalg.norm(cross, axis=1)
    sides = np.sort(faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1).astype(np.int64)
    keys = edges[:, 0].astype(np.int64) * mesh.vertex_count + edges[:, 1]
    sequence = np.argsort(keys)
    wanted = sides[:, 0] * mesh.vertex_count + sides[:, 1]
    places = sequence[np.searchsorted(keys[sequence], wanted)]
    total = np.bincount(places, np.repeat(area, 3), len(edges))
    length = np.linalg.norm(mesh.positions[edges[:, 0]] - mesh.positions[edges[:, 1]], axis=1)
    if not len(edges):
        return np.zeros(0)
    floor = max(least_length * float(np.median(length)), 1e-9)
    stiffness = total / np.maximum(length, floor) ** 2
    return np.maximum(stiffness, least * float(np.median(stiffness)))
