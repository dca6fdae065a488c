from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from risorius.errors import ParameterError, ShapeError
from risorius.layered.faithful.action_line import ActionLine, Ground, sample_line
from risorius.layered.faithful.parameters import FaithfulParameters
from risorius.mesh.surface_point import SurfacePoints
from tests.layered.faithful.ground import grid

CORNER = np.array([(0.0, 0, 0), (1, 0, 0), (1, 2, 0)])


def _up(points: np.ndarray) -> np.ndarray:
    return np.broadcast_to([0.0, 0.0, 1.0], points.shape)


def _ground(height, size: float = 40.0) -> Ground:
    positions, faces = grid(81, 81, size)
    positions[:, 2] = height(positions[:, 0])
    rows = np.arange(len(faces), dtype=np.int32)
    return Ground(positions, faces, rows, _up, FaithfulParameters(split_tolerance=0.002))


def _length(ground: Ground, ends: list[tuple[float, float, float]]) -> float:
    line = ground.lay(np.array(ends))
    places = line.places(ground.positions, ground.faces)
    return float(np.linalg.norm(np.diff(places, axis=0), axis=1).sum())


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_line_follows_a_dome_and_a_bowl(sign: float) -> None:
    ground = _ground(lambda x: sign * 12.0 * np.cos(x / 20.0))
    x = np.linspace(-20.0, 20.0, 4001)
    curve = np.stack([x, sign * 12.0 * np.cos(x / 20.0)], axis=1)
    true = np.linalg.norm(np.diff(curve, axis=0), axis=1).sum()
    found = _length(ground, [(-20.0, 0.1, 0.0), (20.0, 0.1, 0.0)])
    assert found == pytest.approx(true, rel=4e-3)


def test_a_trench_deeper_than_the_gap_is_bridged_and_a_shallow_one_is_not() -> None:
    def trench(depth: float):
        return lambda x: np.where(np.abs(x) < 10.0, -depth, 0.0)

    ends = [(-20.0, 0.1, 0.0), (20.0, 0.1, 0.0)]
    assert _length(_ground(trench(14.0)), ends) == pytest.approx(40.0, rel=1e-9)
    assert _length(_ground(trench(5.0)), ends) > 42.0


def test_a_chord_on_the_ground_is_not_split() -> None:
    ground = _ground(np.zeros_like)
    assert len(ground.lay(np.array([(-9.0, 0, 0), (9, 0, 0)])).points) == 2


def test_points_that_coincide_are_dropped_and_a_single_one_is_refused() -> None:
    ground = _ground(np.zeros_like)
    assert len(ground.lay(np.array([(-9.0, 0, 0), (-9, 0, 0), (9, 0, 0)])).points) == 2
    with pytest.raises(ShapeError, match="1 distinct surface points are no line"):
        ground.lay(np.array([(-9.0, 0, 0), (-9, 0, 5)]))


def test_where_rays_miss_the_closest_point_is_taken() -> None:
    ground = _ground(np.zeros_like, size=10.0)
    points, missed = ground.project(np.array([(0.0, 0, 0), (14.0, 0.5, 3.0)]))
    assert missed.tolist() == [False, True]
    np.testing.assert_allclose(points.positions(ground.mesh)[1], (10.0, 0.5, 0.0), atol=1e-9)


def test_a_hit_on_the_far_side_of_a_hollow_counts_as_a_miss() -> None:
    ground = _ground(lambda x: np.where(np.abs(x) < 5.0, -30.0, 0.0))
    _, missed = ground.project(np.array([(0.0, 0.2, 0.0), (20.0, 0.2, 0.0)]))
    assert missed.tolist() == [True, False]


def test_samples_stay_on_the_line_and_reach_both_ends() -> None:
    samples = sample_line(CORNER, 4)
    np.testing.assert_allclose(samples, [(0, 0, 0), (1, 0, 0), (1, 1, 0), (1, 2, 0)], atol=1e-12)


def test_contraction_draws_samples_to_the_first_point_along_the_line() -> None:
    samples = sample_line(CORNER, 4, contraction=0.5)
    np.testing.assert_allclose(
        samples, [(0, 0, 0), (0.5, 0, 0), (1, 0, 0), (1, 0.5, 0)], atol=1e-12
    )


@given(st.integers(3, 12), st.floats(0.0, 0.95))
def test_samples_are_evenly_spaced_on_a_straight_line(count: int, contraction: float) -> None:
    line = np.array([(0.0, 0, 0), (1, 2, 2), (3, 6, 6)])
    samples = sample_line(line, count, contraction=contraction)
    steps = np.linalg.norm(np.diff(samples, axis=0), axis=1)
    np.testing.assert_allclose(steps, (1.0 - contraction) * 9.0 / (count - 1), rtol=1e-9)


def test_a_closed_line_has_distinct_samples() -> None:
    square = np.array([(0.0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)])
    np.testing.assert_allclose(sample_line(square, 4, closed=True), square, atol=1e-12)


def test_normals_are_sampled_at_the_places_of_the_points_and_stay_unit() -> None:
    normals = np.array([(0.0, 0, 1), (0, 0, 1), (1, 0, 0)])
    found = sample_line(normals, 4, along=CORNER)
    np.testing.assert_allclose(np.linalg.norm(found, axis=1), 1.0)
    np.testing.assert_allclose(found[2], np.array([1, 0, 1]) / np.sqrt(2.0))


@pytest.mark.parametrize("contraction", [-0.1, 1.0, float("nan")])
def test_a_contraction_that_leaves_no_length_is_refused(contraction: float) -> None:
    with pytest.raises(ParameterError, match="contraction"):
        sample_line(CORNER, 4, contraction=contraction)


def test_a_line_and_its_reverse_hold_the_same_points() -> None:
    positions, faces = grid(3, 3, 1.0)
    line = ActionLine(SurfacePoints(np.array([0, 3]), np.eye(3)[:2]))
    np.testing.assert_array_equal(
        line.reversed.places(positions, faces), line.places(positions, faces)[::-1]
    )
