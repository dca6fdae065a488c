"""Project files: read, write, upgrade."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from risorius.controls.shape_sets import SHAPE_SETS
from risorius.errors import FormatError, ParameterError
from risorius.head.frame import MILLIMETRES
from risorius.head.part import PART_KINDS
from risorius.layered import default_muscle_map
from risorius.project import (
    PROFILES,
    Project,
    landmarks_of,
    read_project,
    upgrade_project,
    write_project,
)
from risorius.project.files import SCHEMA, VERSION
from risorius.project.layered import muscle_map_of

_NAMES = st.text(st.characters(codec="utf-8", exclude_categories=["Cs", "Cc"]), min_size=1)
_FILES = st.from_regex(r"[a-z][a-z0-9 ._-]{0,8}[a-z]", fullmatch=True)


@st.composite
def _projects(draw: st.DrawFn, folder: Path) -> Project:
    place = st.none() | _FILES.map(lambda name: folder / name)
    return Project(
        head=draw(place),
        landmarks=draw(place),
        unit=draw(st.none() | st.sampled_from([*MILLIMETRES])),
        axes=draw(st.none() | st.just("+Y+Z")),
        parts=draw(st.dictionaries(st.sampled_from(PART_KINDS), _NAMES, max_size=3)),
        flip_landmarks=draw(st.booleans()),
        profile=draw(st.sampled_from(PROFILES)),
        parameters=draw(st.dictionaries(_NAMES, st.floats(-10, 10) | _NAMES, max_size=3)),
        vector_set=draw(place),
        presets=draw(place),
        shapes=tuple(draw(st.lists(st.sampled_from(SHAPE_SETS), unique=True, min_size=1))),
    )


@settings(max_examples=40)
@given(data=st.data())
def test_what_is_written_is_read(tmp_path_factory: pytest.TempPathFactory, data) -> None:
    folder = tmp_path_factory.getbasetemp().resolve()
    project = data.draw(_projects(folder))
    path = folder / "project.json"
    write_project(project, path)
    read = read_project(path)
    assert read == project
    first = path.read_bytes()
    write_project(read, path)
    assert path.read_bytes() == first


def test_paths_are_written_as_seen_from_the_project(tmp_path: Path, monkeypatch) -> None:
    (tmp_path / "work").mkdir()
    monkeypatch.chdir(tmp_path / "work")
    project = Project(head=Path("head.obj"), landmarks=Path("../marks/head.json"))
    write_project(project, "out.json")
    document = json.loads(Path("out.json").read_text("utf-8"))
    assert document["head"] == "head.obj"
    assert document["landmarks"] == "../marks/head.json"
    monkeypatch.chdir(tmp_path)
    assert read_project("work/out.json").head == Path("work/head.obj")
    write_project(Project(head=Path("heads/head.obj")), "work/out.json")
    assert json.loads(Path("work/out.json").read_text("utf-8"))["head"] == "../heads/head.obj"


def test_the_built_in_head_has_a_word(tmp_path: Path) -> None:
    write_project(Project(), tmp_path / "p.json")
    assert json.loads((tmp_path / "p.json").read_text())["head"] == "builtin"
    assert read_project(tmp_path / "p.json") == Project()


def _written(folder: Path, **entries: Any) -> Path:
    path = folder / "p.json"
    path.write_text(json.dumps({"schema": SCHEMA, "version": VERSION, "head": "h.obj", **entries}))
    return path


@pytest.mark.parametrize(
    ("entries", "sentence"),
    [
        ({"schema": "risorius/rig"}, 'expected "schema": "risorius/project"'),
        ({"version": VERSION + 1}, "update risorius"),
        ({"version": "1"}, '"version" must be a whole number'),
        ({"head": None}, '"head" is missing'),
        ({"head": 3}, "head: expected a text"),
        ({"head": ""}, "is no path"),
        ({"head": "a\0b"}, "is no path"),
        ({"landmark": "l.json"}, "'landmark' is no entry of a project; known: head, landmarks"),
        ({"landmarks": ["l.json"]}, "landmarks: expected a text"),
        ({"parts": ["skin"]}, "parts: expected a JSON object"),
        ({"parts": {"ear": "Ear"}}, "'ear' is not one of"),
        ({"parts": {"skin": 1}}, "skin: expected a text"),
        ({"flip_landmarks": "yes"}, "flip_landmarks: expected true or false"),
        ({"method": "magic"}, "'magic' is not one of"),
        ({"profile": "best"}, "'best' is not one of"),
        ({"parameters": {"steps": [8]}}, "steps: expected a number"),
        ({"parameters": {"steps": True}}, "steps: expected a number"),
        ({"shapes": "arkit"}, "shapes: expected a list"),
        ({"shapes": ["visemes"]}, "'visemes' is not one of"),
        ({"head": {"schema": "mesh"}}, "head: expected a text"),
        ({"poses": {"smile": {"jaw_pitch": "wide"}}}, "jaw_pitch: expected a number"),
    ],
)
def test_a_wrong_entry_is_refused_with_its_place(
    tmp_path: Path, entries: dict[str, Any], sentence: str
) -> None:
    path = _written(tmp_path, **entries)
    with pytest.raises(FormatError) as caught:
        read_project(path)
    assert sentence in str(caught.value)
    assert str(path) in str(caught.value)


@given(data=st.binary(max_size=200))
def test_random_bytes_are_refused(tmp_path_factory: pytest.TempPathFactory, data: bytes) -> None:
    path = tmp_path_factory.getbasetemp() / "random.json"
    path.write_bytes(data)
    with pytest.raises(FormatError):
        read_project(path)


def test_a_remark_is_allowed(tmp_path: Path) -> None:
    assert read_project(_written(tmp_path, about="my head")).head == tmp_path / "h.obj"


def test_a_word_that_is_no_choice_is_refused_at_once() -> None:
    with pytest.raises(ParameterError, match="'slow' is not one of"):
        Project(profile="slow")


def test_recipes_and_poses_in_the_project_itself_come_back_bit_for_bit(tmp_path: Path) -> None:
    recipe = default_muscle_map().to_json()
    pose = {"jaw_pitch": 1.0 / 3.0, "zygomaticus_major_l": 0.1}
    marks = {"schema": "risorius/landmarks", "version": 1, "landmarks": {"2.1": {"vertex": 7}}}
    project = Project(
        inline={"muscle_map": recipe, "landmarks": marks}, poses={"half a smile": pose}
    )
    write_project(project, tmp_path / "p.json")
    again = read_project(tmp_path / "p.json")
    assert again == project
    assert landmarks_of(again, {})["2.1"].vertex == 7
    assert muscle_map_of(again).to_json() == recipe


def test_a_broken_recipe_in_the_project_is_named() -> None:
    with pytest.raises(FormatError, match="project: muscle_map"):
        muscle_map_of(Project(inline={"muscle_map": {"schema": "risorius/style"}}))


def _to_two(document: dict[str, Any]) -> dict[str, Any]:
    others = {key: value for key, value in document.items() if key != "mesh"}
    return {**others, "head": document["mesh"]}


def _to_three(document: dict[str, Any]) -> dict[str, Any]:
    return {**document, "profile": "faithful"}


STEPS = {1: _to_two, 2: _to_three}


def _old(folder: Path) -> Path:
    path = folder / "p.json"
    path.write_text(json.dumps({"schema": SCHEMA, "version": 1, "mesh": "h.obj"}))
    return path


def test_an_upgrade_takes_every_step_and_keeps_the_old_file(tmp_path: Path) -> None:
    path = _old(tmp_path)
    before = path.read_bytes()
    backup = upgrade_project(path, steps=STEPS, version=3)
    assert backup == tmp_path / "p.v1.json"
    assert backup.read_bytes() == before
    assert json.loads(path.read_text()) == {
        "schema": SCHEMA,
        "version": 3,
        "head": "h.obj",
        "profile": "faithful",
    }
    assert upgrade_project(path, steps=STEPS, version=3) is None


def test_an_upgrade_never_replaces_a_backup(tmp_path: Path) -> None:
    path = _old(tmp_path)
    (tmp_path / "p.v1.json").write_text("precious")
    backup = upgrade_project(path, steps=STEPS, version=3)
    assert backup == tmp_path / "p.v1-2.json"
    assert (tmp_path / "p.v1.json").read_text() == "precious"


def test_a_failing_upgrade_changes_nothing(tmp_path: Path, monkeypatch) -> None:
    path = _old(tmp_path)
    before = path.read_bytes()

    def full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("os.fsync", full)
    with pytest.raises(FormatError, match="No space left"):
        upgrade_project(path, steps=STEPS, version=3)
    assert path.read_bytes() == before
    assert list(tmp_path.iterdir()) == [path]


def test_every_old_version_has_a_step_to_the_next() -> None:
    from risorius.project.files import UPGRADES

    assert sorted(UPGRADES) == list(range(1, VERSION))
