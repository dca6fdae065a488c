"""The document: every state kept, nothing lost, nobody's work overwritten."""

from __future__ import annotations

import json
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest

from risorius.errors import FormatError, ParameterError, RisoriusError
from risorius.layered.editing import in_layer, without_muscle
from risorius.project import Project, read_project, write_project
from risorius.project.layered import muscle_map_of
from risorius.studio.document import Document


@pytest.fixture
def document(tmp_path: Path):
    opened = Document.open(tmp_path / "work.json")
    yield opened
    opened.keeper.release()


def _posed(document: Document, value: float) -> None:
    work = replace(document.work, pose={"jaw_pitch": value})
    document.apply("Jaw", work, gesture="slider jaw_pitch")


def test_opening_writes_nothing(document: Document) -> None:
    assert not document.keeper.path.exists()
    assert document.undo_label == document.redo_label == ""


def test_every_step_is_in_the_file_at_once_and_comes_back_bit_for_bit(document: Document) -> None:
    work = document.work
    fewer = without_muscle(work.muscle_map, "risorius")
    document.apply("Delete risorius", replace(work, muscle_map=fewer, pose={"jaw_pitch": 1 / 3}))
    kept = document.keeper.path.read_bytes()
    document.keeper.release()
    again = Document.open(document.keeper.path)
    assert again.work.muscle_map.to_json() == fewer.to_json()
    assert again.work.pose == {"jaw_pitch": 1 / 3}
    again.keep()
    assert document.keeper.path.read_bytes() == kept
    again.keeper.release()


def test_undo_of_everything_is_the_start_and_redo_the_end(document: Document) -> None:
    start = document.work
    for step in range(20):
        layer = 4 + step % 3
        changed = in_layer(document.work.muscle_map, "corrugator", layer)
        document.apply(f"Layer {layer}", replace(document.work, muscle_map=changed))
    end = document.work
    for _ in range(20):
        document.undo()
    assert document.work is start
    assert "muscle_map" not in read_project(document.keeper.path).inline
    for _ in range(20):
        document.redo()
    assert document.work is end
    found = muscle_map_of(read_project(document.keeper.path))
    assert found.to_json() == end.muscle_map.to_json()


def test_a_new_step_forgets_what_was_undone(document: Document) -> None:
    _posed(document, 1.0)
    document.undo()
    document.apply("Other", replace(document.work, pose={"jaw_yaw": 1.0}))
    with pytest.raises(ParameterError, match="nothing was undone"):
        document.redo()


def test_one_gesture_is_one_step(document: Document) -> None:
    for value in (1.0, 2.0, 3.0):
        _posed(document, value)
    document.undo()
    assert document.work.pose == {}
    with pytest.raises(ParameterError, match="where you started"):
        document.undo()


def test_two_studios_do_not_open_one_project(document: Document) -> None:
    code = (
        "import sys; from pathlib import Path; from risorius.studio.document import Document\n"
        "Document.open(Path(sys.argv[1]))"
    )
    done = subprocess.run(
        [sys.executable, "-c", code, str(document.keeper.path)],
        capture_output=True, text=True, check=False, timeout=120,
    )  # fmt: skip
    assert done.returncode != 0
    assert "is open in another studio" in done.stderr


def test_the_lock_of_a_killed_studio_does_not_hold(tmp_path: Path) -> None:
    code = (
        "import os, sys; from pathlib import Path; from risorius.studio.document import Document\n"
        "Document.open(Path(sys.argv[1])); os.kill(os.getpid(), 9)"
    )
    path = tmp_path / "work.json"
    subprocess.run([sys.executable, "-c", code, str(path)], check=False, timeout=120)
    Document.open(path).keeper.release()


def test_what_another_program_wrote_is_never_replaced(document: Document) -> None:
    _posed(document, 1.0)
    path = document.keeper.path
    write_project(Project(method="vector"), path)
    foreign = path.read_bytes()
    _posed(document, 2.0)
    assert path.read_bytes() == foreign
    assert document.keeper.moved_from == path
    assert document.keeper.path.name == "work.2.json"
    assert read_project(document.keeper.path).poses["current"] == {"jaw_pitch": 2.0}


def test_files_that_nobody_changed_stay_files(tmp_path: Path) -> None:
    work = muscle_map_of(Project())
    (tmp_path / "mine.json").write_text(json.dumps(without_muscle(work, "risorius").to_json()))
    path = tmp_path / "work.json"
    write_project(Project(muscle_map=tmp_path / "mine.json"), path)
    document = Document.open(path)
    _posed(document, 1.0)
    kept = read_project(path)
    assert kept.muscle_map == tmp_path / "mine.json"
    assert "muscle_map" not in kept.inline
    document.keeper.release()


@pytest.mark.parametrize("name", ["work.txt", "no/such/folder.json"])
def test_a_place_that_cannot_be_is_refused(tmp_path: Path, name: str) -> None:
    with pytest.raises(FormatError):
        Document.open(tmp_path / name)


def test_a_broken_project_is_refused_and_let_go(tmp_path: Path) -> None:
    path = tmp_path / "work.json"
    path.write_text('{"schema": "risorius/project", "version": 1, "head": "gone.obj"}')
    for _ in range(2):
        with pytest.raises(RisoriusError, match="no such file"):
            Document.open(path)
