from __future__ import annotations

import pytest

from risorius.controls import (
    EMOTIONS,
    MUSCLES,
    SINGLE_MUSCLES,
    arkit_shapes,
    default_presets,
    device_controls,
    list_shapes,
    muscle_controls,
)
from risorius.errors import ParameterError

ALL = [*device_controls(), *(c for m in (*MUSCLES, *SINGLE_MUSCLES) for c in muscle_controls(m))]
BOOK = default_presets()


def test_a_face_with_all_controls_makes_everything() -> None:
    shapes = list_shapes(ALL, BOOK)
    two_way = [c for c in ALL if c.low < c.default]
    assert len(shapes.poses) == len(ALL) + len(two_way) + len(EMOTIONS) + 52
    assert shapes.left_out == {}
    assert list(shapes.poses)[-52:] == [shape.name for shape in arkit_shapes()]


def test_singles_take_one_control_to_each_of_its_ends() -> None:
    shapes = list_shapes(ALL, BOOK, sets=("singles",)).poses
    assert shapes["jaw_yaw"] == {"jaw_yaw": 5.0}
    assert shapes["jaw_yaw_neg"] == {"jaw_yaw": -5.0}
    assert shapes["risorius_l"] == {"risorius_l": 1.0}
    assert "risorius_l_neg" not in shapes


def test_only_the_sets_asked_for_are_listed() -> None:
    assert tuple(list_shapes(ALL, BOOK, sets=("emotions",)).poses) == tuple(BOOK.emotions)
    assert len(list_shapes(ALL, BOOK, sets=("arkit",)).poses) == 52
    assert list_shapes(ALL, BOOK, sets=()).poses == {}


def test_a_shape_that_the_face_cannot_make_is_left_out_with_the_reason() -> None:
    controls = [control for control in ALL if control.group not in ("tongue", "gaze")]
    shapes = list_shapes(controls, BOOK, sets=("arkit",))
    assert "eyeLookInLeft" not in shapes.poses
    assert shapes.left_out["eyeLookInLeft"] == "the face has no gaze_yaw_l"
    assert shapes.left_out["tongueOut (in part)"] == "made without tongue_out"
    jaw = BOOK.arkit["tongueOut"]["jaw_pitch"]
    assert shapes.poses["tongueOut"] == {"jaw_pitch": jaw}


def test_an_unknown_set_is_refused_with_the_known_ones() -> None:
    message = "shapes: visemes is not known; choose from singles, emotions, arkit, visemes_mpeg4"
    with pytest.raises(ParameterError, match=message):
        list_shapes(ALL, BOOK, sets=("arkit", "visemes"))
