"""The landmark names: MPEG-4 feature points (ISO/IEC 14496-2) and a few of our own.

`feature_points.csv` beside this file is the table; sides are the character's.
"""

from __future__ import annotations

import csv
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from types import MappingProxyType
from typing import Literal, cast

__all__ = ["FeaturePoint", "Side", "feature_points", "mirror_name"]

Side = Literal["left", "right", "centre"]


@dataclass(frozen=True)
class FeaturePoint:
    """One named point of the face.

    `part` says what it lies on: skin, an eye, the tongue, teeth, inside the head or the hair.
    """

    name: str
    side: Side
    mirror: str
    part: str
    description: str


@cache
def feature_points() -> MappingProxyType[str, FeaturePoint]:
    """Return all known feature points by name, in the order of the standard."""
    text = files("risorius.landmarks").joinpath("feature_points.csv").read_text("utf-8")
    table = {
        row["name"]: FeaturePoint(
            row["name"], cast(Side, row["side"]), row["mirror"], row["part"], row["description"]
        )
        for row in csv.DictReader(text.splitlines())
    }
    return MappingProxyType(table)


def mirror_name(name: str) -> str:
    """Return the name of the same point on the other side (itself on the midline)."""
    point = feature_points().get(name)
    return point.mirror if point else name
