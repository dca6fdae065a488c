"""Texture coordinates of the skin: head, two ears and mouth bag as separate islands."""

from __future__ import annotations

import numpy as np

from .disc_map import harmonic_map
from .flatten import as_rigid_as_possible, flat_area
from .part import triangles_of
from .topology import border_loops, compact

__all__ = ["skin_uvs"]

# places of the islands, measured from the middle of the unit square
_HALF_HEAD = 0.48
_EAR_CENTRE, _EAR_SIZE = np.array([0.43, -0.41]), 0.13
_BAG_CENTRE, _BAG_RADIUS = np.array([-0.4, 0.4]), 0.09
# where an island meets its mirror image; the ears do not
_AXIS = {"head": 0.0, "ear": None, "bag": float(_BAG_CENTRE[0])}
_ISLAND_OF_GROUP = {"mouth_bag": "bag", "ear_left": "ear"}


def _plugged(positions, faces):
    """Close all borders but the longest by fans, so that the patch becomes a disc."""
    loops = sorted(border_loops(faces), key=len)
    for loop in loops[:-1]:
        centre = len(positions)
        positions = np.vstack([positions, positions[loop].mean(axis=0)])
        fan = np.column_stack([np.roll(loop, -1), loop, np.full(len(loop), centre)])
        faces = np.vstack([faces, fan])
    return positions, faces, loops[-1]


def _disc_start(positions, faces, border, first):
    """Return a start in the disc: `border` by arc length on a circle from its vertex `first`."""
    border = np.roll(border, -int(np.flatnonzero(border == first)[0]))
    step = np.linalg.norm(np.roll(positions[border], -1, axis=0) - positions[border], axis=1)
    share = np.concatenate([[0.0], np.cumsum(step)[:-1]]) / step.sum()
    radius = step.sum() / (2 * np.pi)
    angle = 2 * np.pi * share + 0.5 * np.pi
    circle = radius * np.column_stack([np.cos(angle), np.sin(angle)])
    return harmonic_map(positions, faces, border, circle)


def _unfold(positions, faces, axis_vertices):
    """Return uvs (k, 2) of the used vertices and their numbers.

    The first of `axis_vertices` is a vertex of the border that ends up on top; all of them
    stay on u = 0.
    """
    solid, local, used = compact(positions, faces)
    plugged, closed, border = _plugged(solid, local)
    on_axis = np.searchsorted(used, axis_vertices)
    start = _disc_start(plugged, closed, border, int(on_axis[0]))
    if flat_area(start, closed).sum() < 0:
        start = start * [-1, 1]
    return as_rigid_as_possible(plugged, closed, start, on_axis=on_axis)[: len(used)], used


def _head_island(positions, faces):
    """Return uvs of the head: the front of the midline is straight, the back is the seam."""
    used = np.unique(faces)
    midline = used[positions[used, 0] == 0.0]
    crown = midline[positions[midline, 1].argmax()]
    front = midline[positions[midline, 2] > positions[crown, 2]]
    uvs, used = _unfold(positions, faces, np.concatenate([[crown], front]))
    top, bottom = uvs[:, 1].max(), uvs[:, 1].min()
    scale = _HALF_HEAD / max(np.abs(uvs[:, 0]).max(), 0.5 * (top - bottom))
    return (uvs - [0.0, 0.5 * (top + bottom)]) * scale, used


def _ear_island(positions, faces):
    """Return uvs of the left ear, the top of its patch upwards."""
    border = border_loops(faces)[0]
    top = border[positions[border, 1].argmax()]
    uvs, used = _unfold(positions, faces, np.array([top]))
    middle = 0.5 * (uvs.max(axis=0) + uvs.min(axis=0))
    return (uvs - middle) / np.ptp(uvs, axis=0).max() * _EAR_SIZE + _EAR_CENTRE, used


def _bag_island(half):
    """Return uvs of the left half of the bag: columns by angle, rows by radius."""
    rows = half.mouth_rows[half.mouth_margin :]
    angle = np.linspace(0.5 * np.pi, -0.5 * np.pi, len(rows[0]))
    around = np.column_stack([np.cos(angle), np.sin(angle)])
    around[[0, -1], 0] = 0.0
    radius = np.linspace(1.0, 0.1, len(rows))
    uvs = (radius[:, None, None] * around).reshape(-1, 2)
    return uvs * _BAG_RADIUS + _BAG_CENTRE, np.concatenate(rows)


def skin_uvs(half, groups):
    """Return texture coordinates of the whole skin.

    Returns
    -------
    uvs : (k, 2) ndarray
    polygons : list of tuple of int
        For the left half, then for its mirror image, in the order of `half.polygons`.
    """
    islands = [_ISLAND_OF_GROUP.get(group, "head") for group in groups]
    faces = {
        name: triangles_of([p for p, island in zip(half.polygons, islands) if island == name])
        for name in ("head", "ear")
    }
    parts = {
        "head": _head_island(half.positions, faces["head"]),
        "ear": _ear_island(half.positions, faces["ear"]),
        "bag": _bag_island(half),
    }
    tables = {name: np.full((len(half.positions), 2), np.nan) for name in parts}
    for name, (uvs, used) in parts.items():
        tables[name][used] = uvs
    return _numbered(tables, half.polygons, islands)


def _numbered(tables, polygons, islands):
    """Number the texture coordinates of both halves; shared where an island meets its image."""
    uvs, number = [], {}

    def index(island, vertex, *, mirrored):
        u, v = tables[island][vertex]
        axis = _AXIS[island]
        mirrored = mirrored and (axis is None or abs(u - axis) > 1e-9)
        key = (island, vertex, mirrored)
        if key not in number:
            number[key] = len(uvs)
            uvs.append((0.5 + (2 * (axis or 0.0) - u if mirrored else u), 0.5 + v))
        return number[key]

    left = [
        tuple(index(island, v, mirrored=False) for v in polygon)
        for polygon, island in zip(polygons, islands)
    ]
    right = [
        tuple(index(island, v, mirrored=True) for v in (polygon[0], *polygon[:0:-1]))
        for polygon, island in zip(polygons, islands)
    ]
    return np.array(uvs), left + right
