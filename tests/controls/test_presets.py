from __future__ import annotations

import json
from importlib.resources import files

import pytest

from risorius.controls import (
    EMOTIONS,
    MUSCLES,
    SINGLE_MUSCLES,
    Control,
    arkit_shapes,
    bilateral,
    default_presets,
    device_controls,
    mirrored,
    muscle_controls,
    parse_presets,
    resolve_pose,
    sided,
)
from risorius.errors import FormatError, ParameterError, RisoriusWarning

BOOK = default_presets()
ALL = [*device_controls(), *(c for m in (*MUSCLES, *SINGLE_MUSCLES) for c in muscle_controls(m))]
BY_NAME = {control.name: control for control in ALL}
POSES = {**BOOK.emotions, **BOOK.arkit}
HEADER = {"schema": "risorius/presets", "version": 1}


def test_the_book_holds_the_six_emotions_and_all_52_arkit_shapes() -> None:
    assert set(BOOK.emotions) == set(EMOTIONS)
    assert len(arkit_shapes()) == 52
    assert set(BOOK.arkit) == {shape.name for shape in arkit_shapes()}


@pytest.mark.parametrize("name", POSES)
def test_every_preset_stays_within_the_ranges_of_known_controls(name: str) -> None:
    resolved = resolve_pose(ALL, POSES[name])
    assert resolved.clamped == ()
    assert any(resolved.values[key] != BY_NAME[key].default for key in POSES[name])


def test_mirroring_twice_changes_nothing() -> None:
    for pose in POSES.values():
        assert mirrored(mirrored(pose)) == pose
        assert mirrored(mirrored(pose, BY_NAME), BY_NAME) == pose


def test_mirroring_by_name_and_by_control_agree() -> None:
    for control in ALL:
        pose = {control.name: 0.25}
        assert mirrored(pose) == mirrored(pose, BY_NAME)


def test_emotions_are_symmetric() -> None:
    for pose in BOOK.emotions.values():
        assert mirrored(pose) == pose


def test_right_hand_shapes_mirror_the_left_ones() -> None:
    paired = [shape for shape in arkit_shapes() if shape.mirror != shape.name]
    assert len(paired) == 40
    for shape in paired:
        assert mirrored(BOOK.arkit[shape.name]) == BOOK.arkit[shape.mirror]


def test_both_eyes_look_the_same_way_when_one_looks_in_and_the_other_out() -> None:
    left_eye = BOOK.arkit["eyeLookInLeft"]["gaze_yaw_l"]
    right_eye = BOOK.arkit["eyeLookOutRight"]["gaze_yaw_r"]
    assert left_eye == right_eye < 0.0


def test_a_paired_control_without_side_moves_both_sides() -> None:
    book = parse_presets({**HEADER, "emotions": {"joy": {"risorius": 0.5}}}, source="p")
    assert book.emotions["joy"] == {"risorius_l": 0.5, "risorius_r": 0.5}


def test_fallbacks_lead_from_known_controls_to_known_controls() -> None:
    for name, others in BOOK.fallbacks.items():
        for base in (name, *others):
            names = sided(base) if bilateral(base) else (base,)
            assert set(names) <= set(BY_NAME)


def _face(*names: str) -> list[Control]:
    return [BY_NAME[name] for name in names]


def test_a_face_with_all_controls_gets_the_preset_as_it_is() -> None:
    for pose in POSES.values():
        fitted = BOOK.fit(pose, ALL)
        assert fitted.pose == pose
        assert fitted.replaced == fitted.missing == ()


def test_a_missing_control_is_replaced_on_its_own_side_and_adds_up() -> None:
    controls = _face("zygomaticus_major_l", "zygomaticus_major_r")
    fitted = BOOK.fit({"risorius_l": 0.5, "zygomaticus_major_l": 0.5}, controls)
    assert fitted.pose == pytest.approx({"zygomaticus_major_l": 0.5 + 0.4 * 0.5})
    assert fitted.replaced == ("risorius_l",)


def test_a_single_muscle_is_replaced_on_both_sides() -> None:
    fitted = BOOK.fit({"procerus": 1.0}, _face("corrugator_l", "corrugator_r"))
    assert fitted.pose == {"corrugator_l": 0.5, "corrugator_r": 0.5}


def test_a_control_that_nothing_replaces_is_named_as_missing() -> None:
    fitted = BOOK.fit({"tongue_out": 1.0, "jaw_pitch": 7.0}, _face("jaw_pitch"))
    assert fitted.pose == {"jaw_pitch": 7.0}
    assert fitted.missing == ("tongue_out",)


def test_the_file_that_ships_is_the_book() -> None:
    text = files("risorius.controls").joinpath("data/presets.json").read_text("utf-8")
    assert parse_presets(json.loads(text), source="presets.json") == BOOK


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"schema": "other"}, '^p: expected "schema": "risorius/presets", got \'other\''),
        ({"version": 2}, "^p: presets version 2 is not 1; update risorius to read it"),
        ({"emotions": [1]}, "^p: 'emotions' must be an object of named poses"),
        ({"emotions": {"joy": 3}}, "^p: emotions.joy must be an object of control: value"),
        ({"arkit": {"mouthWink": {}}}, "^p: not ARKit shapes: mouthWink"),
    ],
)
def test_a_file_that_breaks_the_schema_is_refused(changes: dict, message: str) -> None:
    with pytest.raises(FormatError, match=message):
        parse_presets(HEADER | changes, source="p")


@pytest.mark.parametrize("value", [float("nan"), "much", None])
def test_a_value_that_is_no_finite_number_is_refused_by_place(value: object) -> None:
    with pytest.raises(ParameterError, match=r"^p: emotions\.joy: jaw_pitch: "):
        parse_presets(HEADER | {"emotions": {"joy": {"jaw_pitch": value}}}, source="p")


def test_a_key_that_means_nothing_is_told() -> None:
    with pytest.warns(RisoriusWarning, match="p: emotion means nothing in presets and is ignored"):
        parse_presets(HEADER | {"emotion": {}}, source="p")
