"""The file of a presets book with some of its emotions changed."""

from __future__ import annotations

from collections.abc import Mapping
from importlib.resources import files
from pathlib import Path
from typing import Any

from risorius.controls.control import Pose
from risorius.io.bounded import parse_json, read_json
from risorius.project.project import Project

__all__ = ["presets_document", "presets_document_of", "with_emotions"]


def presets_document(path: Path | None) -> dict[str, Any]:
    """Return the JSON of a presets file, or of the presets that ship with risorius.

    Raises
    ------
    FormatError
        If the file is missing or malformed.
    """
    if path is not None:
        return read_json(path, schema="risorius/presets")
    text = files("risorius.controls").joinpath("data/presets.json").read_bytes()
    return parse_json(text, "presets.json")


def presets_document_of(project: Project) -> dict[str, Any]:
    """Return the JSON of a project's presets.

    Raises
    ------
    FormatError
        If a file is missing or malformed.
    """
    inline = project.inline.get("presets")
    return presets_document(project.presets) if inline is None else dict(inline)


def with_emotions(document: Mapping[str, Any], emotions: Mapping[str, Pose]) -> dict[str, Any]:
    """Return the document with some emotions replaced or added, as people write presets."""
    short = {name: _short(pose) for name, pose in emotions.items()}
    return {**document, "emotions": {**document.get("emotions", {}), **short}}


def _short(pose: Pose) -> dict[str, float]:
    """Return the pose with equal sides under one name."""
    result: dict[str, float] = {}
    for name, value in pose.items():
        base, side = (name[:-2], name[-2:]) if name.endswith(("_l", "_r")) else (name, "")
        other = f"{base}{'_r' if side == '_l' else '_l'}"
        paired = bool(side) and pose.get(other) == value
        result[base if paired else name] = round(value, 4)
    return result
