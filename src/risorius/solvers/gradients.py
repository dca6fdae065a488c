"""Value and gradient of every constraint, for many of them at once (spec: table of section 2.1).

The readable truth: tests compare it with central differences and the compiled formulas with it;
residuals and rest values are computed by it. Each `*_value` has its `*_gradient`.
"""

from __future__ import annotations

import numpy as np

from risorius._check import FloatArray, IntArray

__all__ = [
    "area_gradient",
    "area_value",
    "bend_gradient",
    "bend_value",
    "contact_gradient",
    "contact_value",
    "distance_gradient",
    "distance_value",
    "hold_gradient",
    "hold_value",
    "volume_gradient",
    "volume_value",
]


def _dot(first: FloatArray, second: FloatArray) -> FloatArray:
    return np.einsum("...i,...i->...", first, second)


def _over(vectors: FloatArray, lengths: FloatArray) -> FloatArray:
    """Divide each vector by its number; 0 where the number is 0."""
    result = np.zeros_like(vectors)
    np.divide(vectors, lengths[..., None], out=result, where=lengths[..., None] != 0.0)
    return result


def distance_value(points: FloatArray) -> FloatArray:
    """Return |p1 - p2| (...,) of points (..., 2, 3)."""
    return np.linalg.norm(points[..., 0, :] - points[..., 1, :], axis=-1)


def distance_gradient(points: FloatArray) -> FloatArray:
    """Return the gradient (..., 2, 3): u, -u with u = (p1 - p2) / |p1 - p2|."""
    u = points[..., 0, :] - points[..., 1, :]
    u = _over(u, np.linalg.norm(u, axis=-1))
    return np.stack([u, -u], axis=-2)


def hold_value(points: FloatArray, targets: FloatArray) -> FloatArray:
    """Return |p - q| (...,) of points (..., 3) and targets (..., 3)."""
    return np.linalg.norm(points - targets, axis=-1)


def hold_gradient(points: FloatArray, targets: FloatArray) -> FloatArray:
    """Return the gradient (..., 3) of points (..., 3), targets (..., 3): (p - q) / |p - q|."""
    offset = points - targets
    return _over(offset, np.linalg.norm(offset, axis=-1))


def contact_value(points: FloatArray, places: FloatArray, normals: FloatArray) -> FloatArray:
    """Return (p - q) . n (...,), negative inside; points, places (..., 3), normals (..., 3)."""
    return _dot(points - places, normals)


def contact_gradient(points: FloatArray, places: FloatArray, normals: FloatArray) -> FloatArray:
    """Return the gradient (..., 3), the normal itself; points, places (..., 3)."""
    return np.broadcast_to(normals, np.broadcast_shapes(points.shape, places.shape)).copy()


def area_value(points: FloatArray) -> FloatArray:
    """Return the area (...,) of triangles (..., 3, 3)."""
    first, second, third = (points[..., corner, :] for corner in range(3))
    return 0.5 * np.linalg.norm(np.cross(second - first, third - first), axis=-1)


def area_gradient(points: FloatArray) -> FloatArray:
    """Return the gradient (..., 3, 3): g1 = n x (p3 - p2) / 2 and cyclic, n the unit normal."""
    first, second, third = (points[..., corner, :] for corner in range(3))
    n = np.cross(second - first, third - first)
    half = 0.5 * _over(n, np.linalg.norm(n, axis=-1))
    sides = (third - second, first - third, second - first)
    return np.stack([np.cross(half, side) for side in sides], axis=-2)


def _flaps(points: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    p1, p2, p3, p4 = (points[..., corner, :] for corner in range(4))
    e = p2 - p1
    return e, np.cross(e, p3 - p1), np.cross(p4 - p1, e)


def bend_value(points: FloatArray) -> FloatArray:
    """Return the signed dihedral angle (...,) of flaps (..., 4, 3), 0 where flat [rad].

    theta = atan2((n1 x n2) . e / |e|, n1 . n2), see `Bends`; positive where the surface
    bulges towards the side that n1 points to.
    """
    e, n1, n2 = _flaps(points)
    unit = _over(e, np.linalg.norm(e, axis=-1))
    return np.arctan2(_dot(np.cross(n1, n2), unit), _dot(n1, n2))


def bend_gradient(points: FloatArray) -> FloatArray:
    """Return the gradient (..., 4, 3), regular where flat.

    With N1 = n1 / |n1|^2, N2 = n2 / |n2|^2: g3 = -|e| N1, g4 = -|e| N2,
    g1 = -(((p3 - p2) . e) N1 + ((p4 - p2) . e) N2) / |e|,
    g2 = -(((p1 - p3) . e) N1 + ((p1 - p4) . e) N2) / |e|.
    """
    p1, p2, p3, p4 = (points[..., corner, :] for corner in range(4))
    e, n1, n2 = _flaps(points)
    length = np.linalg.norm(e, axis=-1)
    unit = _over(e, length)
    N1, N2 = _over(n1, _dot(n1, n1)), _over(n2, _dot(n2, n2))
    g1 = -(_dot(p3 - p2, unit)[..., None] * N1 + _dot(p4 - p2, unit)[..., None] * N2)
    g2 = -(_dot(p1 - p3, unit)[..., None] * N1 + _dot(p1 - p4, unit)[..., None] * N2)
    return np.stack([g1, g2, -length[..., None] * N1, -length[..., None] * N2], axis=-2)


def _with_caps(
    positions: FloatArray, faces: IntArray, holes: tuple[IntArray, ...]
) -> tuple[FloatArray, IntArray]:
    """Append the centroid of each hole and the fan (against the rim's sense) that closes it."""
    places, tables = [positions], [faces]
    for row, rim in enumerate(holes, start=len(positions)):
        places.append(positions[rim].mean(axis=0)[None])
        fan = np.stack([np.roll(rim, -1), rim, np.full(len(rim), row, np.int32)], axis=1)
        tables.append(fan.astype(np.int32))
    return np.concatenate(places), np.concatenate(tables)


def volume_value(
    positions: FloatArray, faces: IntArray, *, holes: tuple[IntArray, ...] = ()
) -> float:
    """Return 1/6 sum (p_a x p_b) . p_c over `faces` and the caps of `holes` [mm^3]."""
    points, closed = _with_caps(positions, faces, holes)
    a, b, c = (points[closed[:, corner]] for corner in range(3))
    return float(_dot(np.cross(a, b), c).sum() / 6.0)


def volume_gradient(
    positions: FloatArray, faces: IntArray, *, holes: tuple[IntArray, ...] = ()
) -> FloatArray:
    """Return the gradient (n, 3): p_b x p_c / 6 of each face at a, and cyclic.

    The gradient at a cap's centroid is spread in equal shares over its rim.
    """
    points, closed = _with_caps(positions, faces, holes)
    result = np.zeros_like(points)
    for corner in range(3):
        b, c = closed[:, (corner + 1) % 3], closed[:, (corner + 2) % 3]
        np.add.at(result, closed[:, corner], np.cross(points[b], points[c]) / 6.0)
    for row, rim in enumerate(holes, start=len(positions)):
        np.add.at(result, rim, result[row] / len(rim))
    return result[: len(positions)]
