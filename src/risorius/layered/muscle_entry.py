"""One entry of a muscle map file, checked."""

from __future__ import annotations

from typing import cast

import numpy as np

from risorius._check import as_number, one_of
from risorius.errors import FormatError, ParameterError
from risorius.io.json_fields import Fields, finite_number
from risorius.layered.muscle import (
    EyeAction,
    Lip,
    MouthAction,
    Muscle,
    Ring,
    Sheet,
    SheetAction,
)

__all__ = ["read_muscle"]

_MOST_SHORTENING = 0.95
_NUMBERS = (
    "fixed_point", "stiffness", "reach", "tangential", "arch", "corner", "push", "bulge",
    "sideways", "slide",
)  # fmt: skip
_SHARES = ("tangential", "arch", "corner", "fixed_point", "slide")


def read_muscle(entry: object, where: str) -> Muscle:
    """Return the muscle of one JSON entry; `where` opens every message.

    Raises
    ------
    FormatError
        If a field is missing or of a wrong type.
    ParameterError
        If a number is out of range.
    """
    record = Fields(entry, where)
    name = record.text("name")
    where = f"{where} ({name})"
    record = Fields(entry, where)
    kind = record.text("kind")
    if kind not in ("sheet", "sphincter"):
        raise FormatError(f"{where}: kind {kind!r} is not one of sheet, sphincter")
    active = _flag(record, "active", True)
    shape = _sheet(record) if kind == "sheet" else _ring(record)
    action = None
    if active:
        action = _sheet_action(record) if kind == "sheet" else _ring_action(record)
    across, along = record.numbers("sections", 2)
    return Muscle(
        name=name,
        layer=record.integer("layer", low=1),
        shape=shape,
        action=action,
        on=tuple(record.texts("on")),
        thickness=as_number(record.place("thickness"), record.number("thickness"), low=0.0),
        sections=(_section(across, where), _section(along, where)),
        shortening=as_number(
            record.place("shortening"),
            record.number("shortening", default=0.0),
            low=0.0,
            high=_MOST_SHORTENING,
        ),
        active=active,
        mirror=_flag(record, "mirror", True),
        together=_flag(record, "together", False),
        extended=_flag(record, "extended", False),
    )


def _flag(record: Fields, key: str, default: bool) -> bool:
    value = record.value.get(key, default)
    if not isinstance(value, bool):
        raise FormatError(f"{record.place(key)}: expected true or false")
    return value


def _section(value: float, where: str) -> int:
    if value != int(value) or not 2 <= value <= 200:
        raise ParameterError(f"{where}: sections are whole numbers from 2 to 200, got {value:g}")
    return int(value)


def _sheet(record: Fields) -> Sheet:
    rows = record.items("line")
    line = [
        [finite_number(v, f"{record.place('line')}[{i}]") for v in cast("list[object]", row)]
        if isinstance(row, list)
        else []
        for i, row in enumerate(rows)
    ]
    if len(line) < 2 or any(len(row) != 3 for row in line):
        raise FormatError(f"{record.place('line')}: expected two or more points of three numbers")
    points = np.array(line)
    if (np.linalg.norm(np.diff(points, axis=0), axis=1) == 0.0).any():
        raise ParameterError(
            f"{record.place('line')}: two consecutive points are equal; a line needs distinct ones"
        )
    width = np.array(record.numbers("half_width", len(line)))
    if (width <= 0.0).any():
        raise ParameterError(f"{record.place('half_width')}: must be above 0 everywhere")
    direction = np.array(record.numbers("direction", 3)) if "direction" in record else None
    if direction is not None and not direction.any():
        raise ParameterError(f"{record.place('direction')}: must not be zero")
    return Sheet(points, width, direction)


def _ring(record: Fields) -> Ring:
    inner, outer = np.array(record.numbers("inner", 2)), np.array(record.numbers("outer", 2))
    if (inner <= 0.0).any() or (outer <= inner).any():
        raise ParameterError(
            f"{record.place('inner')}: half axes must be above 0 and below those of 'outer'"
        )
    return Ring(np.array(record.numbers("centre", 3)), inner, outer)


def _lip(word: str, where: str) -> Lip:
    one_of(where, word, ("upper", "lower"))
    return "upper" if word == "upper" else "lower"


def _sheet_action(record: Fields) -> SheetAction:
    plain = SheetAction()
    numbers = {key: record.number(key, default=getattr(plain, key)) for key in _NUMBERS}
    for key in _SHARES:
        as_number(record.place(key), numbers[key], low=0.0, high=1.0)
    for key in ("stiffness", "reach"):
        if numbers[key] <= 0.0:
            raise ParameterError(f"{record.place(key)}: must be above 0, got {numbers[key]:g}")
    lip = _lip(record.text("lip"), record.place("lip")) if "lip" in record else None
    return SheetAction(**numbers, seal=_flag(record, "seal", False), lip=lip)


def _ring_action(record: Fields) -> MouthAction | EyeAction:
    stiffness = record.number("stiffness", default=1.0)
    if "mouth" in record:
        part = record.fields("mouth")
        plain = MouthAction(())
        lips: tuple[Lip, ...] = tuple(_lip(word, part.place("lips")) for word in part.texts("lips"))
        if not lips:
            raise FormatError(f"{part.place('lips')}: name upper, lower or both")
        keys = ("narrow", "forward", "squeeze", "turn")
        numbers = {key: part.number(key, default=getattr(plain, key)) for key in keys}
        full, none = part.numbers("window", 2)
        if not 0.0 <= full < none:
            raise ParameterError(f"{part.place('window')}: must be two rising distances")
        return MouthAction(lips, **numbers, window=(full, none), stiffness=stiffness)
    if "eye" not in record:
        raise FormatError(f"{record.where}: an active sphincter needs a block 'mouth' or 'eye'")
    part = record.fields("eye")
    a, b, c, d = part.numbers("window", 4)
    if not 0.0 <= a < b <= c < d:
        raise ParameterError(f"{part.place('window')}: must be four rising radii")
    pairs = {key: part.numbers(key, 2) for key in ("centre", "axes", "sector", "pull")}
    if min(pairs["axes"]) <= 0.0 or pairs["sector"][1] <= 0.0:
        raise ParameterError(f"{part.where}: axes and half opening must be above 0")
    return EyeAction(
        centre=(pairs["centre"][0], pairs["centre"][1]),
        axes=(pairs["axes"][0], pairs["axes"][1]),
        window=(a, b, c, d),
        sector=(pairs["sector"][0], pairs["sector"][1]),
        pull=(pairs["pull"][0], pairs["pull"][1]),
        stiffness=stiffness,
    )
