"""Texture coordinates of the skin: head, two ears and mouth bag as separate islands."""

from __future__ import annotations

import numpy as np

from .disc_map import harmonic_map
from .flatten import as_rigid_as_possible, flat_area
from .part import triangles_of
from .topology import border_loops, compact

__all__ = ["skin_uvs"]

# places of the islands in the unit square
_HEAD_BOX = ((0.02, 0.02), (0.98, 0.98))
_EAR_CENTRE, _EAR_SIZE = (0.07, 0.09), 0.13
_BAG_CENTRE, _BAG_RADIUS = (0.1, 0.9), 0.09


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


def _unfold(positions, faces, *, axis_vertices, first):
    """Return uvs of the used vertices, with those of `axis_vertices` on u = 0."""
    solid, used = compact(positions, faces)[::2]
    local = np.searchsorted(used, faces)
    plugged, closed, border = _plugged(solid, local)
    start = _disc_start(plugged, closed, border, int(np.searchsorted(used, first)))
    on_axis = np.searchsorted(used, axis_vertices)
    if flat_area(start, closed).sum() < 0:
        start = start * [-1, 1]
    uvs = as_rigid_as_possible(plugged, closed, start, on_axis=on_axis)
    return uvs[: len(used)], used


def _bag_uvs(half, vertex_count):
    """Return uvs (n, 2) of the bag by row and column, half a disc each for left and right."""
    uvs = np.full((vertex_count, 2), np.nan)
    rows = half.mouth_rows[half.mouth_margin :]
    for depth, row in enumerate(rows):
        angle = np.linspace(0.5 * np.pi, -0.5 * np.pi, len(row))
        radius = 1.0 - 0.9 * depth / (len(rows) - 1)
        uvs[row] = radius * np.column_stack([np.cos(angle), np.sin(angle)])
        uvs[row[[0, -1]], 0] = 0.0
    return uvs


def skin_uvs(half, groups):
    """Return texture coordinates of the whole skin.

    Returns
    -------
    uvs : (k, 2) ndarray
    polygons : list of tuple of int
        For the left half, then for its mirror image, in the order of `half.polygons`.
    """
    positions, polygons = half.positions, half.polygons
    of = {name: [k for k, g in enumerate(groups) if _island(g) == name] for name in _ISLANDS}
    faces = {name: triangles_of([polygons[k] for k in of[name]]) for name in ("head", "ear")}
    midline = np.flatnonzero(positions[:, 0] == 0.0)
    head_vertices = np.unique(faces["head"])
    midline = midline[np.isin(midline, head_vertices)]
    crown = midline[positions[midline, 1].argmax()]
    front = midline[(positions[midline, 2] > positions[crown, 2]) | (midline == crown)]
    front = np.concatenate([[crown], front[front != crown]])
    head, head_used = _unfold(positions, faces["head"], axis_vertices=front, first=crown)
    ear_first = faces["ear"][0, 0]
    border = border_loops(faces["ear"])[0]
    ear_first = border[positions[border, 1].argmax()]
    ear, ear_used = _unfold(
        positions, faces["ear"], axis_vertices=np.array([ear_first]), first=ear_first
    )
    n = len(positions)
    tables = {name: np.full((n, 2), np.nan) for name in _ISLANDS}
    low, high = np.array(_HEAD_BOX)
    size = np.array([2 * np.abs(head[:, 0]).max(), np.ptp(head[:, 1])])
    scale = ((high - low) / size).min()
    centre = np.array([0.0, 0.5 * (head[:, 1].max() + head[:, 1].min())])
    tables["head"][head_used] = (head - centre) * scale
    middle = 0.5 * (ear.max(axis=0) + ear.min(axis=0))
    ear = (ear - middle) / np.ptp(ear, axis=0).max() * _EAR_SIZE
    tables["ear"][ear_used] = ear + [0.5 - _EAR_CENTRE[0], _EAR_CENTRE[1] - 0.5]
    tables["bag"] = _bag_uvs(half, n) * _BAG_RADIUS + np.subtract(_BAG_CENTRE, 0.5)
    return _numbered(tables, polygons, groups)


_ISLANDS = ("head", "ear", "bag")


def _island(group):
    if group == "mouth_bag":
        return "bag"
    return "ear" if group == "ear_left" else "head"


def _numbered(tables, polygons, groups):
    """Number the texture coordinates of both halves; shared where an island meets its image."""
    uvs, number, left, right = [], {}, [], []
    axis = {"head": 0.0, "ear": None, "bag": _BAG_CENTRE[0] - 0.5}

    def index(island, vertex, mirrored):
        place = tables[island][vertex]
        if axis[island] is not None and abs(place[0] - axis[island]) < 1e-9:
            mirrored = False
        key = (island, vertex, mirrored)
        if key not in number:
            number[key] = len(uvs)
            about = 2 * (axis[island] or 0.0)
            u = about - place[0] if mirrored else place[0]
            uvs.append((u + 0.5, place[1] + 0.5))
        return number[key]

    for polygon, group in zip(polygons, groups):
        island = _island(group)
        left.append(tuple(index(island, v, False) for v in polygon))
    for polygon, group in zip(polygons, groups):
        island = _island(group)
        flipped = (polygon[0], *polygon[:0:-1])
        right.append(tuple(index(island, v, True) for v in flipped))
    return np.array(uvs), left + right
