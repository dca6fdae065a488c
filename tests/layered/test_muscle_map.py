"""The muscle map: its file, its layers, its refusals."""

from __future__ import annotations

import copy
import json
from typing import Any

import numpy as np
import pytest

from risorius.controls.standard import MUSCLES, SINGLE_MUSCLES
from risorius.errors import FormatError, ParameterError, RisoriusWarning
from risorius.layered.muscle import Sheet
from risorius.layered.muscle_map import default_muscle_map, parse_muscle_map, read_muscle_map


@pytest.fixture
def content() -> dict[str, Any]:
    return copy.deepcopy(default_muscle_map().to_json())


def _entry(content: dict[str, Any], name: str) -> dict[str, Any]:
    return next(entry for entry in content["muscles"] if entry["name"] == name)


def test_published_map_has_25_linear_muscles_and_one_ring() -> None:
    published = default_muscle_map().published.muscles
    linear = sum(2 if m.mirror else 1 for m in published if m.kind == "sheet")
    assert (linear, sum(m.kind == "sphincter" for m in published)) == (25, 1)


def test_every_active_muscle_is_a_registered_control() -> None:
    for muscle in default_muscle_map().muscles:
        if muscle.active:
            paired = muscle.mirror and not muscle.together
            assert muscle.name in (MUSCLES if paired else SINGLE_MUSCLES)


def test_writing_and_reading_gives_the_same_map(content: dict[str, Any], tmp_path: Any) -> None:
    path = tmp_path / "map.json"
    path.write_text(json.dumps(content), "utf-8")
    assert read_muscle_map(path).to_json() == content


def test_muscles_come_after_what_they_lie_on(content: dict[str, Any]) -> None:
    content["muscles"].reverse()
    muscles = parse_muscle_map(content, source="map").muscles
    place = {muscle.name: number for number, muscle in enumerate(muscles)}
    for muscle in muscles:
        assert all(place[name] < place[muscle.name] for name in muscle.on if name in place)


def test_mirror_of_the_mirror_is_the_muscle_itself() -> None:
    for muscle in default_muscle_map().muscles:
        back = muscle.mirrored().mirrored()
        if isinstance(muscle.shape, Sheet):
            assert isinstance(back.shape, Sheet)
            np.testing.assert_array_equal(back.shape.line, muscle.shape.line)


def test_muscles_in_a_circle_are_refused_with_their_names(content: dict[str, Any]) -> None:
    _entry(content, "frontalis")["on"] = ["corrugator"]
    with pytest.raises(ParameterError, match=r"in a circle \(.*corrugator.*frontalis"):
        parse_muscle_map(content, source="map")


def test_muscle_on_its_own_layer_is_refused(content: dict[str, Any]) -> None:
    _entry(content, "risorius")["on"] = ["orbicularis_oris"]
    with pytest.raises(ParameterError, match="risorius: layer 4 lies on orbicularis_oris"):
        parse_muscle_map(content, source="map")


@pytest.mark.parametrize(
    ("name", "field", "value", "error", "message"),
    [
        ("risorius", "on", ["bone"], ParameterError, "lies on 'bone'"),
        ("risorius", "kind", "tube", FormatError, "not one of sheet, sphincter"),
        ("risorius", "line", [[0, 0, 0]], FormatError, "two or more points"),
        ("risorius", "line", [[0, 0, 0]] * 3, ParameterError, "consecutive points are equal"),
        ("risorius", "half_width", [1, 0, 1], ParameterError, "above 0 everywhere"),
        ("risorius", "shortening", 1.0, ParameterError, "above 0.95"),
        ("risorius", "arch", 2.0, ParameterError, "above 1"),
        ("risorius", "reach", 0.0, ParameterError, "reach: must be above 0"),
        ("risorius", "seal", 1, FormatError, "expected true or false"),
        ("risorius", "sections", [1, 5], ParameterError, "whole numbers from 2 to 200"),
        ("risorius", "lip", "left", ParameterError, "'left' is not one of"),
        ("orbicularis_oris", "inner", [40, 4], ParameterError, "below those of 'outer'"),
        ("orbicularis_oris", "mouth", None, FormatError, "needs a block 'mouth' or 'eye'"),
        ("orbicularis_oris", "mouth", {"window": [1, 2]}, FormatError, "name upper, lower or both"),
    ],
)
def test_wrong_entries_are_refused_by_muscle_and_field(
    content: dict[str, Any], name: str, field: str, value: Any, error: type, message: str
) -> None:
    _entry(content, name)[field] = value
    with pytest.raises(error, match=message):
        parse_muscle_map(content, source="map")


def test_muscle_listed_twice_is_refused(content: dict[str, Any]) -> None:
    content["muscles"].append(_entry(content, "risorius"))
    with pytest.raises(ParameterError, match="risorius is listed twice"):
        parse_muscle_map(content, source="map")


def test_newer_version_is_refused(content: dict[str, Any]) -> None:
    content["version"] = 2
    with pytest.raises(FormatError, match="update risorius"):
        parse_muscle_map(content, source="map")


def test_a_key_that_means_nothing_is_told(content: dict[str, Any]) -> None:
    with pytest.warns(RisoriusWarning, match="map: muscels means nothing in a muscle map"):
        parse_muscle_map(content | {"muscels": []}, source="map")
