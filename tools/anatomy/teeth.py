"""Teeth: one closed crown per tooth, set along the two dental arches."""

from __future__ import annotations

import numpy as np

from .arches import ARCHES, crowns
from .part import Part

__all__ = ["teeth_part"]

_CELLS = (4, 4, 3)


def _crown_field(crown, points):
    """Field (n,) of a crown at `points` (n, 3): a superellipsoid that tapers along its height."""
    width, height, depth = crown.size
    local = (points - crown.centre) @ crown.turn
    rise = (points[:, 1] - crown.edge) * crown.sign / height  # 0 at the edge, 1 at the gum
    if crown.anterior:
        half_depth = 0.5 * depth * np.clip(0.30 + 0.75 * rise, 0.3, 1.0)
    else:
        half_depth = 0.5 * depth * np.clip(0.8 + 0.25 * rise, 0.7, 1.0)
    half_width = 0.485 * width * (1 - 0.10 * np.clip(rise, 0.0, 1.0))
    reach = (
        np.abs(local[:, 0] / half_width) ** 4
        + np.abs(local[:, 2] / half_depth) ** (3 if crown.anterior else 4)
        + np.abs((rise - 0.55) / 0.60) ** 6
    )
    return np.sqrt(reach + 1e-9) - 1.0


def _face_cells(cells, axis):
    """Return the grid corners (4 k, 3) of the cells on both sides across `axis`, outward."""
    u, v = (axis + 1) % 3, (axis + 2) % 3
    corners = []
    for side, order in ((0, (0, 3, 2, 1)), (cells[axis], (0, 1, 2, 3))):
        for i, j in np.ndindex(cells[u], cells[v]):
            square = np.zeros((4, 3), int)
            square[:, axis] = side
            square[:, u] = i + np.array([0, 1, 1, 0])
            square[:, v] = j + np.array([0, 0, 1, 1])
            corners.append(square[list(order)])
    return np.concatenate(corners)


def _cube_sphere(cells):
    """Return unit directions (n, 3) and quads of a rounded cube with `cells` (3,) per edge."""
    cells = np.asarray(cells)
    corners = np.concatenate([_face_cells(cells, axis) for axis in range(3)])
    grid, index = np.unique(corners, axis=0, return_inverse=True)
    # the tangent keeps the cells of the rounded cube about equal
    shell = np.tan((2.0 * grid / cells - 1.0) * np.pi / 4)
    directions = shell / np.linalg.norm(shell, axis=1)[:, None]
    return directions, [tuple(quad) for quad in index.reshape(-1, 4).tolist()]


def _crown_surface(crown, directions):
    """Return the points (n, 3) where rays from the middle of the crown leave its field."""
    start = crown.centre + np.array([0.0, crown.edge + 0.5 * crown.sign * crown.size[1], 0.0])
    ray = directions * crown.size @ crown.turn.T
    ray /= np.linalg.norm(ray, axis=1)[:, None]
    near, far = np.zeros(len(ray)), np.full(len(ray), 12.0)
    for _ in range(40):
        middle = 0.5 * (near + far)
        inside = _crown_field(crown, start + ray * middle[:, None]) < 0
        near, far = np.where(inside, middle, near), np.where(inside, far, middle)
    return start + ray * near[:, None]


def teeth_part(which):
    """Return the teeth of the "upper" or "lower" arch, each followed by its mirror image."""
    directions, quads = _cube_sphere(_CELLS)
    flipped = [(q[0], *q[:0:-1]) for q in quads]
    positions, polygons, count = [], [], 0
    for crown in crowns(ARCHES[which]):
        surface = _crown_surface(crown, directions)
        for sign, faces in ((1, quads), (-1, flipped)):
            positions.append(surface * [sign, 1, 1])
            polygons += [tuple(v + count for v in face) for face in faces]
            count += len(surface)
    name = f"teeth_{which}"
    labels = [name] * len(polygons), ["teeth"] * len(polygons)
    return Part(name, np.vstack(positions), polygons, *labels)
