"""Write and describe projects."""

from __future__ import annotations

import json
from dataclasses import fields, replace
from importlib.resources import files
from pathlib import Path
from typing import Any

from risorius.cli.talk import Talk
from risorius.errors import FormatError
from risorius.io.atomic import write_bytes
from risorius.project import Project, presets_of, read_mesh, vectors_of, write_project

__all__ = ["describe", "keep"]


def keep(project: Project, path: Path, talk: Talk, *, recipes: bool) -> None:
    """Write a project after a look at every file that it names.

    Parameters
    ----------
    project : Project
    path : Path
    talk : Talk
    recipes : bool
        Copy presets and vector set beside the project first, where it uses those that ship.

    Raises
    ------
    RisoriusError
        If a file is missing or malformed, or the project cannot be written.
    """
    if path.suffix.lower() != ".json":
        raise FormatError(f"{path}: a project is a text file; give a name that ends in .json")
    read_mesh(project)
    presets_of(project)
    vectors_of(project)
    if project.landmarks is not None and not project.landmarks.is_file():
        raise FormatError(f"{project.landmarks}: no such file")
    if recipes:
        project = _with_recipes(project, path, talk)
    write_project(project, path)
    talk.say(f"wrote {path}")
    describe(project, talk)
    talk.put(output=path)


def describe(project: Project, talk: Talk) -> None:
    """Say what a project holds."""
    shown: dict[str, Any] = {}
    absent: list[str] = []
    for entry in fields(Project):
        value: Any = getattr(project, entry.name)
        if entry.name == "head":
            value = project.name
        elif entry.name in ("inline", "poses"):
            value = tuple(value)
        shown[entry.name] = value
        if isinstance(getattr(project, entry.name), Path) and not Path(value).is_file():
            absent.append(entry.name)
        talk.say(
            f"  {entry.name}: {_words(value)}{' (no such file)' if entry.name in absent else ''}"
        )
    talk.put(project=shown, absent=absent)


def _words(value: Any) -> str:
    if value is None or value == {}:
        return "-"
    if isinstance(value, tuple):
        return ", ".join(str(item) for item in value)  # pyright: ignore[reportUnknownVariableType]
    if isinstance(value, dict):
        return ", ".join(f"{key}={item}" for key, item in value.items())  # pyright: ignore
    return {True: "yes", False: "no"}[value] if isinstance(value, bool) else str(value)


def _with_recipes(project: Project, path: Path, talk: Talk) -> Project:
    changed: dict[str, Path] = {}
    if project.presets is None:
        text = files("risorius.controls").joinpath("data/presets.json").read_text("utf-8")
        changed["presets"] = _fresh(path.with_suffix(".presets.json"))
        write_bytes(changed["presets"], text.encode())
    if project.vector_set is None:
        document = json.dumps(vectors_of(project).to_json(), indent=1, ensure_ascii=False)
        changed["vector_set"] = _fresh(path.with_suffix(".vectors.json"))
        write_bytes(changed["vector_set"], f"{document}\n".encode())
    for copy in changed.values():
        talk.say(f"wrote {copy}")
    return replace(project, **changed)


def _fresh(path: Path) -> Path:
    if path.exists():
        raise FormatError(f"{path}: exists already and may have been edited; remove or rename it")
    return path
