"""The auricle as a patch of its own, because the disc map of the whole head squashes it."""

from __future__ import annotations

import numpy as np
import pyfqmr
from scipy.spatial import cKDTree

from .remesh import collapsed, vertex_faces
from .topology import border_loops, half_edges, largest_component

__all__ = ["EAR_TRIANGLES", "cut_patch", "decimate_patch"]

# oval around the auricle in the side view: centre and radii (z, y) [mm], lean [rad]
_OVAL_CENTRE, _OVAL_RADII, _OVAL_LEAN = (-15.0, -22.0), (23.5, 41.0), np.radians(12.0)
EAR_TRIANGLES = 800


def cut_patch(positions, faces):
    """Return the faces (k, 3) of the half head inside the oval, with a clean single border."""
    centre = positions[faces].mean(axis=1)
    cos, sin = np.cos(_OVAL_LEAN), np.sin(_OVAL_LEAN)
    side = (centre[:, [2, 1]] - _OVAL_CENTRE) @ np.array([[cos, -sin], [sin, cos]]) / _OVAL_RADII
    patch = faces[((side**2).sum(axis=1) < 1) & (centre[:, 0] > 45)]
    patch = largest_component(patch, len(positions))
    for _ in range(6):  # trim corner triangles that hang on by one edge
        edges = np.sort(half_edges(patch), axis=1)
        _, inverse, count = np.unique(edges, axis=0, return_inverse=True, return_counts=True)
        open_edges = (count[inverse.ravel()] == 1).reshape(3, -1).sum(axis=0)
        if not (open_edges >= 2).any():
            break
        patch = patch[open_edges < 2]
    return patch


def _collapse_border(faces, keep):
    """Collapse every border vertex that is not in `keep` along the border."""
    while True:
        loop = border_loops(faces)[0]
        extra = [v for v in loop if v not in keep]
        if not extra:
            return faces
        count = len(faces)
        for vertex in extra:
            loop = border_loops(faces)[0]
            k = int(np.flatnonzero(loop == vertex)[0])
            for into in (loop[k - 1], loop[(k + 1) % len(loop)]):
                around = set(faces[vertex_faces(faces, vertex)].ravel())
                common = around & set(faces[vertex_faces(faces, into)].ravel())
                if len(common - {vertex, into}) == 1:
                    faces = collapsed(faces, vertex, into)
                    break
        if len(faces) == count:
            raise RuntimeError("ear: the border of the patch cannot be collapsed to the ring")


def decimate_patch(positions, faces, ring):
    """Decimate a patch by quadrics and fit its border to `ring`.

    Parameters
    ----------
    positions : (n, 3) ndarray
    faces : (m, 3) int ndarray
    ring : (r, 3) ndarray
        Vertices of the patch's border that stay, in order.

    Returns
    -------
    positions : (k, 3) ndarray
        `ring` first.
    faces : (j, 3) ndarray
    """
    simplifier = pyfqmr.Simplify()
    simplifier.setMesh(positions, faces)
    target = EAR_TRIANGLES + len(border_loops(faces)[0]) - len(ring)
    simplifier.simplify_mesh(target_count=target, aggressiveness=8, preserve_border=True, verbose=0)
    positions, faces, _ = (np.array(part) for part in simplifier.getMesh())
    loop = max(border_loops(faces), key=len)
    distance, index = cKDTree(positions[loop]).query(ring)
    if distance.max() > 1e-3:
        raise RuntimeError("ear: a vertex of the ring is missing from the decimated patch")
    ring_vertices = loop[index]
    faces = _collapse_border(faces, set(ring_vertices.tolist()))
    order = np.concatenate([ring_vertices, np.setdiff1d(np.unique(faces), ring_vertices)])
    renumber = np.full(len(positions), -1)
    renumber[order] = np.arange(len(order))
    return positions[order], renumber[faces]
