from __future__ import annotations

import pytest

from risorius.controls import EMOTIONS, default_presets, list_shapes, parse_presets
from risorius.controls.facs import action_units
from risorius.controls.presets import mirrored
from risorius.controls.standard_sets import STANDARD_SETS
from risorius.controls.visemes import MPEG4_EXPRESSIONS, mpeg4_visemes, oculus_visemes
from risorius.errors import FormatError
from tests.controls.test_shape_sets import ALL

BOOK = default_presets()


def _book(**sections: object):
    return parse_presets({"schema": "risorius/presets", "version": 1, **sections}, source="p.json")


def test_oculus_has_silence_and_the_fourteen_visemes_of_mpeg4() -> None:
    assert len(oculus_visemes()) == 15
    assert [viseme.number for viseme in mpeg4_visemes()] == list(range(1, 15))
    assert oculus_visemes()[1:] == mpeg4_visemes()


def test_mpeg4_expressions_are_our_emotions_in_another_order() -> None:
    assert sorted(MPEG4_EXPRESSIONS) == sorted(EMOTIONS)


@pytest.mark.parametrize(("section", "count"), [("visemes_mpeg4", 14), ("visemes_oculus", 15)])
def test_every_viseme_has_a_shape_with_the_prefix_of_its_set(section: str, count: int) -> None:
    shapes = list_shapes(ALL, BOOK, sets=(section,))
    assert len(shapes.poses) == count
    assert all(name.startswith(f"viseme_{section[8:]}_") for name in shapes.poses)
    assert shapes.left_out == {}


def test_every_action_unit_is_made_or_left_out_with_a_reason() -> None:
    shapes = list_shapes(ALL, BOOK, sets=("facs",))
    for unit in action_units().values():
        sides = {unit.target, f"{unit.target}_l", f"{unit.target}_r"}
        assert bool(sides & set(shapes.poses)) != (unit.target in shapes.left_out)
        assert shapes.left_out.get(unit.target, "") == unit.left_out


def test_a_one_sided_entry_gets_its_mirror_image() -> None:
    facs = BOOK.standards["facs"]
    assert facs["46_r"] == mirrored(facs["46_l"])
    assert facs["30_r"] == {"jaw_yaw": -facs["30_l"]["jaw_yaw"]}


def test_the_set_of_the_thesis_has_its_visemes_and_expressions() -> None:
    names = list(list_shapes(ALL, BOOK, sets=("mpeg4_84",)).poses)
    assert len(names) == 14 + 6
    assert set(EMOTIONS) < set(names)


def test_every_pose_of_the_standards_stays_within_the_ranges_of_its_controls() -> None:
    ranges = {control.name: control for control in ALL}
    for section in STANDARD_SETS:
        for name, pose in BOOK.standards[section].items():
            for control, value in pose.items():
                assert ranges[control].low <= value <= ranges[control].high, (section, name)


def test_an_entry_that_the_standard_lacks_is_refused() -> None:
    with pytest.raises(FormatError, match=r"p.json: facs: not in this standard: 99"):
        _book(facs={"99": {"jaw_pitch": 1.0}})
    with pytest.raises(FormatError, match="visemes_mpeg4: not in this standard: sil"):
        _book(visemes_mpeg4={"sil": {}})


def test_a_book_without_a_section_leaves_its_shapes_out() -> None:
    shapes = list_shapes(ALL, _book(), sets=("visemes_oculus",))
    assert shapes.poses == {}
    assert set(shapes.left_out.values()) == {"no pose in the presets makes it"}
