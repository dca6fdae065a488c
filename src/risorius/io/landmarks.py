"""Landmark files: JSON with MPEG-4 names, our own schema and plain vertex lists."""

from __future__ import annotations

import json
import warnings
from collections.abc import Mapping
from pathlib import Path
from typing import Any, cast

from risorius._formats import Format, register
from risorius.errors import FormatError, RisoriusWarning
from risorius.io.atomic import write_bytes
from risorius.io.bounded import MEGABYTE, check_schema, read_json
from risorius.io.json_fields import Fields
from risorius.landmarks.feature_points import feature_points
from risorius.landmarks.landmark_set import LandmarkSpec

__all__ = ["landmarks_from_json", "landmarks_to_json", "read_landmarks", "write_landmarks"]

SCHEMA = "risorius/landmarks"
VERSION = 1
_LIMIT = 16 * MEGABYTE


def read_landmarks(path: str | Path) -> dict[str, LandmarkSpec]:
    """Read landmarks by name from JSON.

    Understood are our own schema, ``{"schema": "risorius/landmarks", "version": 1, "landmarks":
    {name: place}}``, and lists without a schema, ``{"fdp": {name: place}, "index_base": 0}``.
    A place has ``"vertex"``, or ``"face"`` and ``"bary"``, or ``"position"`` (also ``"pos"``) in
    the unit of the mesh, and maybe ``"confidence"``; a vertex is preferred to a position.

    Raises
    ------
    FormatError
        If the file is malformed; the landmark is named.

    Warns
    -----
    RisoriusWarning
        If names are not MPEG-4 feature points; they are kept.
    """
    where = str(path)
    document = read_json(path, limit=_LIMIT)
    if "schema" in document:
        check_schema(document, where, schema=SCHEMA, version=VERSION)
    table = document.get("landmarks", document.get("fdp"))
    if not isinstance(table, dict):
        raise FormatError(
            f'{where}: expected "landmarks": {{name: {{"vertex": 0}}}}, found '
            f"{', '.join(list(document)[:5]) or 'nothing'}"
        )
    base = document.get("index_base", 0)
    if isinstance(base, bool) or base not in (0, 1):
        raise FormatError(f'{where}: "index_base" must be 0 or 1')
    specs = landmarks_from_json(cast("dict[str, Any]", table), where, index_base=int(base))
    unknown = [name for name in specs if name not in feature_points()]
    if unknown:
        shown = ", ".join(repr(name[:40]) for name in unknown[:5])
        more = f" and {len(unknown) - 5} more" if len(unknown) > 5 else ""
        warnings.warn(
            f"{where}: {shown}{more} are not MPEG-4 feature points; kept, but nothing uses them",
            RisoriusWarning,
            stacklevel=2,
        )
    return specs


def landmarks_from_json(
    table: Mapping[str, Any], where: str, *, index_base: int = 0
) -> dict[str, LandmarkSpec]:
    """Return the landmarks of a parsed ``{name: place}``; `where` opens every message."""
    if not table:
        raise FormatError(f"{where}: there are no landmarks in it")
    return {
        name: _spec(place, f"{where}: landmark {name[:40]!r}", index_base)
        for name, place in table.items()
    }


def landmarks_to_json(specs: Mapping[str, LandmarkSpec]) -> dict[str, dict[str, Any]]:
    """Return ``{name: place}`` as it stands in a file."""
    table: dict[str, dict[str, Any]] = {}
    for name, spec in specs.items():
        place: dict[str, Any] = {}
        if spec.vertex is not None:
            place["vertex"] = int(spec.vertex)
        elif spec.face is not None and spec.bary is not None:
            place["face"] = int(spec.face)
            place["bary"] = [float(weight) for weight in spec.bary]
        elif spec.position is not None:
            place["position"] = [float(x) for x in spec.position]
        if spec.confidence:
            place["confidence"] = spec.confidence
        table[name] = place
    return table


def write_landmarks(specs: Mapping[str, LandmarkSpec], path: str | Path) -> None:
    """Write landmarks in our own schema.

    Raises
    ------
    FormatError
        If the file cannot be written.
    """
    head = json.dumps({"schema": SCHEMA, "version": VERSION})[:-1]
    rows = [
        f"  {json.dumps(name, ensure_ascii=False)}: {json.dumps(place, ensure_ascii=False)}"
        for name, place in landmarks_to_json(specs).items()
    ]
    text = f'{head}, "landmarks": {{\n' + ",\n".join(rows) + "\n}}\n"
    write_bytes(path, text.encode())


def _spec(place: Any, where: str, index_base: int) -> LandmarkSpec:
    entry = Fields(place, where)
    confidence = entry.text("confidence", default="")
    if "vertex" in entry:
        vertex = entry.integer("vertex", low=index_base) - index_base
        return LandmarkSpec(vertex=vertex, confidence=confidence)
    if "face" in entry:
        face = entry.integer("face", low=index_base) - index_base
        a, b, c = entry.numbers("bary", 3)
        if abs(a + b + c - 1.0) > 1e-6 or min(a, b, c) < -1e-6:
            raise FormatError(f"{where}: bary: three weights from 0 must sum to 1")
        return LandmarkSpec(face=face, bary=(a, b, c), confidence=confidence)
    key = "position" if "position" in entry else "pos"
    if key not in entry:
        raise FormatError(f'{where}: has no "vertex", "face" with "bary", or "position"')
    x, y, z = entry.numbers(key, 3)
    return LandmarkSpec(position=(x, y, z), confidence=confidence)


register(Format("landmarks", (".json",), read_landmarks=read_landmarks))
