"""The muscle map: the recipe of a layered face, drawn on a skull and portable between heads."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, fields
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import Any

import numpy as np

from risorius._check import FloatArray, warn_of_strange_keys
from risorius.io.bounded import check_schema, read_json
from risorius.io.json_fields import Fields
from risorius.layered.layer_order import layer_order
from risorius.layered.muscle import Muscle, Ring, Sheet
from risorius.layered.muscle_entry import read_muscle

__all__ = [
    "MuscleMap",
    "default_muscle_map",
    "muscle_entry",
    "parse_muscle_map",
    "read_muscle_map",
]

SCHEMA = "risorius/muscle-map"
VERSION = 1
_KEYS = ("schema", "version", "about", "unit", "landmarks", "muscles")


@dataclass(frozen=True, eq=False)
class MuscleMap:
    """Muscles in layers and the landmarks of the skull that they were drawn on.

    Parameters
    ----------
    muscles : tuple of Muscle
        Deep before superficial (`risorius.layered.layer_order`).
    landmarks : mapping of str to (3,) float64
        Bone landmarks of that skull, in its space [mm].

    Raises
    ------
    ParameterError
        If names clash or muscles do not lie on deeper layers.
    """

    muscles: tuple[Muscle, ...]
    landmarks: Mapping[str, FloatArray]

    def __post_init__(self) -> None:
        object.__setattr__(self, "muscles", layer_order(self.muscles))

    @property
    def by_name(self) -> dict[str, Muscle]:
        """Muscles by their names."""
        return {muscle.name: muscle for muscle in self.muscles}

    @property
    def published(self) -> MuscleMap:
        """The map without the muscles that the thesis lacks."""
        kept = tuple(muscle for muscle in self.muscles if not muscle.extended)
        return MuscleMap(kept, self.landmarks)

    def to_json(self) -> dict[str, Any]:
        """Return the file's content."""
        return {
            "schema": SCHEMA,
            "version": VERSION,
            "unit": "mm",
            "landmarks": {
                name: np.round(place, 3).tolist() for name, place in self.landmarks.items()
            },
            "muscles": [muscle_entry(muscle) for muscle in self.muscles],
        }


def parse_muscle_map(data: Mapping[str, Any], *, source: str) -> MuscleMap:
    """Build the map from the parsed JSON of its file.

    Raises
    ------
    FormatError
        If schema, version or an entry is wrong; the message names `source` and the muscle.
    ParameterError
        If a number is out of range or the layers do not fit together.
    """
    document = dict(data)
    check_schema(document, source, schema=SCHEMA, version=VERSION)
    warn_of_strange_keys(source, document, _KEYS, kind="a muscle map")
    content = Fields(document, source)
    marks = content.fields("landmarks")
    landmarks = {name: np.array(marks.numbers(name, 3)) for name in marks}
    muscles = tuple(
        read_muscle(entry, f"{source}: muscle {number}")
        for number, entry in enumerate(content.items("muscles"))
    )
    return MuscleMap(muscles, landmarks)


def read_muscle_map(path: str | Path) -> MuscleMap:
    """Read a muscle map file.

    Raises
    ------
    FormatError, ParameterError
        As `parse_muscle_map`, or if the file is missing.
    """
    return parse_muscle_map(read_json(path, schema=SCHEMA, version=VERSION), source=str(path))


@cache
def default_muscle_map() -> MuscleMap:
    """Return the map that ships with risorius, drawn on the built-in skull."""
    text = files("risorius.layered").joinpath("data/muscle_map.json").read_text("utf-8")
    return parse_muscle_map(json.loads(text), source="muscle_map.json")


def muscle_entry(muscle: Muscle) -> dict[str, Any]:
    """Return a muscle as it stands in the file."""
    entry: dict[str, Any] = {
        "name": muscle.name,
        "kind": muscle.kind,
        "layer": muscle.layer,
        "mirror": muscle.mirror,
        "together": muscle.together,
        "active": muscle.active,
        "extended": muscle.extended,
        "on": list(muscle.on),
    }
    shape = muscle.shape
    if isinstance(shape, Sheet):
        entry |= {"line": shape.line.tolist(), "half_width": shape.half_width.tolist()}
        if shape.direction is not None:
            entry["direction"] = shape.direction.tolist()
    else:
        entry |= {
            "centre": shape.centre.tolist(),
            "inner": shape.inner.tolist(),
            "outer": shape.outer.tolist(),
        }
    entry |= {"thickness": muscle.thickness, "sections": list(muscle.sections)}
    if muscle.action is None:
        return entry
    action = {
        field.name: list(value) if isinstance(value, tuple) else value
        for field in fields(muscle.action)
        if (value := getattr(muscle.action, field.name)) is not None
    }
    entry["shortening"] = muscle.shortening
    if isinstance(shape, Ring):
        key = "mouth" if "lips" in action else "eye"
        return entry | {"stiffness": action.pop("stiffness"), key: action}
    return entry | action
