"""The 52 ARKit blend shape names, in Apple's order."""

from __future__ import annotations

import csv
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from types import MappingProxyType

__all__ = ["MADE_UPON", "ArkitShape", "arkit_shapes"]

MADE_UPON: Mapping[str, str] = MappingProxyType({"mouthClose": "jawOpen"})
"""Shapes that only mean something on top of another: closed lips on an open jaw.

Their target is what they change there, so that both weights together give the simulated pose.
"""


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
