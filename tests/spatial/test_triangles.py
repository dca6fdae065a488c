"""Queries on single triangles."""

from __future__ import annotations

import numpy as np
from hypothesis import assume, given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from risorius.spatial.triangles import closest_bary, line_bary
from tests.spatial.brute_force import closest_on_triangle

COORDINATES = st.floats(-10.0, 10.0).map(lambda value: round(value, 2))


@given(arrays(float, (4, 3), elements=COORDINATES))
def test_closest_point_equals_the_scalar_reference(points: np.ndarray):
    query, triangle = points[0], points[1:]
    (bary,) = closest_bary(query[None], triangle[None])
    assert bary.min() >= 0.0
    assert abs(bary.sum() - 1.0) < 1e-12
    found = np.linalg.norm(bary @ triangle - query)
    expected = np.linalg.norm(closest_on_triangle(query, triangle) - query)
    assert abs(found - expected) < 1e-9


def test_points_of_the_triangle_are_their_own_closest():
    triangle = np.array([[0, 0, 0], [4, 0, 1], [0, 3, 2]], float)
    bary = np.random.default_rng(0).dirichlet([1, 1, 1], 50)
    points = bary @ triangle
    corners = np.broadcast_to(triangle, (50, 3, 3))
    np.testing.assert_allclose(closest_bary(points, corners), bary, atol=1e-12)


def test_triangles_without_area_are_segments_or_points():
    segment = np.array([[0, 0, 0], [1, 0, 0], [2, 0, 0]], float)
    bary = closest_bary(np.array([[1.5, 1, 0], [-1, 0, 0]]), np.stack([segment] * 2))
    np.testing.assert_allclose(bary @ segment, [[1.5, 0, 0], [0, 0, 0]], atol=1e-12)
    point = np.ones((1, 3, 3))
    assert closest_bary(np.zeros((1, 3)), point).sum() == 1.0


@given(arrays(float, (5, 3), elements=COORDINATES))
def test_line_meets_the_plane_where_it_says(points: np.ndarray):
    origin, direction, triangle = points[:1], points[1:2], points[2:]
    bary, distance = line_bary(origin, direction, triangle[None])
    normal = np.cross(triangle[1] - triangle[0], triangle[2] - triangle[0])
    # Nearly parallel lines have no stable meeting point to compare.
    assume(abs(float(direction[0] @ normal)) > 1e-2)
    np.testing.assert_allclose(
        bary @ triangle,
        origin + distance[:, None] * direction,
        atol=1e-6 * (1.0 + abs(distance[0])),
    )


def test_parallel_lines_meet_nowhere():
    triangle = np.array([[[0, 0, 0], [1, 0, 0], [0, 1, 0]]], float)
    bary, distance = line_bary(np.array([[0.2, 0.2, 1]]), np.array([[1.0, 0, 0]]), triangle)
    assert np.isnan(bary).all()
    assert np.isnan(distance).all()
