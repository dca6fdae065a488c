from __future__ import annotations

import re

import pytest

from risorius.controls import (
    MUSCLES,
    SINGLE_MUSCLES,
    bilateral,
    device_controls,
    mirrored,
    muscle_controls,
    sided,
)

DEVICES = device_controls()
CONTROLS = [*DEVICES, *(c for m in (*MUSCLES, *SINGLE_MUSCLES) for c in muscle_controls(m))]
BY_NAME = {control.name: control for control in CONTROLS}


def test_every_name_is_used_once() -> None:
    assert len(BY_NAME) == len(CONTROLS)
    assert not set(MUSCLES) & set(SINGLE_MUSCLES)


def test_names_are_snake_case_and_sides_come_last() -> None:
    for name in BY_NAME:
        assert re.fullmatch(r"[a-z]+(_[a-z]+)*", name)
        assert not re.search(r"_[lr]_", name)


def test_every_control_rests_inside_its_range() -> None:
    for control in CONTROLS:
        assert control.low <= control.default <= control.high
        assert control.low < control.high
        assert control.default == 0.0


def test_muscles_contract_from_0_to_1() -> None:
    muscles = [control for control in CONTROLS if control.group == "muscle"]
    assert len(muscles) == 2 * len(MUSCLES) + len(SINGLE_MUSCLES)
    assert {(c.low, c.high, c.unit) for c in muscles} == {(0.0, 1.0, "1")}


def test_the_jaw_has_the_published_limits() -> None:
    pitch, yaw = BY_NAME["jaw_pitch"], BY_NAME["jaw_yaw"]
    assert (pitch.low, pitch.high, pitch.unit) == (-4.0, 18.0, "deg")
    assert (yaw.low, yaw.high, yaw.unit) == (-5.0, 5.0, "deg")
    protrusion = BY_NAME["jaw_protrusion"]
    assert (protrusion.low, protrusion.high, protrusion.unit) == (-2.0, 8.0, "mm")


def test_mirrors_point_at_each_other_and_have_the_same_range() -> None:
    for control in CONTROLS:
        other = BY_NAME[control.mirror]
        assert other.mirror == control.name
        assert (other.low, other.high, other.unit) == (control.low, control.high, control.unit)
        assert other.mirror_sign == control.mirror_sign
        assert (other is control) == (not control.name.endswith(("_l", "_r")))


def test_only_sideways_motions_change_sign_in_the_mirror() -> None:
    flipped = {control.name for control in CONTROLS if control.mirror_sign < 0}
    assert flipped == {"jaw_yaw", "gaze_yaw_l", "gaze_yaw_r", "tongue_side"}
    for name in flipped:
        assert BY_NAME[name].low == -BY_NAME[name].high


@pytest.mark.parametrize("name", ["risorius", "lid_upper", "gaze_yaw", "cheek_puff"])
def test_paired_names_have_two_sides(name: str) -> None:
    assert bilateral(name)
    assert sided(name) == (f"{name}_l", f"{name}_r")
    assert set(sided(name)) <= set(BY_NAME)


@pytest.mark.parametrize("name", ["procerus", "jaw_pitch", "tongue_out", "risorius_l", "nothing"])
def test_names_on_the_midline_or_with_a_side_are_not_paired(name: str) -> None:
    assert not bilateral(name)


def test_every_muscle_says_what_it_does() -> None:
    for text in (*MUSCLES.values(), *SINGLE_MUSCLES.values()):
        assert re.fullmatch(r"[a-z].*[a-z]", text)


def test_a_side_of_every_control_is_reached_from_the_other_by_mirroring() -> None:
    for control in CONTROLS:
        assert mirrored({control.name: 1.0}, BY_NAME) == {control.mirror: control.mirror_sign}
