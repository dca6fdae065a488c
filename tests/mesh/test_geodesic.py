"""Distances and paths on surfaces."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from risorius.errors import MeshError, ParameterError, ShapeError
from risorius.mesh.core import TriMesh
from risorius.mesh.geodesic import (
    Barrier,
    HeatDistance,
    dijkstra_distance,
    heat_distance,
    nearest_source,
    path_through,
    shortest_path,
)
from tests.mesh.shapes import cube, grid, joined, rotation, sphere


def arc(mesh: TriMesh, source: int) -> np.ndarray:
    """Return the true distances on a sphere about the origin."""
    radius = np.linalg.norm(mesh.positions[0])
    cosine = mesh.positions @ mesh.positions[source] / radius**2
    return radius * np.arccos(np.clip(cosine, -1.0, 1.0))


@pytest.mark.parametrize("source", [0, 77, 500])
def test_dijkstra_is_never_shorter_than_the_true_distance(source: int):
    mesh = sphere(3, radius=10.0)
    found = dijkstra_distance(mesh.positions, mesh.faces, [source])
    true = arc(mesh, source)
    # Chords cut the arc by (edge / radius)^2 / 24 at most.
    assert (found >= true * (1.0 - 0.002) - 1e-6).all()
    assert (found <= 1.25 * true + 1e-6).all()


def test_dijkstra_on_a_sheet_is_exact_along_its_edges():
    mesh = grid(10, 10)
    found = dijkstra_distance(mesh.positions, mesh.faces, [0])
    x, y = mesh.positions[:, 0], mesh.positions[:, 1]
    along, short = np.maximum(x, y), np.minimum(x, y)
    # Diagonals run one way only: steps are 1 along an axis, root 2 on the diagonal.
    np.testing.assert_allclose(found, along - short + np.sqrt(2.0) * short, atol=1e-12)


@pytest.mark.parametrize("levels", [3, 4])
def test_heat_distance_is_within_a_few_percent_on_a_sphere(levels: int):
    mesh = sphere(levels, radius=10.0)
    found, true = heat_distance(mesh.positions, mesh.faces, [0]), arc(mesh, 0)
    assert np.abs(found - true).max() < 0.04 * true.max()
    assert np.abs(found - true).mean() < 0.01 * true.max()


def test_heat_distance_beats_dijkstra_across_the_grain():
    mesh = grid(30, 30)
    corner = mesh.vertex_count - 31
    goal = np.linalg.norm(mesh.positions - mesh.positions[corner], axis=1)
    heat = np.abs(heat_distance(mesh.positions, mesh.faces, [corner]) - goal).mean()
    edge = np.abs(dijkstra_distance(mesh.positions, mesh.faces, [corner]) - goal).mean()
    assert heat < 0.3 * edge


def test_distance_to_several_sources_is_the_smallest():
    mesh = sphere(3)
    each = [dijkstra_distance(mesh.positions, mesh.faces, [v]) for v in (3, 200, 400)]
    found = nearest_source(mesh.positions, mesh.faces, [3, 200, 400])
    np.testing.assert_allclose(found.distance, np.min(each, axis=0), rtol=1e-12)
    np.testing.assert_array_equal(
        found.distance,
        np.take_along_axis(
            np.stack(each), np.searchsorted([3, 200, 400], found.source)[None], axis=0
        )[0],
    )
    heat = HeatDistance(mesh.positions, mesh.faces).distance([3, 200, 400])
    assert heat[[3, 200, 400]].tolist() == [0.0, 0.0, 0.0]
    assert np.abs(heat - found.distance).max() < 0.3


def test_distances_scale_and_ignore_motion():
    mesh = sphere(2)
    rest = dijkstra_distance(mesh.positions, mesh.faces, [0])
    moved = 1000.0 * mesh.positions @ rotation(np.random.default_rng(0)).T + 4.0
    np.testing.assert_allclose(
        dijkstra_distance(moved, mesh.faces, [0]), 1000.0 * rest, rtol=1e-9, atol=1e-9
    )
    np.testing.assert_allclose(
        heat_distance(moved, mesh.faces, [0]),
        1000.0 * heat_distance(mesh.positions, mesh.faces, [0]),
        rtol=1e-5,
        atol=1e-3,
    )


def test_other_pieces_and_unused_vertices_are_out_of_reach():
    mesh = joined(sphere(1), cube(), TriMesh([[0, 0, 0]], np.zeros((0, 3), np.int32)))
    for distance in (dijkstra_distance, heat_distance):
        found = distance(mesh.positions, mesh.faces, [0])
        assert np.isfinite(found[:42]).all()
        assert np.isinf(found[42:]).all()
        lonely = distance(mesh.positions, mesh.faces, [mesh.vertex_count - 1])
        assert lonely[-1] == 0.0
        assert np.isinf(lonely[:-1]).all()
    found = nearest_source(mesh.positions, mesh.faces, [0])
    assert (found.source[42:] == -1).all()


def test_the_limit_cuts_far_vertices_off():
    mesh = grid(10, 10)
    whole = dijkstra_distance(mesh.positions, mesh.faces, [0])
    near = dijkstra_distance(mesh.positions, mesh.faces, [0], limit=0.5)
    np.testing.assert_array_equal(near[whole <= 0.5], whole[whole <= 0.5])
    assert np.isinf(near[whole > 0.5]).all()


def test_edges_without_length_are_still_edges():
    mesh = grid(3, 1)
    points = mesh.positions.copy()
    points[1] = points[0]
    points[5] = points[4]
    found = dijkstra_distance(points, mesh.faces, [0])
    assert found[1] == pytest.approx(0.0, abs=1e-300)
    assert np.isfinite(found).all()


def test_a_wall_of_vertices_can_be_reached_but_not_passed():
    mesh = grid(6, 3)
    wall = np.flatnonzero(np.isclose(mesh.positions[:, 0], 0.5))
    found = dijkstra_distance(mesh.positions, mesh.faces, [7], blocked=Barrier(vertices=wall))
    assert np.isfinite(found[wall]).all()
    assert np.isinf(found[mesh.positions[:, 0] > 0.51]).all()
    mask = np.isin(np.arange(mesh.vertex_count), wall)
    again = dijkstra_distance(mesh.positions, mesh.faces, [7], blocked=Barrier(vertices=mask))
    np.testing.assert_array_equal(found, again)


def test_a_source_on_the_wall_sees_both_sides():
    mesh = grid(6, 3)
    wall = np.flatnonzero(np.isclose(mesh.positions[:, 0], 0.5))
    found = dijkstra_distance(mesh.positions, mesh.faces, wall[:1], blocked=Barrier(vertices=wall))
    assert np.isfinite(found).all()


def test_blocked_edges_force_a_detour():
    mesh = grid(4, 1)
    cut = [[a, b] for a, b in ((1, 2), (6, 7), (1, 7), (2, 6))]
    free = dijkstra_distance(mesh.positions, mesh.faces, [0])
    cut_off = dijkstra_distance(mesh.positions, mesh.faces, [0], blocked=Barrier(edges=cut))
    assert np.isfinite(free).all()
    assert np.isinf(cut_off[[2, 3, 4, 7, 8, 9]]).all()
    ring = dijkstra_distance(
        mesh.positions, mesh.faces, [0], blocked=Barrier(edges=[[2, 1], [6, 1]])
    )
    assert ring[2] > free[2]


@given(st.integers(0, 161), st.integers(0, 161))
def test_paths_are_as_long_as_their_distance(start: int, goal: int):
    mesh = sphere(2)
    path = shortest_path(mesh, start, goal)
    assert (path[0], path[-1]) == (start, goal)
    steps = np.linalg.norm(np.diff(mesh.positions[path], axis=0), axis=1)
    distance = dijkstra_distance(mesh.positions, mesh.faces, [start])
    assert steps.sum() == pytest.approx(distance[goal], rel=1e-12)


def test_a_path_visits_its_waypoints_in_order():
    mesh = grid(8, 8)
    path = path_through(mesh, (0, 8, 80)).tolist()
    assert path[:9] == list(range(9))
    assert path[-1] == 80
    ring = path_through(mesh, (0, 8, 80, 72), closed=True).tolist()
    assert len(ring) == len(set(ring)) == 32
    assert ring[0] == 0
    assert path_through(mesh, [5]).tolist() == [5]
    assert path_through(mesh, (5, 5, 6, 6)).tolist() == [5, 6]


def test_paths_respect_walls():
    mesh = grid(6, 3)
    wall = np.flatnonzero(np.isclose(mesh.positions[:, 0], 0.5))
    around = shortest_path(mesh, 7, 13, blocked=Barrier(vertices=wall[:-1]))
    assert int(wall[-1]) in around.tolist()
    assert not set(around.tolist()) & set(wall[:-1].tolist())
    with pytest.raises(MeshError, match="vertices 7 and 13 are not connected"):
        shortest_path(mesh, 7, 13, blocked=Barrier(vertices=wall))


def test_bad_vertices_are_refused():
    mesh = cube()
    with pytest.raises(ParameterError, match=r"sources: vertex indices must lie in 0\.\.7"):
        dijkstra_distance(mesh.positions, mesh.faces, [8])
    with pytest.raises(ShapeError, match="expected at least one vertex index"):
        dijkstra_distance(mesh.positions, mesh.faces, [])
    with pytest.raises(ShapeError, match="expected integers"):
        heat_distance(mesh.positions, mesh.faces, [0.5])
    with pytest.raises(MeshError, match="not connected"):
        shortest_path(joined(cube(), cube()), 0, 8)
