"""Decode the body of a PLY file into columns."""

from __future__ import annotations

import struct
import warnings
from array import array
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt

from risorius._check import FloatArray
from risorius.errors import FormatError

__all__ = ["Column", "Element", "read_elements"]

LongArray = npt.NDArray[np.int64]

_MOST_LISTS = 1 << 22  # rows with lists, that is polygons; they are walked one by one
_STRUCT = {
    "i1": "b", "u1": "B", "i2": "h", "u2": "H", "i4": "i", "u4": "I", "f4": "f", "f8": "d",
}  # fmt: skip


@dataclass(frozen=True)
class Element:
    """An element of the header: how many rows, and the type of each property in order.

    `list_sizes` has the type of the length for those properties that are lists.
    """

    name: str
    count: int
    types: dict[str, str]
    list_sizes: dict[str, str]


@dataclass(frozen=True, eq=False)
class Column:
    """A property of all rows.

    Parameters
    ----------
    values : (v,) array
        One number per row, or lists one after the other.
    sizes : (r,) int64
        Length of each list, empty where rows hold one number.
    """

    values: npt.NDArray[Any]
    sizes: LongArray = field(default_factory=lambda: np.zeros(0, np.int64))


def read_elements(
    body: memoryview, elements: list[Element], order: str, where: str
) -> dict[str, dict[str, Column]]:
    """Return the columns by element and property.

    Parameters
    ----------
    body : memoryview
        What follows the header.
    elements : list of Element
    order : str
        ``"<"`` or ``">"`` of binary files, empty for ASCII.
    where : str
        Opens every message.

    Raises
    ------
    FormatError
        If the body is shorter than the header says, or a list has no sensible length.
    """
    reader = _Binary(body, order) if order else _Ascii(_ascii_numbers(body, where))
    result: dict[str, dict[str, Column]] = {}
    for element in elements:
        least = sum(map(reader.width, [*element.types.values(), *element.list_sizes.values()]))
        if element.count * least > reader.end - reader.start:
            raise FormatError(
                f"{where}: the header claims {element.count} rows of {element.name[:40]!r}, more "
                "than follow; is the file cut off?"
            )
        if not element.count or not element.types:
            result[element.name] = {}
        elif not element.list_sizes:
            result[element.name] = reader.table(element)
        elif element.count <= _MOST_LISTS:
            result[element.name] = _walk(reader, element, where)
        else:
            raise FormatError(f"{where}: more than {_MOST_LISTS} rows of {element.name[:40]!r}")
    return result


class _Binary:
    """Cursor in bytes."""

    def __init__(self, body: memoryview, order: str) -> None:
        self._body, self._order = body, order
        self.start, self.end = 0, len(body)

    def width(self, kind: str) -> int:
        return int(kind[1:])

    def length(self, kind: str, start: int) -> float:
        return struct.unpack_from(self._order + _STRUCT[kind], self._body, start)[0]

    def table(self, element: Element) -> dict[str, Column]:
        dtype = np.dtype([(name, self._order + kind) for name, kind in element.types.items()])
        table = np.frombuffer(self._body, dtype, element.count, self.start)
        self.start += dtype.itemsize * element.count
        return {name: Column(table[name]) for name in element.types}

    def joined(self, kind: str, starts: LongArray, sizes: LongArray) -> npt.NDArray[Any]:
        width = self.width(kind)
        pieces = [
            self._body[start : start + size * width]
            for start, size in zip(starts.tolist(), sizes.tolist())
        ]
        return np.frombuffer(b"".join(pieces), self._order + kind)


class _Ascii:
    """Cursor in numbers."""

    def __init__(self, values: FloatArray) -> None:
        self._values = values
        self.start, self.end = 0, len(values)

    def width(self, kind: str) -> int:
        return 1

    def length(self, kind: str, start: int) -> float:
        return self._values[start]

    def table(self, element: Element) -> dict[str, Column]:
        stop = self.start + element.count * len(element.types)
        table = self._values[self.start : stop].reshape(-1, len(element.types))
        self.start = stop
        return {name: Column(table[:, i]) for i, name in enumerate(element.types)}

    def joined(self, kind: str, starts: LongArray, sizes: LongArray) -> npt.NDArray[Any]:
        inside = np.arange(sizes.sum()) - np.repeat(np.cumsum(sizes) - sizes, sizes)
        return self._values[np.repeat(starts, sizes) + inside]


def _ascii_numbers(body: memoryview, where: str) -> FloatArray:
    text = bytes(body)
    if not text.strip():
        return np.zeros(0)
    try:
        with warnings.catch_warnings():
            # What stops the parser half-way is a warning in some versions, an error in others.
            warnings.simplefilter("error", DeprecationWarning)
            return np.fromstring(text, sep=" ")
    except (ValueError, DeprecationWarning):
        raise FormatError(f"{where}: what follows the header must be numbers") from None


def _walk(reader: _Binary | _Ascii, element: Element, where: str) -> dict[str, Column]:
    """Read rows with lists, the lengths of which are known only when one stands before them."""
    starts = {name: array("q") for name in element.types}
    sizes = {name: array("q") for name in element.list_sizes}
    steps = [
        (name, reader.width(kind), element.list_sizes.get(name, ""))
        for name, kind in element.types.items()
    ]
    place = reader.start
    for row in range(element.count):
        for name, width, list_size in steps:
            count = 1
            if list_size:
                before = place
                place += reader.width(list_size)
                length = reader.length(list_size, before) if place <= reader.end else -1
                count = int(length) if 0 <= length <= reader.end else -1
                if count != length:
                    raise FormatError(f"{where}: row {row} of {element.name[:40]!r}: bad list")
                sizes[name].append(count)
            starts[name].append(place)
            place += count * width
            if place > reader.end:
                raise FormatError(f"{where}: row {row} of {element.name[:40]!r}: the file ends")
    reader.start = place
    columns: dict[str, Column] = {}
    for name, kind in element.types.items():
        begin = np.array(starts[name], np.int64)
        if name in sizes:
            own = np.array(sizes[name], np.int64)
            columns[name] = Column(reader.joined(kind, begin, own), own)
        else:
            columns[name] = Column(reader.joined(kind, begin, np.ones(len(begin), np.int64)))
    return columns
