"""The polygon lines of an OBJ file: ``f v``, ``f v/t``, ``f v//n``, ``f v/t/n``."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import chain

import numpy as np
import numpy.typing as npt

from risorius.errors import FormatError

__all__ = ["NO_UV", "OUT_OF_RANGE", "Corners", "LongArray", "read_corners"]

LongArray = npt.NDArray[np.int64]

NO_UV = -1
OUT_OF_RANGE = -2
_ABSENT = 0  # what an index that is not given is in a file, where counting starts at 1
_LARGEST = 2**31 - 1


@dataclass(frozen=True, eq=False)
class Corners:
    """Corners of consecutive polygons.

    Parameters
    ----------
    vertices, uvs : (c,) int64
        Indices as in the file (from 1, negative backwards), or absolute from 0.
    sizes : (m,) int64
        Corners per polygon.
    lines : (m,) int64
        Line of each polygon in the file.
    """

    vertices: LongArray
    uvs: LongArray
    sizes: LongArray
    lines: LongArray

    @staticmethod
    def concatenated(blocks: Sequence[Corners]) -> Corners:
        """Join blocks in order."""
        none = np.zeros(0, np.int64)
        return Corners(
            np.concatenate([none, *(block.vertices for block in blocks)]),
            np.concatenate([none, *(block.uvs for block in blocks)]),
            np.concatenate([none, *(block.sizes for block in blocks)]),
            np.concatenate([none, *(block.lines for block in blocks)]),
        )

    def absolute(self, *, vertex_count: int, uv_count: int) -> Corners:
        """Count from 0; negative indices count back from what has been read so far."""
        uvs = np.where(self.uvs == _ABSENT, NO_UV, _from_zero(self.uvs, uv_count))
        return Corners(_from_zero(self.vertices, vertex_count), uvs, self.sizes, self.lines)

    def line_of_corner(self, corner: int) -> int:
        """Return the line that `corner` stands in."""
        return int(self.lines[np.searchsorted(np.cumsum(self.sizes), corner, side="right")])


def _from_zero(index: LongArray, count: int) -> LongArray:
    absolute = np.where(index > 0, index - 1, index + count)
    return np.where(absolute < 0, OUT_OF_RANGE, absolute)


def read_corners(block: list[bytes], line: int, where: str) -> Corners:
    """Parse consecutive ``f`` lines, the first of which is `line` of the file.

    Raises
    ------
    FormatError
        On a line without corners, an index that is no whole number, or an index 0.
    """
    rows = [row.partition(b"#")[0].split()[1:] for row in block]
    sizes = np.fromiter(map(len, rows), np.int64, len(rows))
    if not sizes.all():
        bad = int(np.argmin(sizes))
        raise FormatError(f"{where}: line {line + bad}: a polygon ('f') without corners")
    tokens = list(chain.from_iterable(rows))
    try:
        vertices, uvs = _parse_alike(tokens) or _parse_each(tokens)
        good = (vertices != 0).all() and max(abs(vertices).max(), abs(uvs).max()) <= _LARGEST
    except (ValueError, OverflowError):
        good, vertices, uvs = False, sizes, sizes
    if not good:
        bad = next(i for i, row in enumerate(rows) if not all(map(_is_corner, row)))
        shown = repr(block[bad][:40].decode("ascii", errors="replace"))
        raise FormatError(
            f"{where}: line {line + bad}: {shown} must hold corners like 3, 3/5, 3//7 or 3/5/7 "
            "that count from 1"
        )
    return Corners(vertices, uvs, sizes, np.arange(line, line + len(rows)))


def _parse_alike(tokens: list[bytes]) -> tuple[LongArray, LongArray] | None:
    """Parse all corners at once if they have the same form, else return None."""
    text = b" ".join(tokens)
    slashes = {token.count(b"/") for token in tokens}
    doubles = text.count(b"//")
    if len(slashes) > 1 or b"_" in text or (doubles and doubles != len(tokens)):
        return None
    columns = slashes.pop() + 1 - (doubles > 0)
    values = list(map(int, text.replace(b"/", b" ").split()))
    if len(values) != columns * len(tokens) or columns > 3 or (doubles and columns != 2):
        return None
    table = np.array(values, np.int64).reshape(-1, columns)
    none = np.zeros(len(table), np.int64)
    with_uvs = columns > 1 and not doubles
    if with_uvs and not table[:, 1].all():
        raise ValueError  # an explicit 0; an index that is not given is no 0 in the file
    return table[:, 0], table[:, 1] if with_uvs else none


def _parse_each(tokens: list[bytes]) -> tuple[LongArray, LongArray]:
    pairs = [_corner(token) for token in tokens]
    table = np.array(pairs, np.int64).reshape(-1, 2)
    return table[:, 0], table[:, 1]


def _corner(token: bytes) -> tuple[int, int]:
    vertex, *others = token.split(b"/")
    if len(others) > 2 or b"_" in token:
        raise ValueError
    given = [int(text) for text in others if text]
    if any(number == 0 or abs(number) > _LARGEST for number in given):
        raise ValueError
    index = int(vertex)
    if index == 0 or abs(index) > _LARGEST:
        raise ValueError
    return index, int(others[0]) if others and others[0] else _ABSENT


def _is_corner(token: bytes) -> bool:
    try:
        _corner(token)
    except ValueError:
        return False
    return True
