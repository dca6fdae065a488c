"""`risorius project`."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from risorius import Rig
from risorius.project import read_project
from tests.cli.running import answer, asset, run


def test_a_project_rigs_like_the_options_that_made_it(tmp_path: Path) -> None:
    options = ("--method", "vector", "--profile", "faithful", "--shapes", "emotions")
    project = tmp_path / "mine.json"
    result = run(
        *("project", "new", asset("head.obj"), "-o", project),
        *("-l", asset("head.landmarks.json"), *options),
    )
    assert result.exit_code == 0, result.stderr
    run("rig", project, "-o", tmp_path / "a.npz")
    run("rig", asset("head.obj"), "-o", tmp_path / "b.npz", *options)
    assert (tmp_path / "a.npz").read_bytes() == (tmp_path / "b.npz").read_bytes()


def test_options_go_before_what_the_project_says(tmp_path: Path) -> None:
    project = tmp_path / "mine.json"
    run("project", "new", "builtin", "-o", project, "--shapes", "arkit")
    run("rig", project, "-o", tmp_path / "a.npz", "--shapes", "emotions")
    assert "joy" in Rig.load(tmp_path / "a.npz").names


def test_recipes_are_copied_once_and_used(tmp_path: Path) -> None:
    project = tmp_path / "mine.json"
    result = run("project", "new", "builtin", "-o", project, "--recipes")
    assert result.exit_code == 0, result.stderr
    presets, vectors = tmp_path / "mine.presets.json", tmp_path / "mine.vectors.json"
    read = read_project(project)
    assert (read.presets, read.vector_set) == (presets, vectors)
    run("rig", project, "-o", tmp_path / "a.npz", "--shapes", "emotions")
    run("rig", "builtin", "-o", tmp_path / "b.npz", "--shapes", "emotions")
    before = Rig.load(tmp_path / "b.npz")
    assert Rig.load(tmp_path / "a.npz").names == before.names
    book = json.loads(presets.read_text("utf-8"))
    book["emotions"] = {"joy": {"jaw_pitch": 5.0}}
    presets.write_text(json.dumps(book))
    run("rig", project, "-o", tmp_path / "a.npz", "--shapes", "emotions")
    edited = Rig.load(tmp_path / "a.npz")
    assert edited.names == ("joy",)
    assert dict(edited.target("joy").pose) == {"jaw_pitch": 5.0}


def test_recipes_never_replace_edited_ones(tmp_path: Path) -> None:
    (tmp_path / "mine.presets.json").write_text("edited")
    result = run("project", "new", "builtin", "-o", tmp_path / "mine.json", "--recipes")
    assert result.exit_code == 1
    assert "may have been edited" in result.stderr
    assert (tmp_path / "mine.presets.json").read_text() == "edited"
    assert not (tmp_path / "mine.json").exists()


def test_an_existing_project_is_not_replaced_by_a_new_one(tmp_path: Path) -> None:
    project = tmp_path / "mine.json"
    run("project", "new", "builtin", "-o", project)
    before = project.read_bytes()
    result = run("project", "new", "builtin", "-o", project, "--shapes", "arkit")
    assert result.exit_code == 1
    assert "exists already; change it with `risorius project set`" in result.stderr
    assert project.read_bytes() == before


def test_set_changes_only_what_is_mentioned(tmp_path: Path) -> None:
    project = tmp_path / "mine.json"
    run("project", "new", "builtin", "-o", project, "--shapes", "arkit", "--unit", "mm")
    result = run("project", "set", project, "--profile", "faithful", "--parameter", "steps=4")
    assert result.exit_code == 0, result.stderr
    read = read_project(project)
    assert (read.shapes, read.unit) == (("arkit",), "mm")
    assert (read.profile, dict(read.parameters)) == ("faithful", {"steps": 4.0})


def test_show_tells_missing_files(tmp_path: Path) -> None:
    head = tmp_path / "head.obj"
    head.write_bytes(asset("head.obj").read_bytes())
    project = tmp_path / "mine.json"
    run("project", "new", head, "-o", project, "-l", asset("head.landmarks.json"))
    assert answer(run("project", "show", project, "--json"))["absent"] == []
    head.unlink()
    told = answer(run("project", "show", project, "--json"))
    assert told["absent"] == ["head"]
    assert told["project"]["head"] == str(head)
    assert "(no such file)" in run("project", "show", project).stdout


def test_a_moved_folder_still_works(tmp_path: Path, monkeypatch) -> None:
    old = tmp_path / "old"
    old.mkdir()
    for name in ("head.obj", "head.landmarks.json"):
        (old / name).write_bytes(asset(name).read_bytes())
    run("project", "new", old / "head.obj", "-l", old / "head.landmarks.json", "-o", old / "p.json")
    old.rename(tmp_path / "new")
    monkeypatch.chdir(tmp_path)
    result = run("rig", "new/p.json", "-o", "f.npz", "--shapes", "emotions")
    assert result.exit_code == 0, result.stderr


def test_a_new_project_without_its_files_is_refused(tmp_path: Path) -> None:
    result = run("project", "new", tmp_path / "none.obj", "-o", tmp_path / "p.json")
    assert result.exit_code == 1
    assert "none.obj: no such file" in result.stderr
    assert not (tmp_path / "p.json").exists()


def test_a_newer_project_is_refused_in_one_sentence(tmp_path: Path) -> None:
    project = tmp_path / "p.json"
    project.write_text('{"schema": "risorius/project", "version": 9, "head": "builtin"}')
    for verb in (["rig", project, "-o", tmp_path / "f.glb"], ["project", "upgrade", project]):
        result = run(*verb)
        assert result.exit_code == 1
        assert result.stderr.count("\n") == 1
        assert "version 9" in result.stderr
        assert "update risorius" in result.stderr


def test_upgrade_of_the_newest_version_does_nothing(tmp_path: Path) -> None:
    project = tmp_path / "p.json"
    run("project", "new", "builtin", "-o", project)
    before = project.read_bytes()
    result = run("project", "upgrade", project)
    assert result.exit_code == 0
    assert "nothing to do" in result.stdout
    assert project.read_bytes() == before
    assert list(tmp_path.iterdir()) == [project]


def test_a_landmark_file_is_no_project(tmp_path: Path) -> None:
    result = run("rig", asset("head.landmarks.json"), "-o", tmp_path / "f.glb")
    assert result.exit_code == 1
    assert 'expected "schema": "risorius/project", found "risorius/landmarks"' in result.stderr


@pytest.mark.parametrize(
    ("method", "parameter", "sentence"),
    [
        ("vector", "steps=0.5", "parameters: steps"),
        ("vector", "wobble=1", "the method 'vector' has no 'wobble'"),
        ("layered", "wobble=1", "the method 'layered' has no 'wobble'"),
        ("springs", "wobble=1", "the method 'springs' has no 'wobble'"),
    ],
)
def test_show_refuses_parameters_that_the_method_does_not_have(
    tmp_path: Path, method: str, parameter: str, sentence: str
) -> None:
    project = tmp_path / "mine.json"
    run("project", "new", "builtin", "-o", project, "--method", method)
    run("project", "set", project, "--parameter", parameter)
    shown = run("project", "show", project)
    assert shown.exit_code == 1
    assert sentence in shown.stderr
