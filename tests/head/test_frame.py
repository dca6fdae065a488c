from __future__ import annotations

from itertools import permutations, product
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from risorius._formats import read_head, read_landmarks
from risorius.errors import LandmarkError, ParameterError, RisoriusWarning
from risorius.head.frame import MILLIMETRES, Frame, detect_frame
from risorius.landmarks import resolve
from risorius.landmarks.sides import require_sides
from tests.synthetic import landmark_points, landmark_set

POINTS = np.array([*landmark_points().values()])
EYES = POINTS[[list(landmark_points()).index(name) for name in ("3.7", "3.11", "3.8", "3.12")]]


def _right_handed_permutations() -> list[np.ndarray]:
    turns = []
    for order, signs in product(permutations(range(3)), product((1.0, -1.0), repeat=3)):
        matrix = np.diag(signs)[list(order)]
        if np.linalg.det(matrix) > 0:
            turns.append(matrix)
    return turns


def _assert_same_head(frame: Frame, input_points: np.ndarray) -> None:
    """The canonical head is the made-up one, moved so that the eyes' middle is the origin."""
    found = frame.to_canonical(input_points)
    np.testing.assert_allclose(found, POINTS - EYES.mean(axis=0), atol=1e-9)


def test_all_24_ways_to_lay_the_axes_give_the_same_head() -> None:
    turns = _right_handed_permutations()
    assert len(turns) == 24
    for turn in turns:
        frame = detect_frame(landmark_set(rotation=turn))
        np.testing.assert_array_equal(frame.rotation, turn.T)
        _assert_same_head(frame, POINTS @ turn.T)


@pytest.mark.parametrize("axis", ["x", "y", "z"])
def test_a_quarter_turn_about_each_axis_is_found_exactly(axis: str) -> None:
    turn = Rotation.from_euler(axis, 90, degrees=True).as_matrix()
    frame = detect_frame(landmark_set(rotation=turn, origin=(5.0, -7.0, 900.0)))
    np.testing.assert_array_equal(np.abs(frame.rotation).sum(axis=0), 1.0)
    _assert_same_head(frame, POINTS @ turn.T + (5.0, -7.0, 900.0))


@pytest.mark.parametrize("unit", ["m", "dm", "cm", "mm", "in", "ft"])
def test_the_unit_is_found_by_the_size_of_the_eyes(unit: str) -> None:
    scale = 1.0 / MILLIMETRES[unit]
    frame = detect_frame(landmark_set(scale=scale))
    assert frame.unit == unit
    assert frame.scale == MILLIMETRES[unit]
    _assert_same_head(frame, POINTS * scale)


@pytest.mark.parametrize("factor", [0.8, 1.25])
def test_a_small_or_large_head_keeps_its_size(factor: float) -> None:
    frame = detect_frame(landmark_set(scale=factor / 10.0))
    assert (frame.unit, frame.scale) == ("cm", 10.0)


def test_a_head_of_no_known_unit_is_scaled_to_an_adult_with_a_warning() -> None:
    with pytest.warns(RisoriusWarning, match="fit no unit"):
        frame = detect_frame(landmark_set(scale=1e-5))
    assert frame.unit == "custom"
    np.testing.assert_allclose(np.ptp(frame.to_canonical(1e-5 * EYES)[:, 0]), 92.0)


def test_a_given_unit_is_taken_even_if_another_would_fit_better() -> None:
    frame = detect_frame(landmark_set(scale=1.9), unit="mm")
    assert (frame.unit, frame.scale) == ("mm", 1.0)


def test_a_given_unit_that_makes_a_giant_scales_to_an_adult_with_a_warning() -> None:
    with pytest.warns(RisoriusWarning, match="the eyes are 6.3e\\+04 mm apart"):
        frame = detect_frame(landmark_set(), unit="m")
    assert frame.unit == "m"
    assert frame.scale == pytest.approx(1.0)


def test_a_slightly_tilted_head_keeps_its_axes() -> None:
    nod = Rotation.from_euler("xyz", [12, -8, 5], degrees=True).as_matrix()
    frame = detect_frame(landmark_set(rotation=nod))
    np.testing.assert_array_equal(frame.rotation, np.eye(3))


def test_a_turned_head_is_turned_back_with_a_warning() -> None:
    turn = Rotation.from_euler("y", 44, degrees=True).as_matrix()
    with pytest.warns(RisoriusWarning, match="turned 44 degrees off the axes"):
        frame = detect_frame(landmark_set(rotation=turn))
    left = frame.to_canonical(EYES @ turn.T)
    assert left[0, 0] == pytest.approx(46.0)
    assert abs(left[0, 2] - left[3, 2]) < 1e-9


@given(
    angles=st.tuples(*[st.floats(-180, 180)] * 3),
    scale=st.floats(1e-3, 1e3),
    origin=st.tuples(*[st.floats(-1e3, 1e3)] * 3),
)
def test_going_to_the_canonical_frame_and_back_changes_nothing(angles, scale, origin) -> None:
    rotation = Rotation.from_euler("xyz", angles, degrees=True).as_matrix()
    frame = Frame(rotation, scale, np.array(origin), "custom")
    np.testing.assert_allclose(frame.to_input(frame.to_canonical(POINTS)), POINTS, atol=1e-9)
    vectors = np.diff(POINTS, axis=0)
    there = frame.vectors_to_canonical(vectors)
    np.testing.assert_allclose(there, np.diff(frame.to_canonical(POINTS), axis=0), atol=1e-6)
    np.testing.assert_allclose(frame.vectors_to_input(there), vectors, atol=1e-9)


def test_the_canonical_frame_moves_nothing() -> None:
    np.testing.assert_array_equal(Frame.canonical().to_canonical(POINTS), POINTS)
    np.testing.assert_array_equal(Frame.canonical().to_input(POINTS), POINTS)


@pytest.mark.parametrize("axes", ["+Z-Y", "z -y", "+Z, -Y"])
def test_axes_may_be_given(axes: str) -> None:
    turn = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])
    frame = detect_frame(landmark_set(rotation=turn), axes=axes)
    _assert_same_head(frame, POINTS @ turn.T)
    assert frame.describe() == "unit mm (1 mm), up +Z, forward -Y"


@pytest.mark.parametrize("axes", ["+Y", "+Y+Y", "+Y-Y", "up", "+Y+Z+X", "+", "+Y+"])
def test_axes_that_make_no_sense_are_refused(axes: str) -> None:
    with pytest.raises(ParameterError, match="give up and forward, for example"):
        detect_frame(landmark_set(), axes=axes)


def test_an_unknown_unit_is_refused_with_the_known_ones() -> None:
    with pytest.raises(ParameterError, match="unit: 'furlong' is not one of mm, cm, dm, m, in"):
        detect_frame(landmark_set(), unit="furlong")


def _without(*names: str):
    return landmark_set({k: v for k, v in landmark_points().items() if k not in names})


def test_missing_eye_corners_are_named_and_described() -> None:
    with pytest.raises(LandmarkError) as caught:
        detect_frame(_without("3.8", "3.12"))
    message = str(caught.value)
    assert "the frame of the head needs 3.8 (inner corner of the right eye)" in message
    assert "3.12 (outer corner of the right eye)" in message
    assert "add them to the landmark file" in message


def test_the_lower_lip_replaces_a_missing_chin() -> None:
    frame = detect_frame(_without("2.1"))
    np.testing.assert_array_equal(frame.rotation, np.eye(3))


def test_a_head_without_any_point_below_the_eyes_is_refused() -> None:
    with pytest.raises(LandmarkError, match=r"needs 2\.1 \(lowest point of the chin\)"):
        detect_frame(_without("2.1", "2.10", "8.2", "2.3"))


def test_a_chin_between_the_eyes_is_refused() -> None:
    points = landmark_points() | {"2.1": (10.0, 0.0, 64.0)}
    with pytest.raises(LandmarkError, match=r"'2\.1' lies on the line through the eyes"):
        detect_frame(landmark_set(points))


@pytest.mark.parametrize("axes", [None, "+Y+Z"])
def test_eyes_at_one_place_are_refused(axes: str | None) -> None:
    points = landmark_points() | dict.fromkeys(("3.7", "3.11", "3.8", "3.12"), (0.0, 0.0, 60.0))
    with pytest.raises(LandmarkError, match=r"eye corners .* coincide"):
        detect_frame(landmark_set(points), axes=axes)


@pytest.mark.real
@pytest.mark.parametrize(
    ("head", "unit"),
    [
        ("ict_facekit/ict_neutral.obj", "cm"),
        ("makehuman_head/african_female_young.obj", "dm"),
        ("makehuman_head/asian_male_old.obj", "dm"),
        ("makehuman_head/caucasian_male_young.obj", "dm"),
    ],
)
def test_real_heads_stand_upright_in_their_unit(real_data: Path, head: str, unit: str) -> None:
    mesh, _ = read_head(real_data / head)
    marks = resolve(read_landmarks((real_data / head).with_name("landmarks.json")), mesh)
    with pytest.warns(RisoriusWarning, match=r"exchanged pairs .*2\.6 and 2\.7; 2\.8 and 2\.9"):
        marks = require_sides(marks)
    frame = detect_frame(marks)
    assert frame.describe() == f"unit {unit} ({MILLIMETRES[unit]:g} mm), up +Y, forward +Z"
    canonical = marks.at(frame.to_canonical(mesh.positions))
    assert canonical.position("2.1")[1] == pytest.approx(-100.0, abs=25.0)
    assert canonical.position("2.6")[0] > 0.0 > canonical.position("2.7")[0]


def test_axes_that_the_landmarks_contradict_are_taken_with_a_warning() -> None:
    with pytest.warns(RisoriusWarning, match=r"axes: '\+Z-Y' is 95 degrees off"):
        frame = detect_frame(landmark_set(), axes="+Z-Y")
    assert frame.describe() == "unit mm (1 mm), up +Z, forward -Y"
