"""The free part of the skin: graded triangles between midline, neck, lips, lids and ear.

The dense half head is flattened onto a disc, the samples are joined there by a Delaunay
triangulation, and the result is improved in space by flips and relaxation on the skin.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import Delaunay, cKDTree

from .closest import closest_on_mesh
from .disc_map import disc_map
from .ear_patch import cut_patch, decimate_patch
from .fields import polygon
from .marching import half_surface
from .projecting import project, slide
from .recover import recover_edges
from .remesh import collapse_short, flip_edges
from .sampling import Samples, border_samples, poisson_pick, ring_samples
from .size_field import edge_length
from .skin_field import skin_field
from .table import NECK_Y
from .topology import border_loops, compact, half_edges

__all__ = ["Fill", "fill_skin"]

_STEP = 1.5


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


def _cross(u, v):
    return u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]


def _on_disc(dense, disc, points):
    positions, faces = dense
    face, weights, _ = closest_on_mesh(positions, faces, points)
    return np.einsum("ij,ijk->ik", weights, disc[faces[face]])


def _ring_edges(start, count, *, closed):
    k = np.arange(count if closed else count - 1)
    return np.column_stack([start + k, start + (k + 1) % count])


def _free_vertices(dense, disc, fixed, rings):
    """Return dense vertices for the free samples: apart from what is fixed and out of the rings.

    A ring edge is sure to be in the Delaunay triangulation when no sample lies in the circle
    over it (Gabriel condition).
    """
    positions, _ = dense
    wanted = edge_length(positions)
    distance, _ = cKDTree(fixed.positions).query(positions)
    usable = distance > 0.72 * wanted
    tree = cKDTree(disc)
    for ring, closed in rings:
        usable &= polygon(disc, ring) > 0
        following = np.roll(ring, -1, axis=0)
        pairs = (ring, following) if closed else (ring[:-1], following[:-1])
        middle = 0.5 * (pairs[0] + pairs[1])
        radius = 0.54 * np.linalg.norm(pairs[0] - pairs[1], axis=1)
        for centre, reach in zip(middle, radius):
            usable[tree.query_ball_point(centre, reach)] = False
    return poisson_pick(positions, np.flatnonzero(usable))


def _triangulate(disc, rings, locked):
    """Return the Delaunay triangles of `disc` (n, 2), counter-clockwise, without the rings.

    The edges `locked` (k, 2) are among them.
    """
    faces = Delaunay(disc).simplices.astype(int)
    corner = disc[faces]
    area = _cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    faces = np.where(area[:, None] > 0, faces, faces[:, ::-1])[np.abs(area) > 1e-14]
    faces = recover_edges(faces, disc, locked)
    centre = disc[faces].mean(axis=1)
    keep = np.ones(len(faces), bool)
    for ring, _ in rings:
        keep &= polygon(centre, ring) > 0
    return faces[keep]


def _relax(positions, faces, free, locked):
    """Even out the triangles by flips and by moving `free` vertices along the skin."""
    for _ in range(10):
        faces = flip_edges(faces, positions, locked)
        corner = positions[faces]
        centre = corner.mean(axis=1)
        area = np.linalg.norm(
            np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]), axis=1
        )
        weight = np.repeat(area / edge_length(centre) ** 2 + 1e-6, 3)
        total = np.bincount(faces.ravel(), weight, len(positions))
        target = np.stack(
            [
                np.bincount(faces.ravel(), weight * np.repeat(centre[:, k], 3), len(positions))
                for k in range(3)
            ],
            axis=1,
        )
        target /= np.maximum(total, 1e-12)[:, None]
        moved = positions.copy()
        moved[free] = slide(positions[free], target[free], 0.7)
        positions = moved
    return positions, faces


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
    dense = half_surface(skin_field, (0, NECK_Y, -115), (105, 125, 128), _STEP)
    positions, faces = dense
    disc, border = disc_map(positions, faces)
    middle = landmarks[:, 0] < 1e-6
    span = (mouth_row[-1, 1], mouth_row[0, 1])
    edge = border_samples(positions, disc, border, mouth_span=span, landmarks=landmarks[middle])
    anchors = project(landmarks[~middle])
    mouth_disc, anchor_disc, *ring_discs = (
        _on_disc(dense, disc, points) for points in (mouth_row, anchors, *closed_rings)
    )
    mouth_disc[[0, -1]] /= np.linalg.norm(mouth_disc[[0, -1]], axis=1)[:, None]
    patch = cut_patch(positions, faces)
    ear_ring = ring_samples(positions, border_loops(patch)[0])
    fixed = Samples(
        np.vstack([mouth_row, *closed_rings, edge.positions, anchors, positions[ear_ring]]),
        np.vstack([mouth_disc, *ring_discs, edge.disc, anchor_disc, disc[ear_ring]]),
    )
    rings = [(mouth_disc, False), *((r, True) for r in ring_discs), (disc[ear_ring], True)]
    picked = _free_vertices(dense, disc, fixed, rings)
    starts = np.cumsum([0, len(mouth_row), *map(len, closed_rings)])
    start = starts[-1]
    ear_start = len(fixed) - len(ear_ring)
    points = np.vstack([fixed.positions, positions[picked]])
    locked = np.vstack(
        [
            _ring_edges(0, len(mouth_row), closed=False),
            *(_ring_edges(at, len(r), closed=True) for at, r in zip(starts[1:], closed_rings)),
            _ring_edges(ear_start, len(ear_ring), closed=True),
        ]
    )
    triangles = _triangulate(np.vstack([fixed.disc, disc[picked]]), rings, locked)
    corner = disc[faces]
    if np.median(_cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])) < 0:
        triangles = triangles[:, ::-1].copy()
    patch_positions, patch, _ = compact(positions, patch)
    ear_positions, ear_faces = decimate_patch(patch_positions, patch, positions[ear_ring])
    inner = len(ear_positions) - len(ear_ring)
    renumber = np.concatenate(
        [ear_start + np.arange(len(ear_ring)), len(points) + np.arange(inner)]
    )
    ear_vertices = len(points)
    points = np.vstack([points, ear_positions[len(ear_ring) :]])
    faces = np.vstack([triangles, renumber[ear_faces]])
    _require_edges(faces, locked, len(points))
    free = np.zeros(len(points), bool)
    free[ear_start:ear_vertices] = True
    points, faces = _relax(points, faces, free, locked)
    stay = np.zeros(len(points), bool)
    stay[:ear_start] = True
    faces = flip_edges(collapse_short(points, faces, stay, 0.9), points, locked)
    points, faces, used = compact(points, faces)
    if not (used[:start] == np.arange(start)).all():
        raise RuntimeError("fill: a vertex of the loops was lost")
    return Fill(points, faces, _ear_faces(faces, used, ear_vertices))


def _ear_faces(faces, used, ear_vertices):
    """Return a mask (m,) of the faces with a vertex inside the auricle's patch."""
    return (used >= ear_vertices)[faces].any(axis=1)


def _require_edges(faces, edges, vertex_count):
    existing = half_edges(faces)
    keys = existing.min(axis=1) * vertex_count + existing.max(axis=1)
    missing = ~np.isin(edges.min(axis=1) * vertex_count + edges.max(axis=1), keys)
    if missing.any():
        raise RuntimeError(f"fill: {missing.sum()} ring edges are not in the triangulation")
