"""Undo survives the studio: whatever happens to the two files, nothing is lost or made up."""

from __future__ import annotations

import json
import subprocess
import sys
import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from risorius.errors import FormatError, ParameterError, RisoriusError
from risorius.layered.editing import in_layer
from risorius.project import Project, read_project, write_project
from risorius.springmuscle.editing import without_outline
from risorius.studio import history as histories
from risorius.studio import journal as journals
from risorius.studio.document import Document
from risorius.studio.journal import Journal


@contextmanager
def opened(path: Path, project: Project | None = None) -> Iterator[Document]:
    document = Document.open(path, project)
    try:
        yield document
    finally:
        document.keeper.release()


def _journal(path: Path) -> Path:
    return path.with_name(f".{path.name}.history")


def _pose(document: Document, value: float, gesture: str = "") -> None:
    work = replace(document.work, pose={"jaw_pitch": value})
    document.apply(f"Jaw {value:g}", work, gesture=gesture)


def _twenty(document: Document) -> None:
    """Twenty steps of every kind: map, outlines, pose, method, head's landmarks."""
    for step in range(20):
        work = document.work
        if step % 4 == 0:
            layers = in_layer(work.muscle_map, "corrugator", 4 + step % 3)
            work = replace(work, muscle_map=layers)
        elif step % 4 == 1:
            name = work.recipe.muscles[0].name
            work = replace(work, recipe=without_outline(work.recipe, name))
        elif step % 4 == 2:
            work = replace(work, pose={"jaw_pitch": float(step), "jaw_yaw": 1 / 3})
        else:
            method = ("vector", "springs")[step % 8 // 4]
            work = replace(work, project=replace(work.project, method=method))
        document.apply(f"Step {step}", work)


def _state(document: Document) -> bytes:
    """What the file would hold."""
    document.keep()
    return document.keeper.path.read_bytes()


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "work.json"


def test_reopened_twenty_steps_go_back_to_the_start_and_ahead_to_the_end(path: Path) -> None:
    with opened(path) as document:
        states = [_state(document)]
        _twenty(document)
        labels = document.history[0]
        for _ in range(20):
            document.undo()
            states.insert(1, path.read_bytes())
        for _ in range(20):
            document.redo()
        end = path.read_bytes()
    with opened(path) as document:
        assert document.notice == ""
        assert document.history == (labels, 20)
        assert path.read_bytes() == end
        for _ in range(20):
            document.undo()
        assert path.read_bytes() == states[0]
        with pytest.raises(ParameterError, match="where you started"):
            document.undo()
    with opened(path) as document:
        assert document.history == (labels, 0), "undone first, then closed: redo is there"
        for _ in range(20):
            document.redo()
        assert path.read_bytes() == end


def test_what_steps_share_is_one_object_so_that_faces_are_not_built_anew(path: Path) -> None:
    with opened(path) as document:
        _pose(document, 1.0)
        changed = in_layer(document.work.muscle_map, "corrugator", 5)
        document.apply("Layer", replace(document.work, muscle_map=changed))
        _pose(document, 2.0)
    with opened(path) as document:
        last = document.work
        document.undo()
        layered = document.work
        document.undo()
        first = document.work
        assert layered.muscle_map is last.muscle_map is not first.muscle_map
        for name in ("vectors", "recipe", "landmarks"):
            assert getattr(first, name) is getattr(last, name)
        assert first.pose == {"jaw_pitch": 1.0}


def test_a_new_step_after_reopening_forgets_what_was_undone(path: Path) -> None:
    with opened(path) as document:
        _pose(document, 1.0)
        _pose(document, 2.0)
        document.undo()
    with opened(path) as document:
        _pose(document, 3.0)
    with opened(path) as document:
        assert document.history == (("Opened", "Jaw 1", "Jaw 3"), 2)


def test_a_killed_studio_loses_nothing(path: Path) -> None:
    code = (
        "import os, sys; from pathlib import Path; from dataclasses import replace\n"
        "from risorius.studio.document import Document\n"
        "d = Document.open(Path(sys.argv[1]))\n"
        "for k in range(3): d.apply(f'Jaw {k}', replace(d.work, pose={'jaw_pitch': k + 1.0}))\n"
        "os.kill(os.getpid(), 9)"
    )
    subprocess.run([sys.executable, "-c", code, str(path)], check=False, timeout=120)
    with opened(path) as document:
        assert document.history == (("Opened", "Jaw 0", "Jaw 1", "Jaw 2"), 3)
        document.undo()
        assert document.work.pose == {"jaw_pitch": 2.0}


def test_killed_between_journal_and_project_the_step_can_be_done_again(path: Path) -> None:
    with opened(path) as document:
        _pose(document, 1.0)
        before = path.read_bytes()
        _pose(document, 2.0)
    path.write_bytes(before)
    with opened(path) as document:
        assert (document.notice, document.work.pose) == ("", {"jaw_pitch": 1.0})
        document.redo()
        assert document.work.pose == {"jaw_pitch": 2.0}


def test_a_journal_cut_off_in_its_last_line_keeps_what_was_whole(path: Path) -> None:
    with opened(path) as document:
        _pose(document, 1.0)
        before = path.read_bytes()
        _pose(document, 2.0)
    whole = _journal(path).read_bytes()
    path.write_bytes(before)
    _journal(path).write_bytes(whole[:-40])
    with opened(path) as document:
        assert (document.notice, document.history) == ("", (("Opened", "Jaw 1"), 1))
        _pose(document, 3.0)
    with opened(path) as document:
        assert document.history == (("Opened", "Jaw 1", "Jaw 3"), 2)


def test_a_project_that_somebody_else_changed_is_told_of_and_undo_begins_there(
    path: Path,
) -> None:
    with opened(path) as document:
        _pose(document, 1.0)
    write_project(replace(read_project(path), method="vector"), path)
    with opened(path) as document:
        assert "belongs to another state" in document.notice
        assert "undo begins here" in document.notice
        assert document.history == (("Opened",), 0)
        assert document.work.project.method == "vector"
        _pose(document, 2.0)
    with opened(path) as document:
        assert (document.notice, document.history[0]) == ("", ("Opened", "Jaw 2"))


def test_an_older_copy_of_the_project_finds_its_step(path: Path) -> None:
    with opened(path) as document:
        for value in (1.0, 2.0, 3.0):
            _pose(document, value)
            if value == 1.0:
                copy = path.read_bytes()
    path.write_bytes(copy)
    with opened(path) as document:
        assert document.history == (("Opened", "Jaw 1", "Jaw 2", "Jaw 3"), 1)


def test_work_that_moved_to_another_file_takes_its_history_along(path: Path) -> None:
    with opened(path) as document:
        _pose(document, 1.0)
        write_project(Project(method="vector"), path)
        _pose(document, 2.0)
        moved = document.keeper.path
    with opened(moved) as document:
        assert document.history == (("Opened", "Jaw 1", "Jaw 2"), 2)


def test_without_a_journal_there_is_nothing_to_tell(path: Path) -> None:
    with opened(path) as document:
        _pose(document, 1.0)
    _journal(path).unlink()
    with opened(path) as document:
        assert (document.notice, document.history) == ("", (("Opened",), 0))


def test_a_journal_that_cannot_be_written_costs_the_history_and_nothing_else(path: Path) -> None:
    with opened(path) as document:
        _journal(path).mkdir()
        _pose(document, 1.0)
        assert "undo works until the studio is closed" in document.notice
        assert read_project(path).poses["current"] == {"jaw_pitch": 1.0}
        document.undo()
        assert document.work.pose == {}
    with opened(path) as document:
        assert "is not a regular file" in document.notice or "folder" in document.notice


def test_the_journal_stays_bounded_and_its_oldest_steps_go(
    path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(journals, "_FULL", 60_000)
    monkeypatch.setattr(journals, "_HALF", 30_000)
    with opened(path) as document:
        for step in range(60):
            changed = in_layer(document.work.muscle_map, "corrugator", 4 + step % 3)
            _pose(document, float(step))
            document.apply(f"Layer {step}", replace(document.work, muscle_map=changed))
            assert _journal(path).stat().st_size < 90_000
        labels, place = document.history
        assert labels[-1] == "Layer 59" and 1 < len(labels) < 100
    with opened(path) as document:
        assert document.history == (labels, place)
        while document.undo_label:
            document.undo()
        assert document.work.pose != {}, "the start was forgotten, a step on the way is there"


def test_more_steps_than_are_kept_replay_to_the_same(
    path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(histories, "LONGEST", 30)
    with opened(path) as document:
        for step in range(47):
            _pose(document, float(step % 9))
        history = document.history
        assert len(history[0]) == 30
    with opened(path) as document:
        assert document.history == history


def _line(value: object) -> bytes:
    body = json.dumps(value).encode()
    return b"%08x %s\n" % (zlib.crc32(body), body)


HEAD = {"schema": "risorius/history", "version": 1}
STEP = {
    "step": "x", "gesture": "", "kept": 0, "digest": "0" * 64, "parts": {}, "document": {},
}  # fmt: skip


@pytest.mark.parametrize(
    ("data", "words"),
    [
        (b"", "is damaged"),
        (b"\0" * 50 + b"\n", "is damaged"),
        (_line({"schema": "risorius/project", "version": 1}), 'expected "schema"'),
        (_line({**HEAD, "version": 9}), "update risorius"),
        (_line(HEAD), "holds no step"),
        (_line(HEAD) + _line([1]), "expected a JSON object"),
        (_line(HEAD) + _line(STEP)[:-3] + b"x}\n", "is damaged"),
        (_line(HEAD) + _line({**STEP, "kept": 4}), "not 4 steps before it"),
        (_line(HEAD) + _line({**STEP, "kept": -1}), "kept"),
        (_line(HEAD) + _line({**STEP, "digest": "no"}), "is no digest"),
        (_line(HEAD) + _line({**STEP, "parts": {"recipe": "0" * 64}}), "'recipe' is missing"),
        (_line(HEAD) + _line({**STEP, "document": 3}), "expected a JSON object"),
        (_line(HEAD) + _line({"place": 0, "digest": "0" * 64}), "there is no step 0"),
        (_line(HEAD) + _line({"part": "0" * 64, "content": {}}), "does not hold what it says"),
        (_line(HEAD) + _line({"part": "short"}), "is no part"),
        (_line(HEAD) + _line(STEP), "another state of the project"),
        (_line(HEAD) + b"[" * 100_000 + b"\n", "is damaged"),
    ],
)
def test_a_hostile_journal_is_refused_without_harm(path: Path, data: bytes, words: str) -> None:
    write_project(Project(), path)
    before = path.read_bytes()
    _journal(path).write_bytes(data)
    with pytest.raises(FormatError, match=words):
        Journal(path).read(before)
    with opened(path) as document:
        assert "undo begins here" in document.notice
        assert path.read_bytes() == before
        _pose(document, 1.0)
    with opened(path) as document:
        assert (document.notice, document.history[0]) == ("", ("Opened", "Jaw 1"))


def test_a_step_that_names_what_is_not_there_is_refused_and_the_work_stays(path: Path) -> None:
    with opened(path) as document:
        _pose(document, 1.0)
        _pose(document, 2.0)
    lines = _journal(path).read_bytes().splitlines(keepends=True)
    for number, line in enumerate(lines):
        entry = json.loads(line[9:])
        if entry.get("step") == "Jaw 1":
            entry["document"]["head"] = "gone.obj"
            lines[number] = _line(entry)
    _journal(path).write_bytes(b"".join(lines))
    with opened(path) as document:
        with pytest.raises(RisoriusError, match="no such file"):
            document.undo()
        assert document.work.pose == {"jaw_pitch": 2.0}
        assert document.undo_label == "Jaw 2"


@settings(max_examples=60)
@given(data=st.data())
def test_no_damage_to_a_journal_does_more_than_being_refused(
    tmp_path_factory: pytest.TempPathFactory, data: st.DataObject
) -> None:
    path, content, whole = _real_one(tmp_path_factory)
    start = data.draw(st.integers(0, len(whole)))
    end = data.draw(st.integers(start, min(start + 60, len(whole))))
    noise = data.draw(st.binary(max_size=40))
    _journal(path).write_bytes(whole[:start] + noise + whole[end:])
    try:
        found = Journal(path).read(content)
    except FormatError:
        return
    assert found is not None and 0 <= found.place < len(found.steps)


_KEPT: list[tuple[Path, bytes, bytes]] = []


def _real_one(factory: pytest.TempPathFactory) -> tuple[Path, bytes, bytes]:
    if not _KEPT:
        path = factory.mktemp("journal") / "work.json"
        with opened(path) as document:
            _pose(document, 1.0)
            changed = in_layer(document.work.muscle_map, "corrugator", 5)
            document.apply("Layer", replace(document.work, muscle_map=changed))
            document.undo()
        _KEPT.append((path, path.read_bytes(), _journal(path).read_bytes()))
    return _KEPT[0]
