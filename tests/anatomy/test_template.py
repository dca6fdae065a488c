from __future__ import annotations

import numpy as np
import pytest

from risorius.anatomy.template import SURE_LANDMARKS, builtin_head, warp_between
from risorius.errors import LandmarkError
from tests.synthetic import landmark_points, landmark_set


def test_the_built_in_head_is_canonical_and_complete() -> None:
    head = builtin_head()
    assert head.frame.describe() == "unit mm (1 mm), up +Y, forward +Z"
    assert {"skin", "eye_left", "eye_right", "teeth_upper", "teeth_lower", "gums", "tongue"} <= set(
        head.parts
    )
    assert head.landmarks.missing(SURE_LANDMARKS) == ()


def test_it_is_loaded_once() -> None:
    assert builtin_head() is builtin_head()


def test_a_head_is_carried_onto_itself() -> None:
    marks = builtin_head().landmarks
    points = builtin_head().skin.mesh.positions[::97]
    np.testing.assert_allclose(warp_between(marks, marks)(points), points, atol=1e-6)


def test_landmarks_meet_their_partners() -> None:
    source, target = builtin_head().landmarks, landmark_set()
    common = [name for name in SURE_LANDMARKS if name in target]
    warp = warp_between(source, target)
    found = warp(source.positions(common))
    np.testing.assert_allclose(found, target.positions(common), atol=1e-6)


def test_a_larger_head_carries_everything_along() -> None:
    source = landmark_set()
    target = landmark_set(scale=1.3, origin=(4.0, -3.0, 20.0))
    points = np.array([[12.0, -30.0, 60.0], [60.0, 40.0, -50.0]])
    np.testing.assert_allclose(
        warp_between(source, target)(points), 1.3 * points + (4.0, -3.0, 20.0), atol=1e-6
    )


def test_places_may_stand_for_a_landmark_set() -> None:
    target = landmark_set()
    places = {name: np.asarray(place) for name, place in landmark_points().items()}
    np.testing.assert_allclose(warp_between(places, target)(np.eye(3)), np.eye(3), atol=1e-6)


def test_too_few_common_landmarks_are_refused_with_those_to_add() -> None:
    few = {name: landmark_points()[name] for name in ("2.1", "3.7", "3.12", "9.3", "8.1")}
    with pytest.raises(LandmarkError) as caught:
        warp_between(builtin_head().landmarks, landmark_set(few))
    assert str(caught.value).startswith(
        "landmarks: 5 in common with the built-in head, 8 are needed; add some of 2.2, 2.3, 2.4"
    )
