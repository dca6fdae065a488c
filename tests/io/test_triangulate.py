"""Cutting polygons into triangles."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from risorius.io.triangulate import triangulate
from risorius.mesh.polygon_mesh import PolygonMesh

COMB = [[0, 0], [7, 0], [7, 3], [6, 1], [5, 3], [4, 1], [3, 3], [2, 1], [1, 3], [1, 1], [0, 3]]


def area(points: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    a, b, c = (points[triangles[:, i]] for i in range(3))
    return np.cross(b - a, c - a) / 2


def polygon(points, start: int = 0) -> PolygonMesh:
    order = np.roll(np.arange(len(points)), -start)
    return PolygonMesh.from_polygons(np.asarray(points, float), [order.tolist()])


def shoelace(flat: np.ndarray) -> float:
    x, y = flat.T
    return float(x @ np.roll(y, -1) - y @ np.roll(x, -1)) / 2


@given(st.integers(0, 10), st.integers(0, 2**32 - 1))
def test_a_concave_polygon_is_covered_exactly_once_in_every_pose(start, seed):
    turn = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))[0]
    turn *= np.sign(np.linalg.det(turn))
    flat = np.pad(np.array(COMB, float), ((0, 0), (0, 1)))
    mesh = polygon(flat @ turn.T + [5, -3, 2], start)
    triangles = mesh.corners[triangulate(mesh)]
    signed = area(mesh.positions, triangles) @ turn[:, 2]
    assert (signed > -1e-9).all()
    assert signed.sum() == pytest.approx(shoelace(np.array(COMB, float)))
    assert len(triangles) == len(COMB) - 2


@given(st.lists(st.integers(3, 9), min_size=1, max_size=6))
def test_convex_polygons_keep_the_fan(sizes):
    rings = [np.linspace(0, 2 * np.pi, size, endpoint=False) for size in sizes]
    points = np.concatenate([np.stack([np.cos(r), np.sin(r), 0 * r], axis=1) for r in rings])
    starts = np.cumsum([0, *sizes])
    mesh = PolygonMesh.from_polygons(points, [list(range(a, b)) for a, b in pairwise(starts)])
    np.testing.assert_array_equal(triangulate(mesh), mesh.triangle_corners)


def test_polygons_that_cross_themselves_or_have_no_area_keep_the_fan():
    bow = [[0, 0, 0], [1, 1, 0], [1, 0, 0], [0, 1, 0], [-2, 0.5, 0]]
    for points in (bow, [[0, 0, 0]] * 5, [[0, 0, 0], [1, 0, 0], [2, 0, 0], [3, 0, 0]]):
        mesh = polygon(points)
        triangles = triangulate(mesh)
        assert triangles.shape == (len(points) - 2, 3)
        assert set(triangles.ravel().tolist()) <= set(range(len(points)))


def test_triangles_stay_in_polygon_order():
    arrow = [[0, -1, 0], [1, 1, 0], [0, 0.4, 0], [-1, 1, 0]]
    mesh = PolygonMesh.from_polygons(np.array(arrow), [[0, 1, 2], [1, 2, 3, 0], [0, 2, 3]])
    triangles = triangulate(mesh)
    assert triangles[0].tolist() == [0, 1, 2]
    assert triangles[3].tolist() == [7, 8, 9]
    assert (area(mesh.positions, mesh.corners[triangles])[:, 2] > 0).all()
