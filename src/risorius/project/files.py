"""Read, write and upgrade project files."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from risorius.controls.shape_sets import SHAPE_SETS
from risorius.errors import FormatError, ParameterError
from risorius.io.atomic import write_bytes
from risorius.io.bounded import MEGABYTE, check_schema, read_json
from risorius.io.json_fields import Fields
from risorius.project.project import BUILTIN, INLINE, Project

__all__ = [
    "SCHEMA",
    "UPGRADES",
    "VERSION",
    "parse_project",
    "project_bytes",
    "project_document",
    "read_project",
    "upgrade_project",
    "write_project",
]

SCHEMA = "risorius/project"
VERSION = 2
_LIMIT = 64 * MEGABYTE
_PATHS = (
    "head", "landmarks", "vector_set", "muscle_map", "recipe", "presets", "skull", "mandible",
    "skull_landmarks",
)  # fmt: skip
_TEXTS = ("unit", "axes", "method", "profile", "bones")
_OTHERS = ("parts", "flip_landmarks", "parameters", "shapes", "poses")

Document = dict[str, Any]
Upgrade = Callable[[Document], Document]
UPGRADES: dict[int, Upgrade] = {1: dict}
"""For each old version the step that turns its content into the next version's.

Version 2 lets recipes stand in the project itself and keeps poses; version 1 needs no change.
"""


def read_project(path: str | Path) -> Project:
    """Read a project; paths in it count from its own folder.

    Raises
    ------
    FormatError
        If the file is malformed, of another schema or of a newer version.
    """
    return parse_project(read_json(path, schema=SCHEMA, version=VERSION, limit=_LIMIT), Path(path))


def parse_project(document: Document, path: Path) -> Project:
    """Build the project from the parsed JSON of its file at `path`.

    Raises
    ------
    FormatError
        If it is malformed, of another schema or of a newer version.
    """
    check_schema(document, str(path), schema=SCHEMA, version=VERSION)
    return _parse(_lifted(document, UPGRADES, VERSION), path)


def write_project(project: Project, path: str | Path) -> None:
    """Write a project; paths below or beside its folder are written relative to it.

    Raises
    ------
    FormatError
        If the file cannot be written.
    """
    write_bytes(Path(path), project_bytes(project, Path(path)))


def project_bytes(project: Project, path: Path) -> bytes:
    """Return the content of a project's file at `path`."""
    text = json.dumps(
        project_document(project, path), indent=2, ensure_ascii=False, allow_nan=False
    )
    return f"{text}\n".encode()


def project_document(project: Project, path: Path) -> Document:
    """Return the JSON of a project as its file at `path` holds it."""
    document: Document = {"schema": SCHEMA, "version": VERSION}
    folder = Path(os.path.realpath(path)).parent
    for name in (*_PATHS[:2], *_TEXTS[:2], *_OTHERS[:2], *_TEXTS[2:], *_OTHERS[2:], *_PATHS[2:]):
        value = project.inline.get(name) or getattr(project, name)
        if name == "head" and value is None:
            document[name] = BUILTIN
        elif isinstance(value, Path):
            document[name] = _relative(value, folder)
        elif isinstance(value, Mapping):
            if value:
                document[name] = dict(value)  # pyright: ignore[reportUnknownArgumentType]
        elif value is not None and value is not False:
            document[name] = list(value) if isinstance(value, tuple) else value
    return document


def upgrade_project(
    path: str | Path, *, steps: Mapping[int, Upgrade] | None = None, version: int = VERSION
) -> Path | None:
    """Rewrite a project of an older version in the newest one.

    Parameters
    ----------
    path : path
    steps : mapping of int to callable, optional
        Default: `UPGRADES`.
    version : int
        Version to reach.

    Returns
    -------
    Path or None
        The copy of the old file, ``<name>.v<version>.json`` with a number if that is taken; None
        if nothing had to be done.

    Raises
    ------
    FormatError
        If the file is malformed or of a newer version, or cannot be written.
    """
    path = Path(path)
    document = read_json(path, schema=SCHEMA, version=version, limit=_LIMIT)
    old = int(document["version"])
    if old == version:
        return None
    lifted = _lifted(document, UPGRADES if steps is None else steps, version)
    backup = _free_name(path, old)
    write_bytes(backup, path.read_bytes())
    text = json.dumps(lifted, indent=2, ensure_ascii=False, allow_nan=False)
    write_bytes(path, f"{text}\n".encode())
    return backup


def _lifted(document: Document, steps: Mapping[int, Upgrade], version: int) -> Document:
    while document["version"] < version:
        number = int(document["version"])
        document = {**steps[number](document), "version": number + 1}
    return document


def _free_name(path: Path, version: int) -> Path:
    name = path.with_name(f"{path.stem}.v{version}{path.suffix}")
    count = 1
    while name.exists():
        count += 1
        name = path.with_name(f"{path.stem}.v{version}-{count}{path.suffix}")
    return name


def _parse(document: Document, path: Path) -> Project:
    fields = Fields(document, str(path))
    known = ("schema", "version", "about", *_PATHS, *_TEXTS, *_OTHERS)
    unknown = [name for name in fields if name not in known]
    if unknown:
        raise FormatError(
            f"{path}: {', '.join(repr(name[:40]) for name in unknown[:3])} is no entry of a "
            f"project; known: {', '.join(known[3:])}"
        )
    if "head" not in fields:
        raise FormatError(f'{path}: "head" is missing; give a path or "{BUILTIN}"')
    head = fields.text("head")
    project = Project(head=None if head == BUILTIN else _absolute(head, path))
    flip = document.get("flip_landmarks", False)
    if not isinstance(flip, bool):
        raise FormatError(f"{fields.place('flip_landmarks')}: expected true or false")
    parts, poses = fields.fields("parts"), fields.fields("poses")
    parameters = fields.fields("parameters")
    try:
        return replace(
            project,
            landmarks=_path(fields, "landmarks", path),
            vector_set=_path(fields, "vector_set", path),
            presets=_path(fields, "presets", path),
            muscle_map=_path(fields, "muscle_map", path),
            recipe=_path(fields, "recipe", path),
            skull=_path(fields, "skull", path),
            mandible=_path(fields, "mandible", path),
            skull_landmarks=_path(fields, "skull_landmarks", path),
            unit=fields.text("unit") if "unit" in fields else None,
            axes=fields.text("axes") if "axes" in fields else None,
            method=fields.text("method", default=project.method),
            profile=fields.text("profile", default=project.profile),
            bones=fields.text("bones") if "bones" in fields else None,
            parts={kind: parts.text(kind) for kind in parts},
            parameters={name: _parameter(parameters, name) for name in parameters},
            flip_landmarks=flip,
            shapes=tuple(fields.texts("shapes")) if "shapes" in fields else SHAPE_SETS,
            inline={name: document[name] for name in INLINE if _is_inline(document, name)},
            poses={name: _pose(poses.fields(name)) for name in poses},
        )
    except ParameterError as error:
        raise FormatError(f"{path}: {error}") from None


def _parameter(fields: Fields, name: str) -> float | str:
    value = fields.value[name]
    return fields.text(name) if isinstance(value, str) else fields.number(name)


def _pose(fields: Fields) -> dict[str, float]:
    return {name: fields.number(name) for name in fields}


def _is_inline(document: Document, key: str) -> bool:
    return isinstance(document.get(key), dict)


def _path(fields: Fields, key: str, path: Path) -> Path | None:
    if key in INLINE and _is_inline(fields.value, key):
        return None
    return _absolute(fields.text(key), path) if key in fields else None


def _absolute(text: str, path: Path) -> Path:
    if not text or "\0" in text:
        raise FormatError(f"{path}: {text[:60]!r} is no path")
    return path.parent / text


def _relative(path: Path, folder: Path) -> str:
    """Return `path` as seen from `folder`, with forward slashes; absolute where no way leads."""
    try:
        return Path(os.path.relpath(os.path.realpath(path), folder)).as_posix()
    except ValueError:  # another drive
        return Path(os.path.realpath(path)).as_posix()
