"""The free part of the skin: graded triangles between midline, neck, lips, lids and ear.

The dense half head is flattened onto a disc, the samples are joined there by a Delaunay
triangulation, and the result is improved in space by flips and relaxation on the skin.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import Delaunay, cKDTree

from .dense import dense_half
from .ear_patch import decimate_patch
from .fields import polygon
from .outline import outline_of
from .projecting import slide
from .recover import recover_edges
from .remesh import collapse_short, flip_edges
from .sampling import poisson_pick
from .size_field import edge_length
from .topology import compact, half_edges

__all__ = ["Fill", "fill_skin"]

_RELAXATIONS = 10
_SHORTEST_EDGE = 0.9


@dataclass(frozen=True)
class Fill:
    """Free part of the left half of the skin.

    Parameters
    ----------
    positions : (n, 3) ndarray
        The outermost row of the mouth, then the closed rings, then the rest [mm].
    faces : (m, 3) int ndarray
    in_ear : (m,) bool ndarray
        Faces of the auricle's patch.
    """

    positions: np.ndarray
    faces: np.ndarray
    in_ear: np.ndarray


def _free_vertices(dense, outline):
    """Return dense vertices for the free samples: apart from what is fixed and out of the rings.

    A ring edge is sure to be in the Delaunay triangulation when no sample lies in the circle
    over it (Gabriel condition).
    """
    wanted = edge_length(dense.positions)
    distance, _ = cKDTree(outline.samples.positions).query(dense.positions)
    usable = distance > 0.72 * wanted
    tree = cKDTree(dense.disc)
    for ring, closed in outline.rings:
        usable &= polygon(dense.disc, ring) > 0
        following = np.roll(ring, -1, axis=0)
        a, b = (ring, following) if closed else (ring[:-1], following[:-1])
        reach = 0.54 * np.linalg.norm(a - b, axis=1)
        for near in tree.query_ball_point(0.5 * (a + b), reach):
            usable[near] = False
    return poisson_pick(dense.positions, np.flatnonzero(usable))


def _triangulate(disc, outline):
    """Return triangles of `disc` (n, 2) that contain the outline, counter-clockwise, no rings."""
    faces = Delaunay(disc).simplices.astype(int)
    corner = disc[faces]
    u, v = corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]
    area = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]
    faces = np.where(area[:, None] > 0, faces, faces[:, ::-1])[np.abs(area) > 1e-14]
    faces = recover_edges(faces, disc, outline.locked)
    centre = disc[faces].mean(axis=1)
    keep = np.ones(len(faces), bool)
    for ring, _ in outline.rings:
        keep &= polygon(centre, ring) > 0
    return faces[keep]


def _with_ear(dense, outline, positions, faces):
    """Append the decimated auricle to positions (n, 3) and faces (m, 3)."""
    patch_positions, patch, _ = compact(dense.positions, outline.ear_patch)
    ring = dense.positions[outline.ear_ring]
    ear_positions, ear_faces = decimate_patch(patch_positions, patch, ring)
    inner = ear_positions[len(ring) :]
    renumber = np.concatenate(
        [outline.ear_start + np.arange(len(ring)), len(positions) + np.arange(len(inner))]
    )
    return np.vstack([positions, inner]), np.vstack([faces, renumber[ear_faces]])


def _weighted_centres(positions, faces):
    """Return where each vertex (n, 3) would be at the centre of its faces, graded by size."""
    corner = positions[faces]
    centre = corner.mean(axis=1)
    u, v = corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]
    area = np.linalg.norm(np.cross(u, v), axis=1)
    weight = np.repeat(area / edge_length(centre) ** 2 + 1e-6, 3)
    total = np.bincount(faces.ravel(), weight, len(positions))
    sums = [
        np.bincount(faces.ravel(), weight * np.repeat(column, 3), len(positions))
        for column in centre.T
    ]
    return np.stack(sums, axis=1) / np.maximum(total, 1e-12)[:, None]


def _relax(positions, faces, free, locked):
    """Even out the triangles by flips and by moving `free` vertices along the skin."""
    for _ in range(_RELAXATIONS):
        faces = flip_edges(faces, positions, locked)
        target = _weighted_centres(positions, faces)
        positions = positions.copy()
        positions[free] = slide(positions[free], target[free], 0.7)
    return positions, faces


def _require_edges(faces, edges, vertex_count):
    existing = np.sort(half_edges(faces), axis=1) @ [vertex_count, 1]
    missing = ~np.isin(np.sort(edges, axis=1) @ [vertex_count, 1], existing)
    if missing.any():
        raise RuntimeError(f"fill: {missing.sum()} ring edges are not in the triangulation")


def fill_skin(mouth_row, closed_rings, landmarks):
    """Return the free part of the left half of the skin.

    Parameters
    ----------
    mouth_row : (c, 3) ndarray
        Outermost row of the mouth [mm].
    closed_rings : list of (c, 3) ndarray
        Outermost rows of closed loops; what lies inside of them is left out [mm].
    landmarks : (k, 3) ndarray
        Places that must become vertices; on the midline where x = 0 [mm].
    """
    dense = dense_half()
    outline = outline_of(dense, mouth_row, closed_rings, landmarks)
    picked = _free_vertices(dense, outline)
    positions = np.vstack([outline.samples.positions, dense.positions[picked]])
    faces = _triangulate(np.vstack([outline.samples.disc, dense.disc[picked]]), outline)
    if not dense.keeps_orientation:
        faces = faces[:, ::-1].copy()
    ear_vertices = len(positions)
    positions, faces = _with_ear(dense, outline, positions, faces)
    _require_edges(faces, outline.locked, len(positions))
    free = np.zeros(len(positions), bool)
    free[outline.ear_start : ear_vertices] = True
    positions, faces = _relax(positions, faces, free, outline.locked)
    fixed = np.arange(len(positions)) < outline.ear_start
    faces = collapse_short(positions, faces, fixed, _SHORTEST_EDGE)
    faces = flip_edges(faces, positions, outline.locked)
    positions, faces, used = compact(positions, faces)
    if not (used[: outline.loop_count] == np.arange(outline.loop_count)).all():
        raise RuntimeError("fill: a vertex of the loops was lost")
    in_ear = (used >= ear_vertices)[faces].any(axis=1)
    return Fill(positions, faces, in_ear)
