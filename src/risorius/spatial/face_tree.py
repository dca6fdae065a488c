"""A tree of boxes over triangles that finds the closest face whose normal agrees.

The tree is a complete binary one over the faces in Morton order, so that its boxes are plain
array reductions. Besides the corners every box bounds the normals below it: a subtree in which
no normal can agree is skipped as a whole.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from numba import njit

from risorius._check import FloatArray, IntArray

__all__ = ["FaceTree"]

_LEAF = 4
_DEPTH = 64


class FaceTree:
    """Faces sorted for searches by distance and normal.

    Parameters
    ----------
    corners : (f, 3, 3) float64
        Corner positions of the faces [mm].
    normals : (f, 3) float64
        Their unit normals.
    """

    def __init__(self, corners: FloatArray, normals: FloatArray) -> None:
        order = _morton_order(corners.mean(axis=1))
        self._order = order.astype(np.int32)
        self._corners = np.ascontiguousarray(corners[order])
        self._normals = np.ascontiguousarray(normals[order])
        leaves = -(-len(corners) // _LEAF)
        leaves = 1 << max(leaves - 1, 0).bit_length()
        box = (self._corners.min(axis=1), self._corners.max(axis=1))
        self._boxes = _levels(*box, leaves=leaves)
        self._cones = _levels(self._normals, self._normals, leaves=leaves)

    def closest(self, points: FloatArray, normals: FloatArray, least: float) -> IntArray:
        """Return the closest face (q,) whose normal times the query's is at least `least`.

        Parameters
        ----------
        points : (q, 3) float64
            Query points [mm].
        normals : (q, 3) float64
            Unit normals that faces are compared with.
        least : float
            Cosine of the largest angle.

        Returns
        -------
        (q,) int32
            -1 where no face agrees.
        """
        nodes, faces = (self._boxes, self._cones), (self._corners, self._normals)
        found = _search_all(
            np.ascontiguousarray(points), np.ascontiguousarray(normals), least, nodes, faces
        )
        return np.where(found >= 0, self._order[found], -1).astype(np.int32)


def _morton_order(centres: FloatArray) -> npt.NDArray[np.intp]:
    low, high = centres.min(axis=0), centres.max(axis=0)
    extent = np.where(high > low, high - low, 1.0)
    cells = np.minimum((centres - low) / extent * 1024.0, 1023.0).astype(np.int64)
    code = np.zeros(len(centres), np.int64)
    for bit in range(10):
        for axis in range(3):
            code |= ((cells[:, axis] >> bit) & 1) << (3 * bit + axis)
    return np.argsort(code, kind="stable")


def _levels(low: FloatArray, high: FloatArray, *, leaves: int) -> FloatArray:
    """Return the boxes (2 leaves - 1, 2, 3) of all nodes, root first, children 2i+1 and 2i+2."""
    padded = np.empty((leaves * _LEAF, 2, 3))
    padded[:, 0], padded[:, 1] = np.inf, -np.inf
    padded[: len(low), 0], padded[: len(low), 1] = low, high
    boxes = np.empty((2 * leaves - 1, 2, 3))
    level, group = padded, _LEAF
    first = leaves - 1
    while True:
        parts = level.reshape(-1, group, 2, 3)
        level = np.stack([parts[:, :, 0].min(axis=1), parts[:, :, 1].max(axis=1)], axis=1)
        boxes[first : first + len(level)] = level
        if first == 0:
            return boxes
        first, group = (first - 1) // 2, 2


@njit(cache=True, inline="always")
def _dot(first, second):  # pyright: ignore
    return first[0] * second[0] + first[1] * second[1] + first[2] * second[2]


@njit(cache=True, inline="always")
def _minus(first, second):  # pyright: ignore
    return first[0] - second[0], first[1] - second[1], first[2] - second[2]


@njit(cache=True, inline="always")
def _length(foot, first, second, u, v):  # pyright: ignore
    x = foot[0] - u * first[0] - v * second[0]
    y = foot[1] - u * first[1] - v * second[1]
    z = foot[2] - u * first[2] - v * second[2]
    return x * x + y * y + z * z


@njit(cache=True)
def _box_gap(box, point):  # pyright: ignore
    gap = 0.0
    for axis in range(3):
        if point[axis] < box[0, axis]:
            gap += (box[0, axis] - point[axis]) ** 2
        elif point[axis] > box[1, axis]:
            gap += (point[axis] - box[1, axis]) ** 2
    return gap


@njit(cache=True)
def _may_agree(cone, normal, least):  # pyright: ignore
    best = 0.0
    for axis in range(3):
        best += max(cone[0, axis] * normal[axis], cone[1, axis] * normal[axis])
    return best >= least


@njit(cache=True)
def _triangle_gap(point, corners):  # pyright: ignore
    """Return the squared distance to a triangle, region by region (Ericson 2005, 5.1.5)."""
    a = (corners[0, 0], corners[0, 1], corners[0, 2])
    b = (corners[1, 0], corners[1, 1], corners[1, 2])
    c = (corners[2, 0], corners[2, 1], corners[2, 2])
    ab, ac, ap = _minus(b, a), _minus(c, a), _minus(point, a)
    d1, d2 = _dot(ab, ap), _dot(ac, ap)
    if d1 <= 0.0 and d2 <= 0.0:
        return _dot(ap, ap)
    bp = _minus(point, b)
    d3, d4 = _dot(ab, bp), _dot(ac, bp)
    if d3 >= 0.0 and d4 <= d3:
        return _dot(bp, bp)
    cp = _minus(point, c)
    d5, d6 = _dot(ab, cp), _dot(ac, cp)
    if d6 >= 0.0 and d5 <= d6:
        return _dot(cp, cp)
    va, vb, vc = d3 * d6 - d5 * d4, d5 * d2 - d1 * d6, d1 * d4 - d3 * d2
    if vc <= 0.0 and d1 >= 0.0 and d3 <= 0.0:
        return _length(ap, ab, ac, d1 / (d1 - d3), 0.0)
    if vb <= 0.0 and d2 >= 0.0 and d6 <= 0.0:
        return _length(ap, ab, ac, 0.0, d2 / (d2 - d6))
    if va <= 0.0 and d4 >= d3 and d5 >= d6:
        w = (d4 - d3) / ((d4 - d3) + (d5 - d6))
        return _length(ap, ab, ac, 1.0 - w, w)
    total = va + vb + vc
    return _length(ap, ab, ac, vb / total, vc / total)


@njit(cache=True)
def _search(point, normal, least, nodes, faces):  # pyright: ignore
    """Return the closest agreeing face of one query; nodes and faces as (boxes, cones)."""
    boxes, cones = nodes
    corners, normals = faces
    first_leaf = len(boxes) // 2
    stack = np.empty(_DEPTH, np.int64)
    stack[0], height = 0, 1
    best, result = np.inf, -1
    while height > 0:
        height -= 1
        node = stack[height]
        if _box_gap(boxes[node], point) >= best:
            continue
        if node >= first_leaf:
            start = (node - first_leaf) * _LEAF
            for face in range(start, min(start + _LEAF, len(corners))):
                if _dot(normals[face], normal) >= least:
                    gap = _triangle_gap(point, corners[face])
                    if gap < best:
                        best, result = gap, face
            continue
        left, right = 2 * node + 1, 2 * node + 2
        if _box_gap(boxes[left], point) < _box_gap(boxes[right], point):
            left, right = right, left
        # The nearer child is pushed last and so searched first.
        for child in (left, right):
            if _may_agree(cones[child], normal, least):
                stack[height] = child
                height += 1
    return result


@njit(cache=True)
def _search_all(points, wanted, least, nodes, faces):  # pyright: ignore
    result = np.full(len(points), -1, np.int64)
    for query in range(len(points)):
        point = (points[query, 0], points[query, 1], points[query, 2])
        normal = (wanted[query, 0], wanted[query, 1], wanted[query, 2])
        result[query] = _search(point, normal, least, nodes, faces)
    return result
