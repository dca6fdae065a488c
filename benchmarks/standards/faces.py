"""Faces that are compared: every method on the built-in head and on a real one."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from risorius.anatomy.mechanics import Mechanics
from risorius.anatomy.template import builtin_head
from risorius.head import Head
from risorius.project import Project, face_of
from risorius.rig import Face

__all__ = ["faces"]


def faces(methods: tuple[str, ...], data: Path) -> Iterator[tuple[str, str, Face]]:
    """Yield head, method and face; the real head only where `data` has it."""
    heads = {"built-in": builtin_head()}
    ict = data / "ict_facekit"
    if ict.is_dir():
        heads["ICT"] = Head.load(ict / "ict_neutral.obj", ict / "landmarks.json")
    for name, head in heads.items():
        mechanics = Mechanics.build(head)
        for method in methods:
            yield name, method, face_of(Project(method=method), head, mechanics=mechanics)
