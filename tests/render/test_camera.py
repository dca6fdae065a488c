"""Cameras."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from risorius.errors import ParameterError, ShapeError
from risorius.render import Camera
from tests.render.scenes import AHEAD

seeds = st.integers(0, 2**16)
angles = st.floats(-170.0, 170.0)
clouds = arrays(np.float64, (12, 3), elements=st.floats(-80.0, 80.0))


def test_projection_equals_the_pinhole_formula() -> None:
    points = np.array([[3.0, 4.0, 10.0], [-7.0, 1.0, -50.0]])
    depth = 100.0 - points[:, 2]
    focal = 300.0 / np.tan(np.radians(10.0))
    expected = np.stack(
        [400.0 + focal * points[:, 0] / depth, 300.0 - focal * points[:, 1] / depth, depth], axis=1
    )
    np.testing.assert_allclose(AHEAD.project(points, (800, 600)), expected, rtol=1e-12)


@given(clouds, angles, st.floats(-80.0, 80.0))
def test_the_target_is_in_the_middle_and_the_top_of_the_view_on_the_upper_edge(
    points: np.ndarray, yaw: float, pitch: float
) -> None:
    camera = Camera.framing(points, yaw=yaw, pitch=pitch, fov_degrees=30.0)
    top = camera.target + camera.distance * np.tan(np.radians(15.0)) * camera.axes[1]
    seen = camera.project([camera.target, top], (200, 100))
    np.testing.assert_allclose(seen[:, :2], [[100.0, 50.0], [100.0, 0.0]], atol=1e-6)


@given(seeds, angles, st.floats(-80.0, 80.0), st.floats(1.0, 1.5), st.floats(0.5, 2.0))
def test_framing_just_sees_all_points(
    seed: int, yaw: float, pitch: float, margin: float, aspect: float
) -> None:
    draw = np.random.default_rng(seed)
    points = draw.normal(size=(12, 3)) * draw.uniform(0.5, 80.0) + draw.uniform(-50.0, 50.0, 3)
    camera = Camera.framing(points, yaw=yaw, pitch=pitch, margin=margin, aspect=aspect)
    width, height = round(4000 * aspect), 4000
    seen = camera.project(points, (width, height))
    assert (seen[:, 2] > 0.0).all()
    off = np.abs(seen[:, :2] / [width, height] - 0.5).max() * 2.0 * margin
    assert off == pytest.approx(1.0, abs=2e-3)


def test_positive_yaw_shows_the_left_side_and_positive_pitch_looks_from_above() -> None:
    points = np.array([[-1.0, -1.0, -1.0], [1.0, 1.0, 1.0]])
    assert Camera.framing(points, yaw=30.0).eye[0] > 1.0
    assert Camera.framing(points, pitch=30.0).eye[1] > 1.0
    assert Camera.framing(points).eye[2] > 1.0


def test_mirrored_points_and_yaw_give_the_mirrored_picture() -> None:
    points = np.random.default_rng(1).normal(size=(20, 3))
    one = Camera.framing(points, yaw=25.0).project(points, (300, 200))
    flip = points * [-1.0, 1.0, 1.0]
    other = Camera.framing(flip, yaw=-25.0).project(flip, (300, 200))
    np.testing.assert_allclose(one * [-1.0, 1.0, 1.0] + [300.0, 0.0, 0.0], other, atol=1e-9)


@given(angles, st.floats(-80.0, 80.0))
def test_points_in_a_row_along_the_view_stay_in_view(yaw: float, pitch: float) -> None:
    axis = Camera.framing([[0.0, 0.0, 0.0]], yaw=yaw, pitch=pitch).eye
    row = np.outer([-30.0, 0.0, 70.0], axis)
    seen = Camera.framing(row, yaw=yaw, pitch=pitch).project(row, (100, 100))
    assert seen[:, 2].min() > 1.0
    np.testing.assert_allclose(seen[:, :2], 50.0, atol=1e-6)


def test_a_single_point_can_be_framed() -> None:
    camera = Camera.framing([[5.0, 6.0, 7.0]])
    np.testing.assert_allclose(camera.project([[5.0, 6.0, 7.0]], (64, 32))[0, :2], [32.0, 16.0])


def test_points_behind_the_eye_have_no_place_in_the_picture() -> None:
    seen = AHEAD.project([[0.0, 0.0, 100.0], [0.0, 0.0, 150.0], [0.0, 0.0, 0.0]], (10, 10))
    np.testing.assert_array_equal(np.isnan(seen[:, 0]), [True, True, False])
    np.testing.assert_allclose(seen[:, 2], [0.0, -50.0, 100.0])


@pytest.mark.parametrize(
    ("change", "error", "message"),
    [
        ({"eye": (0.0, 0.0, 0.0)}, ParameterError, "eye: lies at the target"),
        ({"up": (0.0, 0.0, 1.0)}, ParameterError, "up: is zero or points along the view"),
        ({"up": (0.0, 0.0, 0.0)}, ParameterError, "up: is zero or points along the view"),
        ({"fov_degrees": 180.0}, ParameterError, "fov_degrees: 180 is above 170"),
        ({"target": (0.0, np.nan, 0.0)}, ShapeError, "target: row 0"),
        ({"eye": (1.0, 2.0)}, ShapeError, r"eye: expected shape \(3,\)"),
    ],
)
def test_an_impossible_camera_is_refused(change: dict, error: type, message: str) -> None:
    good = {"eye": (0.0, 0.0, 9.0), "target": (0.0,) * 3, "up": (0.0, 1.0, 0.0), "fov_degrees": 20}
    with pytest.raises(error, match=message):
        Camera(**(good | change))


@pytest.mark.parametrize("size", [(0, 10), (10, 20000), (10,), "ab", 5])
def test_an_impossible_size_is_refused(size: object) -> None:
    with pytest.raises(ParameterError, match="size"):
        AHEAD.project([[0.0, 0.0, 0.0]], size)


def test_framing_nothing_is_refused() -> None:
    with pytest.raises(ShapeError, match="at least one point"):
        Camera.framing(np.zeros((0, 3)))
