from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from risorius.controls.control import Control, resolve_pose
from risorius.errors import ParameterError

CONTROLS = (
    Control("jaw_pitch", -4.0, 18.0, 0.0, "deg", "jaw", "jaw_pitch"),
    Control("risorius_l", 0.0, 1.0, 0.0, "1", "muscle", "risorius_r"),
    Control("risorius_r", 0.0, 1.0, 0.25, "1", "muscle", "risorius_l"),
)
REST = {"jaw_pitch": 0.0, "risorius_l": 0.0, "risorius_r": 0.25}


def test_an_empty_pose_rests_at_the_defaults() -> None:
    resolved = resolve_pose(CONTROLS, {})
    assert resolved.values == REST
    assert resolved.clamped == ()


def test_named_controls_take_their_value_and_the_others_rest() -> None:
    resolved = resolve_pose(CONTROLS, {"jaw_pitch": 7, "risorius_r": 0.0})
    assert resolved.values == REST | {"jaw_pitch": 7.0, "risorius_r": 0.0}
    assert resolved.clamped == ()


@given(
    st.fixed_dictionaries(
        {},
        optional={
            control.name: st.floats(allow_nan=False, allow_infinity=False) for control in CONTROLS
        },
    )
)
def test_every_resolved_value_lies_in_its_range_and_clamping_again_changes_nothing(pose) -> None:
    resolved = resolve_pose(CONTROLS, pose)
    for control in CONTROLS:
        assert control.low <= resolved.values[control.name] <= control.high
    again = resolve_pose(CONTROLS, resolved.values)
    assert again.values == resolved.values
    assert again.clamped == ()
    outside = [c.name for c in CONTROLS if not c.low <= pose.get(c.name, c.default) <= c.high]
    assert [text.split()[0] for text in resolved.clamped] == [n for n in pose if n in outside]


def test_clamping_is_told() -> None:
    resolved = resolve_pose(CONTROLS, {"jaw_pitch": 30, "risorius_l": -0.5})
    assert resolved.clamped == (
        "jaw_pitch 30 clamped to 18 [-4, 18]",
        "risorius_l -0.5 clamped to 0 [0, 1]",
    )
    assert resolved.values == REST | {"jaw_pitch": 18.0}


def test_an_unknown_control_is_refused_with_those_that_exist() -> None:
    with pytest.raises(ParameterError) as caught:
        resolve_pose(CONTROLS, {"zygomaticus": 1.0})
    assert str(caught.value) == (
        "pose: this face has no control 'zygomaticus'; it has jaw_pitch, risorius_l, risorius_r"
    )


@pytest.mark.parametrize(
    ("value", "message"),
    [
        (float("nan"), "pose: jaw_pitch: nan is not finite"),
        (float("inf"), "pose: jaw_pitch: inf is not finite"),
        ("wide", "pose: jaw_pitch: 'wide' is not a number"),
        (None, "pose: jaw_pitch: None is not a number"),
    ],
)
def test_a_value_that_is_no_finite_number_is_refused(value, message: str) -> None:
    with pytest.raises(ParameterError, match=message):
        resolve_pose(CONTROLS, {"jaw_pitch": value})
