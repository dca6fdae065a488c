"""Cut polygons into triangles: a fan, and ears where a polygon is not convex."""

from __future__ import annotations

import numpy as np

from risorius._check import FloatArray, IntArray
from risorius.mesh.polygon_mesh import PolygonMesh

__all__ = ["triangulate"]

_HAIR = 1e-12  # share of a polygon's size squared that counts as no area


def triangulate(mesh: PolygonMesh) -> IntArray:
    """Return the corner indices (t, 3) of triangles in polygon order.

    As `PolygonMesh.triangle_corners`, but a polygon whose fan would fold over is cut ear by ear.
    Polygons that cross themselves keep the fan.
    """
    fan = mesh.triangle_corners
    points = mesh.positions[mesh.corners[fan]]
    areas = np.cross(points[:, 1] - points[:, 0], points[:, 2] - points[:, 0])
    polygon = mesh.triangle_polygon
    normals = np.zeros((mesh.polygon_count, 3))
    for axis in range(3):
        normals[:, axis] = np.bincount(polygon, areas[:, axis], mesh.polygon_count)
    folded = np.einsum("ij,ij->i", areas, normals[polygon]) < 0.0
    if not folded.any():
        return fan
    result = fan.copy()
    for index in np.unique(polygon[folded]):
        start, stop = int(mesh.offsets[index]), int(mesh.offsets[index + 1])
        flat = _in_plane(mesh.positions[mesh.corners[start:stop]], normals[index])
        ears = _ears(flat)
        if ears is not None:
            result[polygon == index] = start + ears
    return result


def _in_plane(points: FloatArray, normal: FloatArray) -> FloatArray:
    """Return the points (k, 2) seen against `normal`, so that they run counter-clockwise."""
    normal = normal / np.linalg.norm(normal)
    smallest = np.eye(3)[int(np.argmin(np.abs(normal)))]
    across = smallest - (smallest @ normal) * normal
    across = across / np.linalg.norm(across)
    upward = np.asarray(np.cross(normal, across), dtype=np.float64)
    return np.stack([points @ across, points @ upward], axis=1)


def _ears(points: FloatArray) -> IntArray | None:
    """Return the triangles (k - 2, 3) of a simple polygon (k, 2), or None if it is not simple."""
    hair = _HAIR * float(np.ptp(points, axis=0).max()) ** 2
    left = list(range(len(points)))
    triangles: list[tuple[int, int, int]] = []
    while len(left) > 3:
        # Ears that nothing touches come first; collinear corners may leave only others.
        place = _find_ear(points, left, hair)
        place = _find_ear(points, left, -hair) if place is None else place
        if place is None:
            return None
        triangles.append((left[place - 1], left[place], left[(place + 1) % len(left)]))
        del left[place]
    triangles.append((left[0], left[1], left[2]))
    return np.array(triangles, np.int32)


def _find_ear(points: FloatArray, left: list[int], hair: float) -> int | None:
    """Return the place of a corner that sticks out with no other corner in its triangle.

    A positive `hair` asks for a real area and keeps corners off the border too, a negative one
    allows both.
    """
    for place in range(len(left)):
        ear = [left[place - 1], left[place], left[(place + 1) % len(left)]]
        a, b, c = points[ear]
        others = points[[corner for corner in left if corner not in ear]]
        nearest = np.minimum.reduce([_side(a, b, others), _side(b, c, others), _side(c, a, others)])
        if _side(a, b, c) > hair and not (nearest >= -hair).any():
            return place
    return None


def _side(a: FloatArray, b: FloatArray, c: FloatArray) -> FloatArray:
    """Return twice the area of a, b, c; positive where c lies to the left of a to b."""
    return (b[0] - a[0]) * (c[..., 1] - a[1]) - (b[1] - a[1]) * (c[..., 0] - a[0])
