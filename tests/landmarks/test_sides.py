from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from risorius.errors import LandmarkError, RisoriusWarning
from risorius.landmarks import LandmarkSet, mirror_name
from risorius.landmarks.sides import require, require_sides, sagittal_axis
from tests.synthetic import landmark_points, landmark_set


def _exchanged(*names: str) -> dict[str, tuple[float, float, float]]:
    points = landmark_points()
    swapped = {name: points[mirror_name(name)] for name in names}
    return points | swapped | {mirror_name(name): points[name] for name in names}


def _same(first: LandmarkSet, second: LandmarkSet) -> bool:
    return set(first) == set(second) and all(
        np.array_equal(first.position(name), second.position(name)) for name in first
    )


@given(angles=st.tuples(*[st.floats(-180, 180)] * 3), scale=st.floats(1e-3, 1e3))
def test_correct_sides_pass_in_any_frame_and_unit(angles, scale) -> None:
    rotation = Rotation.from_euler("xyz", angles, degrees=True).as_matrix()
    marks = landmark_set(rotation=rotation, scale=scale, origin=(30.0, 0.0, -9.0))
    assert require_sides(marks) is marks


@pytest.mark.parametrize("turn", [0, 90, 180, 250])
def test_sides_swapped_as_a_whole_are_refused(turn: int) -> None:
    rotation = Rotation.from_euler("y", turn, degrees=True).as_matrix()
    with pytest.raises(LandmarkError) as caught:
        require_sides(landmark_set(rotation=rotation).flipped())
    message = str(caught.value)
    assert "left and right are swapped (9 of 9 pairs, e.g. '2.4' and '2.5'" in message
    assert "left is the character's left); run with --flip-landmarks or correct" in message


def test_a_mirrored_head_is_refused_as_swapped() -> None:
    with pytest.raises(LandmarkError, match="left and right are swapped"):
        require_sides(landmark_set(rotation=np.diag([-1.0, 1.0, 1.0])))


def test_flipping_a_swapped_set_makes_it_pass() -> None:
    marks = landmark_set()
    assert _same(require_sides(marks.flipped().flipped()), marks)


def test_one_stray_swapped_pair_is_exchanged_with_a_warning() -> None:
    with pytest.warns(RisoriusWarning, match=r"exchanged pairs .* side: 2\.6 and 2\.7$"):
        repaired = require_sides(landmark_set(_exchanged("2.6")))
    assert _same(repaired, landmark_set())


@pytest.mark.parametrize("turn", [0, 90, 200])
def test_several_stray_swapped_pairs_are_exchanged_in_any_frame(turn: int) -> None:
    rotation = Rotation.from_euler("xyz", [turn, 15, turn], degrees=True).as_matrix()
    wrong = landmark_set(_exchanged("2.6", "2.8", "8.5", "8.7"), rotation=rotation)
    with pytest.warns(RisoriusWarning) as caught:
        repaired = require_sides(wrong)
    assert len(caught) == 1
    assert str(caught[0].message).endswith("2.6 and 2.7; 2.8 and 2.9; 8.5 and 8.6; 8.7 and 8.8")
    assert _same(repaired, landmark_set(rotation=rotation))


def test_a_pair_on_the_midline_has_no_side_and_stays() -> None:
    points = landmark_points() | {"2.6": (-0.4, -72.0, 83.0), "2.7": (0.4, -72.0, 83.0)}
    marks = landmark_set(points)
    assert require_sides(marks) is marks


def test_sides_cannot_be_judged_without_the_tip_of_the_nose() -> None:
    flipped = landmark_set({k: v for k, v in landmark_points().items() if k != "9.3"}).flipped()
    assert require_sides(flipped) is flipped


def test_the_sagittal_axis_is_a_unit_vector_to_the_left() -> None:
    np.testing.assert_allclose(sagittal_axis(landmark_set()), [1.0, 0.0, 0.0], atol=1e-12)
    turn = Rotation.from_euler("xyz", [10, 20, 30], degrees=True).as_matrix()
    np.testing.assert_allclose(
        sagittal_axis(landmark_set(rotation=turn, scale=1e-3)), turn[:, 0], atol=1e-12
    )


def test_the_sagittal_axis_needs_eyes_apart() -> None:
    points = landmark_points() | dict.fromkeys(("3.7", "3.11", "3.8", "3.12"), (1.0, 2.0, 3.0))
    with pytest.raises(LandmarkError, match=r"eye corners \(3\.7 3\.11 3\.8 3\.12\) coincide"):
        sagittal_axis(landmark_set(points))


def test_required_landmarks_that_are_there_pass() -> None:
    require(landmark_set(), ("2.1", "9.3"), purpose="anything")


def test_required_landmarks_that_are_missing_are_named_with_the_purpose() -> None:
    with pytest.raises(LandmarkError) as caught:
        require(landmark_set(), ("2.1", "7.1", "wart"), purpose="the jaw")
    assert str(caught.value) == (
        "landmarks: the jaw needs 7.1 (top of the spine, where the head turns); wart; "
        "add them to the landmark file"
    )


@pytest.mark.parametrize("turn", [0, 120])
def test_inner_corners_of_the_eyes_outside_the_outer_ones_are_refused(turn: int) -> None:
    points = landmark_points()
    exchanged = {"3.7": "3.11", "3.11": "3.7", "3.12": "3.8", "3.8": "3.12"}
    wrong = points | {name: points[other] for name, other in exchanged.items()}
    rotation = Rotation.from_euler("y", turn, degrees=True).as_matrix()
    with pytest.raises(LandmarkError, match=r"inner corners of the eyes .* lie farther apart"):
        require_sides(landmark_set(wrong, rotation=rotation))
