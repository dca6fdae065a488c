"""Read Wavefront OBJ files: polygons, texture coordinates, names and order as they stand.

An own reader, because libraries triangulate, drop groups or split vertices at UV seams.
"""

from __future__ import annotations

import re
import warnings
from collections import Counter
from collections.abc import Callable, Iterator
from itertools import chain, groupby
from pathlib import Path

import numpy as np

from risorius._check import FloatArray
from risorius._formats import Format, register
from risorius.errors import FormatError, RisoriusWarning
from risorius.io.bounded import MEGABYTE, read_bytes_limited
from risorius.io.finite import LARGEST, first_bad_row
from risorius.io.obj_corners import NO_UV, OUT_OF_RANGE, Corners, LongArray, read_corners
from risorius.landmarks.landmark_set import LandmarkSpec
from risorius.mesh.polygon_mesh import Labels, PolygonMesh

__all__ = ["parse_obj", "read_obj", "read_obj_positions"]

_LIMIT = 256 * MEGABYTE
_BLOCK = 1 << 16  # lines parsed at a time, so that hostile files cannot fill the memory
_CONTINUED = re.compile(rb"(?:[^\n]*\\\n)+[^\n]*")

# Statements that carry nothing a head needs, and those whose loss deserves a note.
_SILENT = (
    b"vn s mtllib maplib usemap shadow_obj trace_obj bevel c_interp d_interp lod mg "
    b"ctech stech csh call"
).split()
_NOTED = (
    b"l p vp curv curv2 surf parm trim hole scrv sp end con cstype deg bmat step cdc cdp bzp res"
).split()


def read_obj(path: str | Path) -> tuple[PolygonMesh, dict[str, LandmarkSpec]]:
    """Read an OBJ file; the second value, its landmarks, is always empty.

    Raises
    ------
    FormatError
        On a malformed file; path, line and expectation are named.

    Warns
    -----
    RisoriusWarning
        If the file holds lines, points or free-form curves, which are left out.
    """
    return parse_obj(read_bytes_limited(path, limit=_LIMIT), str(path)), {}


def read_obj_positions(path: str | Path) -> FloatArray:
    """Read the vertices (n, 3) of an OBJ file and nothing else.

    Raises
    ------
    FormatError
        If a vertex line is malformed.
    """
    reader = _Reader(str(path))
    data = read_bytes_limited(path, limit=_LIMIT)
    for keyword, block, line in _blocks(data, str(path)):
        if keyword == b"v":
            reader.read(keyword, block, line)
    return reader.positions()


def parse_obj(data: bytes, where: str) -> PolygonMesh:
    """Return the mesh in the text `data`; `where` opens every message."""
    reader = _Reader(where)
    for keyword, block, line in _blocks(data, where):
        reader.read(keyword, block, line)
    return reader.mesh()


def _blocks(data: bytes, where: str) -> Iterator[tuple[bytes, list[bytes], int]]:
    """Yield keyword, consecutive lines that begin with it, and the number of the first."""
    number = 1
    for keyword, run in groupby(_lines(data, where), key=_keyword):
        block = list(run)
        for start in range(0, len(block), _BLOCK):
            yield keyword, block[start : start + _BLOCK], number + start
        number += len(block)


def _lines(data: bytes, where: str) -> list[bytes]:
    """Return stripped lines; a continued line is joined and followed by empty ones."""
    data = data.removeprefix(b"\xef\xbb\xbf")
    if b"\0" in data:
        raise FormatError(f"{where}: byte {data.index(0)} is zero; this is no OBJ text file")
    if b"\r" in data:
        data = data.replace(b"\r\n", b"\n").replace(b"\r", b"\n")
    if b"\\\n" in data:
        data = _CONTINUED.sub(_join, data)
    return [line.strip() for line in data.split(b"\n")]


def _join(match: re.Match[bytes]) -> bytes:
    text = match.group()
    return text.replace(b"\\\n", b" ") + b"\n" * text.count(b"\\\n")


def _keyword(line: bytes) -> bytes:
    return b"#" if line[:1] == b"#" else line.split(None, 1)[0] if line else b""


class _Reader:
    """What has been read so far, block after block of lines with the same keyword."""

    def __init__(self, where: str) -> None:
        self._where = where
        self._positions: list[FloatArray] = []
        self._uvs: list[FloatArray] = []
        self._corners: list[Corners] = []
        self._counts = {b"v": 0, b"vt": 0}
        self._objects, self._groups, self._materials = _Names(), _Names(), _Names()
        self._left_out: Counter[str] = Counter()
        self._read: dict[bytes, Callable[[list[bytes], int], None]] = {
            b"v": self._read_positions,
            b"vt": self._read_uvs,
            b"f": self._read_polygons,
            b"o": lambda block, _: self._objects.name(_name(block[-1])),
            b"g": lambda block, _: self._groups.name(_name(block[-1])),
            b"usemtl": lambda block, _: self._materials.name(_name(block[-1])),
        }

    def read(self, keyword: bytes, block: list[bytes], line: int) -> None:
        if keyword in self._read:
            self._read[keyword](block, line)
        elif keyword in _NOTED:
            self._left_out[keyword.decode()] += len(block)
        elif keyword not in (b"", b"#") and keyword not in _SILENT:
            raise FormatError(
                f"{self._where}: line {line}: {_shown(keyword)} is no OBJ statement; "
                "correct or remove the line"
            )

    def positions(self) -> FloatArray:
        if not self._counts[b"v"]:
            raise FormatError(f"{self._where}: has no vertices ('v' lines); is it an OBJ file?")
        return np.concatenate(self._positions)

    def mesh(self) -> PolygonMesh:
        positions = self.positions()
        if self._left_out:
            listed = ", ".join(f"{n} '{keyword}'" for keyword, n in self._left_out.items())
            warnings.warn(
                f"{self._where}: left out lines that are no polygons: {listed}",
                RisoriusWarning,
                stacklevel=4,
            )
        corners = Corners.concatenated(self._corners)
        self._require_range(corners.vertices, corners, self._counts[b"v"], "vertex")
        self._require_range(corners.uvs, corners, self._counts[b"vt"], "texture coordinate")
        has_uvs = bool((corners.uvs != NO_UV).any())
        return PolygonMesh(
            positions,
            corners.vertices.astype(np.int32),
            np.concatenate([[0], np.cumsum(corners.sizes)]).astype(np.int32),
            uvs=np.concatenate(self._uvs) if self._uvs else np.zeros((0, 2)),
            uv_corners=corners.uvs.astype(np.int32) if has_uvs else np.zeros(0, np.int32),
            objects=self._objects.labels(),
            groups=self._groups.labels(),
            materials=self._materials.labels(),
        )

    def _read_positions(self, block: list[bytes], line: int) -> None:
        # Weights and vertex colours may follow the three coordinates.
        rows = _numbers(block, line, self._where, least=3, most=8, keep=3)
        self._positions.append(rows)
        self._counts[b"v"] += len(rows)

    def _read_uvs(self, block: list[bytes], line: int) -> None:
        rows = _numbers(block, line, self._where, least=1, most=3, keep=2)
        self._uvs.append(rows)
        self._counts[b"vt"] += len(rows)

    def _read_polygons(self, block: list[bytes], line: int) -> None:
        corners = read_corners(block, line, self._where)
        count, uv_count = self._counts[b"v"], self._counts[b"vt"]
        self._corners.append(corners.absolute(vertex_count=count, uv_count=uv_count))
        for names in (self._objects, self._groups, self._materials):
            names.use(len(block))

    def _require_range(self, index: LongArray, corners: Corners, count: int, what: str) -> None:
        bad = (index >= count) | (index == OUT_OF_RANGE)
        if bad.any():
            line = int(corners.line_of_corner(int(np.argmax(bad))))
            raise FormatError(
                f"{self._where}: line {line}: names a {what} that does not exist "
                f"(the file has {count}); is the file cut off?"
            )


class _Names:
    """Labels of one kind while the file is read."""

    def __init__(self) -> None:
        self._index: dict[str, int] = {}
        self._current = ""
        self._runs: list[tuple[int, int]] = []

    def name(self, name: str) -> None:
        self._current = name

    def use(self, count: int) -> None:
        label = self._index.setdefault(self._current, len(self._index)) if self._current else -1
        self._runs.append((label, count))

    def labels(self) -> Labels:
        if not self._index:
            return Labels()
        labels, counts = zip(*self._runs)
        return Labels(tuple(self._index), np.repeat(np.array(labels, np.int32), counts))


def _numbers(
    block: list[bytes], line: int, where: str, *, least: int, most: int, keep: int
) -> FloatArray:
    """Return the first `keep` numbers after the keyword of each line, 0 where it has fewer."""
    tokens = [row.partition(b"#")[0].split()[1:] for row in block]
    sizes = set(map(len, tokens))
    if min(sizes) < least or max(sizes) > most:
        bad = next(i for i, row in enumerate(tokens) if not least <= len(row) <= most)
        raise FormatError(
            f"{where}: line {line + bad}: expected {least} to {most} numbers after "
            f"{_shown(block[bad].split()[0])}, found {len(tokens[bad])}"
        )
    if sizes != {keep}:
        tokens = [(row + [b"0"] * keep)[:keep] for row in tokens]
    try:
        values = np.array(list(map(float, chain.from_iterable(tokens)))).reshape(-1, keep)
        if first_bad_row(values) is None and not any(b"_" in row for row in block):
            return values
    except ValueError:
        pass  # the slow way below finds the line
    bad = next(i for i, row in enumerate(tokens) if not all(map(_is_number, row)))
    raise FormatError(
        f"{where}: line {line + bad}: {_shown(block[bad])} must hold finite numbers, none beyond "
        f"{LARGEST:g}"
    )


def _is_number(token: bytes) -> bool:
    try:
        return b"_" not in token and abs(float(token)) <= LARGEST
    except ValueError:
        return False


def _name(line: bytes) -> str:
    """Return the name after the keyword; several names are joined by a space."""
    raw = b" ".join(line.split()[1:])
    try:
        return raw.decode()
    except UnicodeDecodeError:
        return raw.decode("latin-1")


def _shown(text: bytes) -> str:
    return repr(text[:40].decode("ascii", errors="replace"))


register(Format("obj", (".obj",), read_head=read_obj))
