"""The 52 ARKit blend shape names, in Apple's order."""

from __future__ import annotations

import csv
from dataclasses import dataclass
from functools import cache
from importlib.resources import files

__all__ = ["ArkitShape", "arkit_shapes"]


@dataclass(frozen=True)
class ArkitShape:
    """One ARKit shape: name exactly as Apple writes it, side, and its mirror shape."""

    name: str
    side: str
    mirror: str


@cache
def arkit_shapes() -> tuple[ArkitShape, ...]:
    """Return the 52 shapes in Apple's order."""
    text = files("risorius.controls").joinpath("data/arkit.csv").read_text("utf-8")
    return tuple(
        ArkitShape(row["name"], row["side"], row["mirror"])
        for row in csv.DictReader(text.splitlines())
    )
