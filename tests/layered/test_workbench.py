"""Drawing muscles: a change touches only what it must, and the result is that of a full build."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from risorius.anatomy.skull import builtin_skull
from risorius.anatomy.template import builtin_head
from risorius.errors import ParameterError
from risorius.layered import LayeredFace, default_muscle_map
from risorius.layered.drawing import SkullSpace, drawn_muscle, ring_of_loops, sheet_of_lines
from risorius.layered.editing import (
    free_name,
    in_layer,
    moved_point,
    renamed,
    with_muscle,
    with_point,
    without_muscle,
    without_point,
)
from risorius.layered.muscle import EyeAction, MouthAction, Sheet, SheetAction
from risorius.layered.workbench import Workbench

LINE = np.array([[50.0, -22.0, 70.0], [40.0, -44.0, 77.0], [28.0, -66.0, 84.0]])


@pytest.fixture(scope="module")
def bench() -> Workbench:
    return Workbench.build(builtin_head())


def _assert_same_face(found: LayeredFace, expected: LayeredFace) -> None:
    assert list(found.fields) == list(expected.fields)
    assert found.controls == expected.controls
    for name, field in expected.fields.items():
        assert np.array_equal(found.fields[name], field), name
    for name, fibres in expected.fibres.items():
        assert np.array_equal(found.fibres[name], fibres), name


def test_a_moved_deep_muscle_gives_the_face_of_a_full_build(bench: Workbench) -> None:
    drawn = bench.face.muscle_map
    muscle = drawn.by_name["fatty_tissue"]
    assert isinstance(muscle.shape, Sheet)
    moved = moved_point(muscle, 1, muscle.shape.line[1] + [0.0, 2.0, 3.0])
    changed = with_muscle(drawn, moved)
    found = bench.redrawn(changed).face
    _assert_same_face(found, LayeredFace.build(builtin_head(), changed))
    assert not np.array_equal(
        found.fields["zygomaticus_major_l"], bench.face.fields["zygomaticus_major_l"]
    )


def test_a_new_muscle_and_its_removal_come_back_to_the_start(bench: Workbench) -> None:
    drawn = bench.face.muscle_map
    muscle = drawn_muscle(drawn, "smiler", sheet_of_lines([LINE]), on=("cranium",))
    more = bench.redrawn(with_muscle(drawn, muscle))
    assert {"smiler_l", "smiler_r"} <= set(more.face.fields)
    lip = builtin_head().landmarks.vertex("8.3")
    moved = more.face.displace({"smiler_l": 1.0})[lip]
    assert moved[1] > 2.0 and np.linalg.norm(moved) < 25.0
    fewer = more.redrawn(without_muscle(more.face.muscle_map, "smiler"))
    _assert_same_face(fewer.face, bench.face)


def test_untouched_fields_are_taken_over_not_computed(bench: Workbench) -> None:
    drawn = bench.face.muscle_map
    muscle = drawn.by_name["zygomaticus_major"]
    more = bench.redrawn(with_muscle(drawn, replace(muscle, shortening=0.2)))
    assert more.face.fields["frontalis_l"] is bench.face.fields["frontalis_l"]
    assert more.face.fields["zygomaticus_major_l"] is not bench.face.fields["zygomaticus_major_l"]


def test_skull_space_and_back_is_the_same_place(bench: Workbench) -> None:
    space = SkullSpace(builtin_skull(), bench.face.skull)
    assert np.allclose(space.from_head(space.to_head(LINE)), LINE, atol=1e-4)
    corner = bench.face.skull.cranium.positions[100:101]
    drawn = builtin_head().frame.to_input(builtin_skull().cranium.positions[100:101])
    assert np.allclose(space.from_head(corner), drawn, atol=1e-6)


def test_four_lines_make_a_sheet_as_wide_as_they_reach() -> None:
    side = np.array([1.0, 0.0, 0.0])
    lines = [LINE + k * side for k in (-6.0, 2.0, 6.0)] + [(LINE - 2.0 * side)[::-1]]
    sheet = sheet_of_lines(lines)
    assert np.allclose(sheet.half_width, 6.0)
    assert np.allclose(sheet.line[[0, -1]], LINE[[0, -1]])


def test_one_line_stays_where_it_was_drawn() -> None:
    assert np.array_equal(sheet_of_lines([LINE]).line, LINE)


def _loop(centre: tuple[float, float, float], a: float, b: float) -> np.ndarray:
    angle = np.linspace(0.0, 2.0 * np.pi, 9)[:-1]
    return np.array(centre) + np.stack([a * np.cos(angle), b * np.sin(angle), 0 * angle], axis=1)


@pytest.mark.parametrize(
    ("centre", "action", "mirror"),
    [((0.0, -68.0, 100.0), MouthAction, False), ((31.0, 1.0, 84.0), EyeAction, True)],
)
def test_two_loops_make_a_sphincter_of_what_they_surround(centre, action, mirror) -> None:
    ring = ring_of_loops(_loop(centre, 30.0, 16.0), _loop(centre, 20.0, 6.0))
    assert np.allclose(ring.inner, [20.0, 6.0]) and np.allclose(ring.outer, [30.0, 16.0])
    muscle = drawn_muscle(default_muscle_map(), "closer", ring, on=("cranium",))
    assert isinstance(muscle.action, action)
    assert muscle.mirror is mirror


def test_a_sphincter_elsewhere_is_passive() -> None:
    ring = ring_of_loops(_loop((40.0, 90.0, 70.0), 9.0, 9.0), _loop((40.0, 90.0, 70.0), 4.0, 4.0))
    muscle = drawn_muscle(default_muscle_map(), "patch", ring)
    assert muscle.action is None and not muscle.active


def test_what_is_drawn_on_the_right_is_stored_on_the_left() -> None:
    right = LINE * [-1.0, 1.0, 1.0]
    muscle = drawn_muscle(default_muscle_map(), "smiler", sheet_of_lines([right]))
    assert isinstance(muscle.shape, Sheet) and isinstance(muscle.action, SheetAction)
    assert np.allclose(muscle.shape.line, LINE)
    assert muscle.action.corner > 0.5, "it ends at the mouth corner"


def test_a_muscle_on_another_lies_one_layer_above_and_on_its_ground() -> None:
    drawn = default_muscle_map()
    muscle = drawn_muscle(drawn, "upper", sheet_of_lines([LINE]), on=("zygomaticus_major",))
    assert muscle.layer == drawn.by_name["zygomaticus_major"].layer + 1
    assert set(muscle.on) >= {"zygomaticus_major", "cranium"}


def test_points_are_inserted_moved_and_deleted() -> None:
    muscle = default_muscle_map().by_name["zygomaticus_major"]
    assert isinstance(muscle.shape, Sheet)
    more = with_point(muscle, 1, np.array([47.0, -36.0, 72.0]))
    assert isinstance(more.shape, Sheet) and len(more.shape.line) == 4
    back = without_point(more, 1)
    assert isinstance(back.shape, Sheet)
    assert np.array_equal(back.shape.line, muscle.shape.line)
    assert np.array_equal(back.shape.half_width, muscle.shape.half_width)


def test_a_renamed_muscle_is_renamed_where_others_lie_on_it() -> None:
    drawn = renamed(default_muscle_map(), "fatty_tissue", "cheek_fat")
    assert "cheek_fat" in drawn.by_name["zygomaticus_major"].on
    assert "fatty_tissue" not in drawn.by_name
    assert renamed(drawn, "cheek_fat", "fatty_tissue").to_json() == default_muscle_map().to_json()


def test_what_lay_on_a_deleted_muscle_lies_on_its_ground() -> None:
    drawn = without_muscle(default_muscle_map(), "frontalis_inner")
    assert drawn.by_name["corrugator"].on == ("frontalis", "cranium", "frontalis_outer")


def test_a_taken_name_gets_a_number() -> None:
    assert free_name(default_muscle_map(), "risorius") == "risorius_2"
    assert free_name(default_muscle_map(), "cranium") == "cranium_2"


@pytest.mark.parametrize(
    ("act", "sentence"),
    [
        (lambda m: without_muscle(m, "biceps"), "there is no 'biceps'"),
        (lambda m: renamed(m, "risorius", "nasalis"), "'nasalis' is taken"),
        (lambda m: renamed(m, "risorius", "Smile!"), "use small letters"),
        (lambda m: renamed(m, "risorius", "smile_l"), "leave out the side"),
        (lambda m: in_layer(m, "zygomaticus_major", 1), "it must lie on deeper layers"),
        (lambda m: in_layer(m, "zygomaticus_major", 99), "layer"),
        (lambda m: moved_point(m.by_name["orbicularis_oris"], 0, LINE[0]), "no line of points"),
        (lambda m: moved_point(m.by_name["risorius"], 3, LINE[0]), "no point 3 among 3"),
        (lambda m: moved_point(m.by_name["risorius"], 0, LINE[0] * np.nan), "three finite"),
        (lambda m: with_point(m.by_name["risorius"], 9, LINE[0]), "no place 9"),
        (
            lambda m: without_point(without_point(m.by_name["risorius"], 1), 0),
            "delete the muscle instead",
        ),
        (lambda m: sheet_of_lines([]), "at least one action line"),
        (lambda m: sheet_of_lines([LINE[:1]]), "two points"),
        (lambda m: sheet_of_lines([LINE[[0, 0]]]), "two points"),
        (lambda m: ring_of_loops(LINE[:2], LINE), "three points"),
        (lambda m: ring_of_loops(LINE, LINE), "inside the other"),
        (
            lambda m: drawn_muscle(m, "x", sheet_of_lines([LINE]), on=("biceps",)),
            "no 'biceps' to lie on",
        ),
    ],
)
def test_what_cannot_be_is_refused_in_a_sentence(act, sentence: str) -> None:
    with pytest.raises(ParameterError, match=sentence):
        act(default_muscle_map())
