"""Read and write outline recipes."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import Any, cast

from risorius._check import as_number
from risorius.errors import FormatError, ParameterError
from risorius.io.atomic import atomic_write
from risorius.io.bounded import check_schema, read_json
from risorius.io.json_fields import Fields, finite_number
from risorius.landmarks.feature_points import feature_points
from risorius.springmuscle.recipe import (
    MuscleOutline,
    OutlinePoint,
    OutlineRecipe,
    OutlineSettings,
    Ring,
)

__all__ = ["default_recipe", "parse_recipe", "read_recipe", "recipe_to_json", "write_recipe"]

SCHEMA = "risorius/outline-recipe"
VERSION = 1
_KINDS = ("linear", "sheet", "curved", "sphincter")
_MOST_CONTRACTION = 1.0
# Lengths beyond this are no lengths of a face [mm at the reference width].
_LONGEST = 50.0
_RING_DEFAULTS = {"ahead": 0.0, "turn": 0.0, "around_eye": False, "closed": True}


def parse_recipe(data: Mapping[str, Any], *, source: str) -> OutlineRecipe:
    """Build the recipe from the parsed JSON of its file.

    Raises
    ------
    FormatError
        If schema, version or a field is wrong; the message names `source` and the muscle.
    ParameterError
        If a number is out of range, or a muscle has too few rows or points.
    """
    document = dict(data)
    check_schema(document, source, schema=SCHEMA, version=VERSION)
    entries = Fields(document, source).items("muscles")
    if not entries:
        raise FormatError(f"{source}: muscles: expected a list with at least one muscle")
    return OutlineRecipe(
        tuple(_read_outline(entry, f"{source}: muscle {n}") for n, entry in enumerate(entries))
    )


def read_recipe(path: str | Path) -> OutlineRecipe:
    """Read a recipe file.

    Raises
    ------
    FormatError, ParameterError
        As `parse_recipe`, or if the file is missing.
    """
    return parse_recipe(read_json(path, schema=SCHEMA, version=VERSION), source=str(path))


def write_recipe(recipe: OutlineRecipe, path: str | Path) -> None:
    """Write a recipe file, one outline row per line."""
    with atomic_write(Path(path)) as temporary:
        temporary.write_text(recipe_text(recipe), "utf-8")


def recipe_text(recipe: OutlineRecipe) -> str:
    """Return the text of a recipe's file."""
    entries = ",\n".join(_text(outline) for outline in recipe.muscles)
    return f'{{\n "schema": "{SCHEMA}",\n "version": {VERSION},\n "muscles": [\n{entries}\n ]\n}}\n'


def recipe_to_json(recipe: OutlineRecipe) -> dict[str, Any]:
    """Return the JSON of a recipe, as it stands in files and inside projects."""
    return json.loads(recipe_text(recipe))


@cache
def default_recipe() -> OutlineRecipe:
    """Return the recipe that ships with risorius; it builds on every head."""
    text = files("risorius.springmuscle").joinpath("data/recipe.json").read_text("utf-8")
    return parse_recipe(json.loads(text), source="recipe.json")


def _read_outline(entry: object, where: str) -> MuscleOutline:
    name = Fields(entry, where).text("name")
    record = Fields(entry, f"{where} ({name})")
    kind = record.text("kind")
    if kind not in _KINDS:
        raise FormatError(f"{record.place('kind')}: {kind!r} is not one of {', '.join(_KINDS)}")
    rows = tuple(
        tuple(
            _read_point(point, f"{record.place('rows')}[{r}][{p}]") for p, point in enumerate(row)
        )
        for r, row in enumerate(_lists(record, "rows"))
    )
    try:
        return MuscleOutline(
            name,
            kind,
            rows,
            mirror=_flag(record, "mirror", True),
            control=record.text("control", default=""),
            ring=_read_ring(record) if kind == "sphincter" else None,
            settings=_read_settings(record),
        )
    except ParameterError as error:
        raise ParameterError(f"{where}: {error}") from None


def _lists(record: Fields, key: str) -> list[list[Any]]:
    rows = record.items(key)
    for number, row in enumerate(rows):
        if not isinstance(row, list):
            raise FormatError(f"{record.place(key)}[{number}]: expected a list of points")
    return cast("list[list[Any]]", rows)


def _read_point(value: object, where: str) -> OutlinePoint:
    """Return the point written as ``["2.4*3+2.2", x, y, z]``; weights and offset may be absent."""
    parts = cast("list[object]", value) if isinstance(value, list) else []
    if len(parts) not in (1, 4) or not isinstance(parts[0], str):
        raise FormatError(f'{where}: expected ["landmark+landmark", x, y, z]')
    terms = [term.strip().partition("*") for term in parts[0].split("+")]
    unknown = [name for name, _, _ in terms if name not in feature_points()]
    if unknown:
        raise FormatError(f"{where}: {', '.join(unknown)} is no landmark")
    weights = tuple(
        as_number(where, number, low=1e-6, high=1e6) if number else 1.0 for _, _, number in terms
    )
    offset = [finite_number(number, where) for number in parts[1:]] or [0.0, 0.0, 0.0]
    return OutlinePoint(
        tuple(name for name, _, _ in terms),
        (offset[0], offset[1], offset[2]),
        () if len(set(weights)) == 1 else weights,
    )


def _read_ring(record: Fields) -> Ring:
    if "centre" not in record:
        raise FormatError(f"{record.place('centre')}: is missing; a sphincter needs one")
    line = tuple(
        _read_point(point, f"{record.place('line')}[{n}]")
        for n, point in enumerate(record.items("line"))
    )
    if len(line) not in (0, 2):
        raise FormatError(f"{record.place('line')}: expected the left and the right end")
    shares = record.items("shares")
    return Ring(
        centre=_read_point(record.value["centre"], record.place("centre")),
        ahead=_number(record, "ahead", 0.0, -_LONGEST, _LONGEST),
        line=line,
        turn=_number(record, "turn", 0.0, -90.0, 90.0),
        around_eye=_flag(record, "around_eye", False),
        closed=_flag(record, "closed", True),
        shares=tuple(
            as_number(record.place("shares"), value, low=0.0, high=1.0) for value in shares
        ),
    )


def _read_settings(record: Fields) -> OutlineSettings:
    thickness = None
    if "thickness" in record:
        least, most = record.numbers("thickness", 2)
        if not 0.0 < least <= most <= _LONGEST:
            raise ParameterError(
                f"{record.place('thickness')}: [{least:g}, {most:g}] must be least and most, above "
                f"0 and at most {_LONGEST:g}"
            )
        thickness = (least, most)
    radius = _number(record, "radius", 0.0, 0.0, _LONGEST)
    return OutlineSettings(
        skin=_read_skin(record),
        thickness=thickness,
        radius=radius or None,
        max_contraction=_number(record, "max_contraction", 1.0, 0.0, _MOST_CONTRACTION),
        stiffness=_number(record, "stiffness", 1.0, 0.0, 1000.0),
        fixed_point=_number(record, "fixed_point", 0.0, 0.0, 1.0),
        bulge=_number(record, "bulge", 2.0, 0.0, 20.0),
        seal=_flag(record, "seal", False),
        host=_flag(record, "host", True),
    )


def _read_skin(record: Fields) -> float | dict[str, float] | None:
    value = record.value.get("skin")
    if value is None:
        return None
    if not isinstance(value, dict):
        return _number(record, "skin", 0.0, 0.0, _LONGEST)
    entries = record.fields("skin")
    unknown = [name for name in entries if name not in feature_points()]
    if unknown or not list(entries):
        raise FormatError(
            f"{record.place('skin')}: expected a thickness or a map of landmarks to thickness"
            + (f"; {', '.join(unknown)} is no landmark" if unknown else "")
        )
    return {name: _number(entries, name, 0.0, 0.0, _LONGEST) for name in entries}


def _number(record: Fields, key: str, default: float, low: float, high: float) -> float:
    return as_number(record.place(key), record.number(key, default=default), low=low, high=high)


def _flag(record: Fields, key: str, default: bool) -> bool:
    value = record.value.get(key, default)
    if not isinstance(value, bool):
        raise FormatError(f"{record.place(key)}: expected true or false")
    return value


def _text(outline: MuscleOutline) -> str:
    head: dict[str, Any] = {"name": outline.name, "kind": outline.kind, "mirror": outline.mirror}
    if outline.control:
        head["control"] = outline.control
    ring, settings = outline.ring, outline.settings
    if ring is not None:
        head |= {
            "centre": _point(ring.centre),
            "ahead": ring.ahead,
            "line": [_point(point) for point in ring.line],
            "turn": ring.turn,
            "around_eye": ring.around_eye,
            "closed": ring.closed,
            "shares": list(ring.shares),
        }
    head |= {
        "skin": settings.skin,
        "thickness": list(settings.thickness) if settings.thickness else None,
        "radius": settings.radius,
        "max_contraction": settings.max_contraction,
        "stiffness": settings.stiffness,
        "fixed_point": settings.fixed_point,
        "bulge": settings.bulge,
        "seal": settings.seal,
        "host": settings.host,
    }
    defaults = {**asdict(OutlineSettings()), **_RING_DEFAULTS}
    plain = {
        key: value
        for key, value in head.items()
        if value not in (None, [], {}) and not (key in defaults and defaults[key] == value)
    }
    lines = [f'   "{key}": {json.dumps(value, allow_nan=False)}' for key, value in plain.items()]
    rows = ",\n".join(
        f"    {json.dumps([_point(point) for point in row], allow_nan=False)}"
        for row in outline.rows
    )
    return "  {\n" + ",\n".join([*lines, f'   "rows": [\n{rows}\n   ]']) + "\n  }"


def _point(point: OutlinePoint) -> list[Any]:
    names = list(point.anchors)
    if point.weights:
        names = [f"{name}*{weight:g}" for name, weight in zip(names, point.weights)]
    return ["+".join(names), *(round(value, 4) for value in point.offset)]
