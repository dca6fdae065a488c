"""The vector set: the recipe of a vector-muscle face, portable between heads."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from typing import Any, cast

import numpy as np

from risorius._check import FloatArray, warn_of_strange_keys
from risorius.anatomy.template import warp_between
from risorius.errors import FormatError
from risorius.head.head import Head
from risorius.io.bounded import check_schema
from risorius.vectormuscle import kinds as _kinds  # registers the muscle kinds
from risorius.vectormuscle.muscle import KINDS, VectorMuscle, read_vector

__all__ = ["VectorSet", "default_vector_set", "parse_vector_set"]

SCHEMA = "risorius/vector-set"
VERSION = 1
_KEYS = frozenset(("schema", "version", "about", "unit", "landmarks", "muscles"))

assert _kinds.__all__


@dataclass(frozen=True, eq=False)
class VectorSet:
    """Muscles and the landmarks of the head that they were drawn on.

    Parameters
    ----------
    muscles : tuple of VectorMuscle
        Names are unique; left and right are separate.
    landmarks : mapping of str to (3,) float64
        The other head's landmarks; they carry the set to any head [mm, canonical frame].
    """

    muscles: tuple[VectorMuscle, ...]
    landmarks: Mapping[str, FloatArray]

    def fitted(self, head: Head) -> VectorSet:
        """Return the set carried to `head` by the landmarks that both have.

        Raises
        ------
        LandmarkError
            If fewer than eight landmarks are common.
        """
        warp = warp_between(dict(self.landmarks), head.landmarks)
        marks = {name: head.landmarks.position(name) for name in head.landmarks}
        return VectorSet(tuple(muscle.fitted(warp) for muscle in self.muscles), marks)

    def replaced(self, muscles: Iterable[VectorMuscle]) -> VectorSet:
        """Return the set with some muscles replaced, each by one of the same name."""
        changed = {muscle.name: muscle for muscle in muscles}
        kept = tuple(changed.get(muscle.name, muscle) for muscle in self.muscles)
        return VectorSet(kept, self.landmarks)

    def to_json(self) -> dict[str, Any]:
        """Return the file's content; every muscle is written with its side."""
        return {
            "schema": SCHEMA,
            "version": VERSION,
            "unit": "mm",
            "landmarks": {
                name: np.round(place, 3).tolist() for name, place in self.landmarks.items()
            },
            "muscles": [muscle.to_json() for muscle in self.muscles],
        }


def parse_vector_set(data: Mapping[str, Any], *, source: str) -> VectorSet:
    """Build the set from the parsed JSON of its file.

    An entry with ``"mirror": true`` names a left muscle without side and makes both.

    Raises
    ------
    FormatError
        If schema, version, kind or a name is wrong; the message names `source` and the muscle.
    ParameterError
        If a number of a muscle is out of range.
    """
    check_schema(data, source, schema=SCHEMA, version=VERSION)
    warn_of_strange_keys(source, data, _KEYS, kind="a vector set")
    marks, entries = data.get("landmarks"), data.get("muscles")
    if not isinstance(marks, dict) or not isinstance(entries, list):
        raise FormatError(f"{source}: needs 'landmarks' (object) and 'muscles' (list)")
    landmarks = {
        name: read_vector(marks, name, f"{source}: landmarks")
        for name in cast(dict[str, Any], marks)
    }
    muscles: list[VectorMuscle] = []
    for number, entry in enumerate(cast(list[Any], entries)):
        muscles.extend(_read_entry(entry, f"{source}: muscle {number}"))
    names = [muscle.name for muscle in muscles]
    twice = sorted({name for name in names if names.count(name) > 1})
    if twice:
        raise FormatError(f"{source}: {', '.join(twice)} is listed twice")
    return VectorSet(tuple(muscles), landmarks)


def _read_entry(entry: Any, where: str) -> list[VectorMuscle]:
    if not isinstance(entry, dict) or not isinstance(cast(dict[str, Any], entry).get("name"), str):
        raise FormatError(f"{where}: must be an object with a 'name'")
    record = cast(dict[str, Any], entry)
    where = f"{where} ({record['name']})"
    kind = record.get("kind")
    if kind not in KINDS:
        raise FormatError(f"{where}: kind {kind!r} is not one of {', '.join(sorted(KINDS))}")
    if not record.get("mirror", False):
        return [KINDS[kind](record, where)]
    left = KINDS[kind]({**record, "name": f"{record['name']}_l"}, where)
    return [left, left.mirrored()]


@cache
def default_vector_set() -> VectorSet:
    """Return the set that ships with risorius, drawn on the built-in head."""
    text = files("risorius.vectormuscle").joinpath("data/vector_set.json").read_text("utf-8")
    return parse_vector_set(json.loads(text), source="vector_set.json")
