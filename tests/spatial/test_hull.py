"""Convex hulls."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from risorius.errors import MeshError, ParameterError
from risorius.mesh.topology import capped_volume, report
from risorius.spatial.closest import signed_distance
from risorius.spatial.hull import convex_hull
from tests.mesh.shapes import cube, rotation, sphere


@given(st.integers(0, 2**32 - 1), st.integers(4, 60), st.sampled_from([1e-3, 1.0, 1e3]))
def test_hull_is_closed_convex_outward_and_holds_its_points(seed: int, count: int, scale: float):
    points = scale * (np.random.default_rng(seed).normal(size=(count, 3)) + 5.0)
    hull = convex_hull(points)
    found = report(hull.mesh)
    assert found.is_closed
    assert found.euler == 2
    assert len(found.inconsistent_edges) == len(found.unused_vertices) == 0
    assert capped_volume(hull.mesh.positions, hull.mesh.faces) > 0.0
    assert hull.inside(points).all()
    assert {tuple(p) for p in hull.mesh.positions} <= {tuple(p) for p in points}


def test_hull_of_a_cube_is_the_cube():
    generator = np.random.default_rng(0)
    hull = convex_hull(np.concatenate([cube().positions, generator.random((50, 3))]))
    assert capped_volume(hull.mesh.positions, hull.mesh.faces) == pytest.approx(1.0)
    np.testing.assert_allclose(
        hull.depth([[0.5, 0.5, 0.5], [0.5, 0.9, 0.5], [0.5, 0.5, 3]]), [0.5, 0.1, -2]
    )
    assert hull.inside([[0.5, 0.5, 0.5], [1, 1, 1], [1.01, 1, 1]]).tolist() == [True, True, False]
    assert hull.inside([[0.5, 0.9, 0.5]], margin=0.2).tolist() == [False]


def test_depth_inside_is_the_distance_to_the_surface():
    points = sphere(2).positions @ np.diag([1.0, 2.0, 3.0])
    hull = convex_hull(points)
    queries = np.random.default_rng(0).normal(size=(200, 3))
    signed = signed_distance(hull.mesh, queries)
    inside = signed < 0.0
    assert inside.sum() > 50
    np.testing.assert_array_equal(hull.inside(queries), inside)
    np.testing.assert_allclose(hull.depth(queries)[inside], -signed[inside], atol=1e-12)
    assert (-hull.depth(queries)[~inside] <= signed[~inside] + 1e-12).all()


@given(st.integers(0, 2**32 - 1))
def test_leaving_ends_on_the_surface(seed: int):
    generator = np.random.default_rng(seed)
    hull = convex_hull(generator.normal(size=(30, 3)))
    queries, directions = 0.5 * generator.normal(size=(40, 3)), generator.normal(size=(40, 3))
    travel = hull.exit_along(queries, directions)
    inside = hull.depth(queries) > 0.0
    assert (travel[~inside] == 0.0).all()
    unit = directions / np.linalg.norm(directions, axis=1, keepdims=True)
    out = queries + travel[:, None] * unit
    np.testing.assert_allclose(hull.depth(out)[inside], 0.0, atol=1e-9)
    one = hull.exit_along(queries[:1], 7.0 * directions[0])
    np.testing.assert_allclose(one, travel[:1])


def test_hull_turns_with_its_points():
    generator = np.random.default_rng(0)
    points, queries = generator.normal(size=(40, 3)), generator.normal(size=(20, 3))
    turn = rotation(generator)
    np.testing.assert_allclose(
        convex_hull(points @ turn.T + 9).depth(queries @ turn.T + 9),
        convex_hull(points).depth(queries),
        atol=1e-12,
    )


def test_many_queries_equal_few():
    hull = convex_hull(sphere(3).positions)
    queries = np.random.default_rng(0).normal(size=(3000, 3))
    np.testing.assert_allclose(hull.depth(queries)[::977], hull.depth(queries[::977]), atol=1e-14)
    assert hull.depth(np.zeros((0, 3))).shape == (0,)


@pytest.mark.parametrize(
    ("points", "message"),
    [
        (np.eye(3), "3 points enclose nothing"),
        (np.eye(3)[[0, 1, 2, 0, 1]], "lie in one plane"),
        (np.outer(np.arange(6.0), [1, 2, 3]), "lie in one plane or on one line"),
        (np.ones((5, 3)), "lie in one plane"),
    ],
)
def test_points_without_depth_are_refused(points: np.ndarray, message: str):
    with pytest.raises(MeshError, match=message):
        convex_hull(points)


def test_a_zero_direction_is_refused():
    with pytest.raises(ParameterError, match="direction: it is zero"):
        convex_hull(cube().positions).exit_along([[0.5, 0.5, 0.5]], [0, 0, 0])
