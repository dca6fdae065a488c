"""Read STL files, binary and ASCII; the triangle soup is joined where corners are equal."""

from __future__ import annotations

import re
from array import array
from pathlib import Path

import numpy as np

from risorius._check import FloatArray
from risorius._formats import Format, register
from risorius.errors import FormatError
from risorius.io.bounded import MEGABYTE, read_bytes_limited
from risorius.io.finite import as_doubles, require_finite
from risorius.landmarks.landmark_set import LandmarkSpec
from risorius.mesh.polygon_mesh import PolygonMesh

__all__ = ["parse_stl", "read_stl"]

_LIMIT = 256 * MEGABYTE
_HEADER = 84
_FACET = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("colour", "<u2")])
_TEXT_LIMIT = 128 * MEGABYTE
_VERTEX = re.compile(rb"\bvertex\s++(\S++)\s++(\S++)\s++(\S++)")
_FACET_END = re.compile(rb"\bendfacet\b")


def read_stl(path: str | Path) -> tuple[PolygonMesh, dict[str, LandmarkSpec]]:
    """Read an STL file; the second value, its landmarks, is always empty.

    Raises
    ------
    FormatError
        On a malformed or truncated file.

    Notes
    -----
    STL has no vertices, only corners. Those that are equal become one vertex, in order of first
    appearance; lips that touch at rest are joined by that, so leave the mouth a little open or
    use another format.
    """
    return parse_stl(read_bytes_limited(path, limit=_LIMIT), str(path)), {}


def parse_stl(data: bytes, where: str) -> PolygonMesh:
    """Return the mesh in `data`; `where` opens every message."""
    count = int.from_bytes(data[80:_HEADER], "little") if len(data) >= _HEADER else 0
    expected = _HEADER + count * _FACET.itemsize
    is_text = data.lstrip()[:5].lower() == b"solid"
    if len(data) == expected or (not is_text and _HEADER < expected < len(data)):
        corners = np.frombuffer(data, _FACET, count, _HEADER)["corners"].reshape(-1, 3)
        corners = as_doubles(corners)
    elif is_text:
        corners = _ascii_corners(data, where)
    else:
        raise FormatError(
            f"{where}: {len(data)} bytes are no binary STL of {count} triangles ({expected} bytes) "
            "and no text that begins with 'solid'; is the file cut off?"
        )
    require_finite(corners, where, row_name="corner")
    if not len(corners):
        raise FormatError(f"{where}: has no triangles")
    return _joined(corners)


def _ascii_corners(data: bytes, where: str) -> FloatArray:
    if b"endsolid" not in data[-1000:].lower():
        raise FormatError(f"{where}: the text does not end with 'endsolid'; is it cut off?")
    if len(data) > _TEXT_LIMIT:
        raise FormatError(
            f"{where}: more than {_TEXT_LIMIT // MEGABYTE} MB of text; save as binary"
        )
    numbers = array("d")
    for match in _VERTEX.finditer(data):
        try:
            numbers.extend(map(float, match.groups()))
        except ValueError:
            shown = match.group()[:60].decode("ascii", errors="replace")
            raise FormatError(f"{where}: {shown!r} is not three numbers") from None
    facets = sum(1 for _ in _FACET_END.finditer(data))
    if len(numbers) != 9 * facets:
        raise FormatError(f"{where}: {len(numbers) // 3} vertices do not make {facets} triangles")
    return np.array(numbers).reshape(-1, 3)


def _joined(corners: FloatArray) -> PolygonMesh:
    _, first, place = np.unique(corners, axis=0, return_index=True, return_inverse=True)
    order = np.argsort(first)
    rank = np.empty(len(order), np.int32)
    rank[order] = np.arange(len(order))
    offsets = np.arange(0, len(corners) + 1, 3, dtype=np.int32)
    return PolygonMesh(corners[first[order]], rank[place.ravel()], offsets)


register(Format("stl", (".stl",), read_head=read_stl))
