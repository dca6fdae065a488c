"""What can be done to the muscles of each method, without a page."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from risorius.anatomy.mechanics import Mechanics
from risorius.anatomy.template import builtin_head
from risorius.errors import FormatError, ParameterError, RisoriusError
from risorius.project import Project, face_of, read_project
from risorius.springmuscle.face import SpringFace
from risorius.studio.document import Document
from risorius.studio.drawing.catalogue import CRAFTS
from risorius.studio.drawing.craft import Craft
from risorius.studio.drawing.sketch import Sketch
from risorius.studio.drawing.spring_feedback import SWITCHES, feedback_of, influence_colours
from risorius.studio.drawing.springs import SpringCraft
from risorius.studio.places import Place
from risorius.studio.scene import Stage, stage_of
from risorius.studio.subject import Subject, build_subject
from risorius.studio.work import Work, work_of

# Rows from the cheek bone to beside the mouth corner, on the left of the built-in head.
ROWS = np.array(
    [[[50.0, -26.0, 78.0], [42.0, -22.0, 82.0]], [[33.0, -62.0, 85.0], [29.0, -56.0, 88.0]]]
)


@cache
def _stage(method: str) -> Stage:
    return stage_of(build_subject(work_of(Project(method=method))))


def _craft(method: str) -> Craft:
    subject = _stage(method).subject
    return CRAFTS[method](subject.work, subject)


def _face() -> SpringFace:
    face = _stage("springs").subject.spring_face
    assert face is not None
    return face


def _place(point: np.ndarray) -> Place:
    """The place on the skin that a pointer would give."""
    ground = _face().ground
    assert ground is not None
    return Place(
        "skin", "skin", 0, np.array([1.0, 0.0, 0.0]), ground.surface.project(point[None])[0][0]
    )


def _rows(rows: np.ndarray = ROWS) -> list[list[Place]]:
    flat = builtin_head().frame.to_canonical(rows.reshape(-1, 3)).reshape(rows.shape)
    return [[_place(point) for point in row] for row in flat]


def _sketched(sketch: Sketch, rows: list[list[Place]]) -> Sketch:
    for row in rows:
        for place in row:
            sketch.put(place)
        assert not sketch.close()
    return sketch


def _smiling() -> tuple[Work, Subject]:
    """The work with a drawn muscle, and its face."""
    subject = _stage("springs").subject
    drawn = _sketched(_craft("springs").sketch("grid", "smiler", mirror=True), _rows()).drawn(
        subject.work, subject
    )
    assert drawn is not None and drawn.name == "smiler_l"
    return drawn.work, build_subject(drawn.work, subject)


@pytest.mark.parametrize("method", list(CRAFTS))
def test_every_body_belongs_to_a_line_of_the_list_and_is_known_by_its_craft(method: str) -> None:
    craft, stage = _craft(method), _stage(method)
    listed = [body for entry in craft.entries() for body in entry.bodies]
    assert len(listed) == len(set(listed))
    for mesh in stage.meshes:
        if mesh.group == "muscles":
            assert mesh.name in listed
            assert craft.own_name(mesh.name)
            assert craft.traits(mesh.name).numbers or method == "vector"


@pytest.mark.parametrize("method", list(CRAFTS))
def test_every_number_can_be_set_and_is_then_what_it_was_set_to(method: str) -> None:
    craft = _craft(method)
    name = craft.entries()[4].bodies[0]
    for number in craft.traits(name).numbers:
        wanted = number.low + 0.75 * (number.high - number.low)
        if number.step:
            wanted = round(wanted)
        after = CRAFTS[method](craft.with_number(name, number.key, wanted), craft.subject)
        found = {each.key: each.value for each in after.traits(name).numbers}
        assert found[number.key] == pytest.approx(wanted, rel=1e-6)


@pytest.mark.parametrize("method", list(CRAFTS))
def test_handles_lie_on_the_chosen_side_and_follow_the_pointer(method: str) -> None:
    craft = _craft(method)
    for name, side in (("zygomaticus_major_l", 1.0), ("zygomaticus_major_r", -1.0)):
        handles = craft.handles(name)
        assert len(handles) >= 2
        if method != "layered":  # the map keeps the left, which is shown
            assert all(side * handle.place[0] > 0.0 for handle in handles)
        last = handles[-1]
        aim = last.place + [2.0 * side, -3.0, 0.0]
        work = craft.moved(name, last.key, _place(aim))
        after = CRAFTS[method](work, build_subject(work, craft.subject))
        moved = next(h for h in after.handles(name) if h.key == last.key)
        assert np.linalg.norm(moved.place - _place(aim).position) < 2.0
        others = zip(handles[:-1], after.handles(name)[:-1])
        assert max(np.linalg.norm(a.place - b.place) for a, b in others) < 0.5


@pytest.mark.parametrize("method", list(CRAFTS))
def test_a_deleted_muscle_has_gone_from_the_list_and_its_control_from_the_face(
    method: str,
) -> None:
    craft = _craft(method)
    work = craft.without("risorius_l")
    after = CRAFTS[method](work, build_subject(work, craft.subject))
    assert "risorius" not in [entry.name for entry in after.entries()]
    assert "risorius_l" not in {control.name for control in after.subject.face.controls}


@pytest.mark.parametrize("method", ["layered", "springs"])
def test_mirroring_and_names_can_be_changed(method: str) -> None:
    craft = _craft(method)
    work, name = craft.mirrored("risorius_l", mirror=False)
    alone = CRAFTS[method](work, craft.subject)
    assert alone.traits(name).mirror is False
    work, name = alone.mirrored(name, mirror=True)
    both = CRAFTS[method](work, craft.subject)
    assert both.traits(name).mirror is True
    work, name = both.renamed(name, "laughter")
    renamed = CRAFTS[method](work, craft.subject)
    assert name == "laughter_l"
    assert renamed.controls(name) == ("laughter_l", "laughter_r")
    assert not renamed.own_name("risorius_l")


@pytest.mark.parametrize("method", ["layered", "springs"])
def test_points_are_inserted_and_deleted(method: str) -> None:
    craft = _craft(method)
    name = "zygomaticus_major_l"
    before = craft.handles(name)
    for handle in (before[0], before[-1]):
        work = craft.with_point(name, handle.key)
        longer = CRAFTS[method](work, craft.subject)
        assert len(longer.handles(name)) == len(before) + 1
        counts = {
            len(CRAFTS[method](longer.without_point(name, each.key), craft.subject).handles(name))
            for each in longer.handles(name)[:1]
        }
        assert counts <= {len(before), len(before) - 1}


def test_two_rows_make_a_spring_muscle_that_lifts_the_mouth_corner() -> None:
    work, subject = _smiling()
    face, head = subject.spring_face, subject.head
    assert face is not None
    craft = SpringCraft(work, subject)
    assert craft.controls("smiler_l") == ("smiler_l", "smiler_r")
    moved = face.pose({"smiler_l": 1.0}) - head.positions
    assert moved[head.skin.first_source()][head.skin_vertex("8.3")][1] > 1.0
    before = _face()
    kept = [m for m in face.muscles.muscles if m in before.muscles.muscles]
    assert len(kept) == len(before.muscles.muscles), "only what was drawn was fitted"


def test_a_row_by_itself_is_no_muscle_yet_and_says_so() -> None:
    sketch = _craft("springs").sketch("grid", "smiler", mirror=True)
    subject = _stage("springs").subject
    assert "first row" in sketch.hint
    sketch.put(_rows()[0][0])
    with pytest.raises(ParameterError, match="a line needs 2 points"):
        sketch.close()
    sketch.put(_rows()[0][1])
    assert not sketch.close()
    assert sketch.drawn(subject.work, subject) is None
    with pytest.raises(ParameterError, match="a muscle needs 2 rows"):
        sketch.close()
    for place in _rows()[1]:
        sketch.put(place)
    assert sketch.drawn(subject.work, subject) is None, "the open row does not count"
    assert not sketch.close()
    assert sketch.drawn(subject.work, subject) is not None
    assert sketch.close(), "an empty row keeps it"
    assert sketch.back() and len(sketch.lines) == 2


def test_drawn_right_the_body_of_the_right_is_chosen() -> None:
    subject = _stage("springs").subject
    rows = _rows(ROWS * [-1.0, 1.0, 1.0])
    drawn = _sketched(_craft("springs").sketch("grid", "smiler", mirror=True), rows).drawn(
        subject.work, subject
    )
    assert drawn is not None and drawn.name == "smiler_r"
    one = _sketched(_craft("springs").sketch("grid", "smiler", mirror=False), rows).drawn(
        subject.work, subject
    )
    assert one is not None and one.name == "smiler_r"
    names = {m.name for m in one.work.recipe.muscles}
    assert "smiler_r" in names and "smiler" not in names


def test_an_outline_that_cannot_be_laid_is_refused_before_it_is_kept() -> None:
    craft = _craft("springs")
    handles = {handle.key: handle for handle in craft.handles("zygomaticus_major_l")}
    last = max(int(key.split(".")[0]) for key in handles)
    beyond = 2.2 * handles[f"{last - 1}.0"].place - 1.2 * handles[f"{last}.0"].place
    with pytest.raises(ParameterError, match="cross"):
        craft.moved("zygomaticus_major_l", f"{last}.0", _place(beyond))
    with pytest.raises(ParameterError, match="coincide"):
        place = Place("skin", "skin", 0, np.zeros(3), handles[f"{last}.1"].place)
        twice = craft.moved("zygomaticus_major_l", f"{last}.1", place)
        SpringCraft(twice, craft.subject).moved("zygomaticus_major_l", f"{last}.0", place)


@pytest.mark.parametrize(
    ("change", "error", "words"),
    [
        (lambda c: c.moved("risorius_l", "x.y", _place(np.zeros(3))), FormatError, "handle"),
        (lambda c: c.moved("risorius_l", "77.0", _place(np.zeros(3))), ParameterError, "no point"),
        (lambda c: c.with_number("risorius_l", "colour", 1.0), ParameterError, "has no 'colour'"),
        (lambda c: c.with_choice("risorius_l", "type", "thigh"), ParameterError, "to choose"),
        (lambda c: c.with_number("thigh", "bulge", 1.0), ParameterError, "choose one first"),
        (lambda c: c.in_layer("risorius_l", 2), ParameterError, "no layer"),
        (lambda c: c.sketch("spoon", "x", mirror=True), ParameterError, "no tool 'spoon'"),
        (lambda c: c.sketch("grid", "Smile!", mirror=True), ParameterError, "small letters"),
        (lambda c: SpringCraft(c.work, None).handles("risorius_l"), ParameterError, "being built"),
    ],
)
def test_what_a_page_may_say_that_makes_no_sense_is_refused(change, error, words: str) -> None:
    with pytest.raises(error, match=words):
        change(_craft("springs"))


@given(key=st.text(max_size=12))
def test_no_handle_of_a_page_fails_otherwise_than_by_refusal(key: str) -> None:
    for method in CRAFTS:
        craft = _craft(method)
        for change in (craft.with_point, craft.without_point):
            try:
                change("risorius_l", key)
            except RisoriusError:
                continue


def test_feedback_shows_what_is_switched_on_and_tells_its_numbers() -> None:
    _, subject = _smiling()
    face = subject.spring_face
    assert face is not None
    seen = feedback_of(face, "smiler_l", {}, SWITCHES)
    assert "grid" in seen.facts and "merges with" in seen.facts and seen.findings == []
    grid = feedback_of(face, "smiler_l", {}, {"grid"})
    assert len(grid.lines) == 2 + 2 and len(grid.segments) == 1 and not grid.dots
    merged = feedback_of(face, "smiler_l", {}, {"merged"})
    contracted = feedback_of(face, "smiler_l", {"smiler_l": 1.0}, {"merged"})
    assert merged.lines and merged.lines != contracted.lines, "it follows the contraction"
    lips = feedback_of(face, "orbicularis_oris", {}, {"jaw"})
    assert lips.dots and not lips.lines
    open_mouth = feedback_of(face, "orbicularis_oris", {"jaw_pitch": 15.0}, {"jaw"})
    lower = [a["at"][1] - b["at"][1] for a, b in zip(lips.dots, open_mouth.dots)]
    assert min(lower) > 1.0, "what hangs on the jaw goes down with it"
    assert feedback_of(face, "thigh", {}, SWITCHES).facts == ""


def _swollen(name: str) -> SpringFace:
    """The face with a muscle six times as thick as its fit made it."""
    muscles = tuple(
        replace(
            each,
            fibres=tuple(replace(f, half_axes=f.half_axes * [1.0, 1.0, 6.0]) for f in each.fibres),
        )
        if each.name == name
        else each
        for each in _face().muscles.muscles
    )
    return replace(_face(), muscles=replace(_face().muscles, muscles=muscles))


def test_every_mistake_is_found_and_said_in_one_sentence() -> None:
    craft = _craft("springs")
    small = craft.with_number("mentalis_l", "radius", 0.5)
    across_the_nose = _rows(
        np.array(
            [
                [[20.0, -18.0, 90.0], [20.0, -30.0, 90.0]],
                [[-20.0, -18.0, 90.0], [-20.0, -30.0, 90.0]],
            ]
        )
    )
    subject = craft.subject
    nose = _sketched(craft.sketch("grid", "bridge", mirror=True), across_the_nose).drawn(
        subject.work, subject
    )
    assert nose is not None and nose.name == "bridge", "it lies on the midline"
    found: list[str] = []
    for work, name in ((small, "mentalis_l"), (nose.work, nose.name)):
        face = build_subject(work, subject).spring_face
        assert face is not None
        found += feedback_of(face, name, {}, {"errors"}).findings
    found += feedback_of(_swollen("risorius_l"), "risorius_l", {}, {"errors"}).findings
    text = "\n".join(found)
    assert "through the skin" in text and "vertices only" in text
    assert "too near" in text or "too deep" in text
    for sentence in found:
        assert sentence.endswith(".") and ":" in sentence, "what is wrong, and what to do"
    for each in _face().muscles.muscles:
        assert feedback_of(_face(), each.name, {}, {"errors"}).findings == [], each.name


def test_the_skin_that_a_muscle_moves_is_green_and_no_other() -> None:
    skin = _stage("springs").mesh("skin")
    assert skin is not None
    painted = influence_colours(_face(), "zygomaticus_major_l", skin.colour)
    assert painted is not None
    changed = (painted != skin.colour).any(axis=1)
    assert 50 < changed.sum() < len(changed) / 4
    assert skin.mesh.positions[changed][:, 0].min() > -5.0
    moved = np.linalg.norm(_face().driver.fields["zygomaticus_major_l"], axis=1)
    assert moved[changed].mean() > 5.0 * moved[~changed].mean()
    assert influence_colours(_face(), "thigh", skin.colour) is None


def test_a_drawn_muscle_is_kept_in_the_project_and_fits_the_face_that_others_build_of_it(
    tmp_path: Path,
) -> None:
    work, subject = _smiling()
    document = Document.open(tmp_path / "work.json", Project(method="springs"))
    document.apply("Draw smiler", replace(work, project=document.work.project))
    document.keeper.release()
    project = read_project(tmp_path / "work.json")
    assert project.inline["recipe"]["muscles"][-1]["name"] == "smiler"
    face = face_of(project, builtin_head(), mechanics=Mechanics.build(builtin_head()))
    pose = {"smiler_l": 1.0}
    assert np.abs(face.pose(pose) - subject.face.pose(pose)).max() < 2e-4 * builtin_head().height
