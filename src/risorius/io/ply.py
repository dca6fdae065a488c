"""Read PLY files: ASCII and binary, polygons of any size, vertex order kept.

An own reader: the library at hand cannot read binary files that mix triangles and quads.

References
----------
Turk 1994, "The PLY Polygon File Format".
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from risorius._check import FloatArray, IntArray
from risorius._formats import Format, register
from risorius.errors import FormatError
from risorius.io.bounded import MEGABYTE, read_bytes_limited
from risorius.io.finite import as_doubles, require_finite
from risorius.io.ply_elements import Column, Element, read_elements
from risorius.landmarks.landmark_set import LandmarkSpec
from risorius.mesh.polygon_mesh import PolygonMesh

__all__ = ["parse_ply", "read_ply"]

_LIMIT = 256 * MEGABYTE
_HEADER_LIMIT = 1 << 16
_INDEX_NAMES = ("vertex_indices", "vertex_index")
_UV_NAMES = (("u", "v"), ("s", "t"), ("texture_u", "texture_v"))
_SCALARS = {
    "char": "i1", "int8": "i1", "uchar": "u1", "uint8": "u1",
    "short": "i2", "int16": "i2", "ushort": "u2", "uint16": "u2",
    "int": "i4", "int32": "i4", "uint": "u4", "uint32": "u4",
    "float": "f4", "float32": "f4", "double": "f8", "float64": "f8",
}  # fmt: skip
_BYTE_ORDERS = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}


def read_ply(path: str | Path) -> tuple[PolygonMesh, dict[str, LandmarkSpec]]:
    """Read a PLY file; the second value, its landmarks, is always empty.

    Raises
    ------
    FormatError
        On a malformed or truncated file.
    """
    return parse_ply(read_bytes_limited(path, limit=_LIMIT), str(path)), {}


def parse_ply(data: bytes, where: str) -> PolygonMesh:
    """Return the mesh in `data`; `where` opens every message."""
    elements, order, start = _header(data, where)
    columns = read_elements(memoryview(data)[start:], elements, order, where)
    vertices = columns.get("vertex", {})
    if not all(axis in vertices for axis in "xyz"):
        raise FormatError(f"{where}: has no vertices with x, y and z")
    positions = as_doubles(np.stack([vertices[axis].values for axis in "xyz"], axis=1))
    require_finite(positions, where)
    corners, sizes = _polygons(columns.get("face", {}), len(positions), where)
    uvs, uv_corners = _uvs(columns, corners, sizes, where)
    return PolygonMesh(
        positions,
        corners,
        np.concatenate([[0], np.cumsum(sizes)]).astype(np.int32),
        uvs=uvs,
        uv_corners=uv_corners,
    )


def _header(data: bytes, where: str) -> tuple[list[Element], str, int]:
    """Return the elements, the byte order (empty for ASCII) and where the body starts."""
    end = data.find(b"end_header", 0, _HEADER_LIMIT)
    if not data.startswith(b"ply") or end < 0:
        raise FormatError(f"{where}: has no PLY header ('ply' ... 'end_header')")
    start = end + len(b"end_header")
    start += 2 if data[start : start + 2] == b"\r\n" else 1
    order: str | None = None
    elements: list[Element] = []
    for number, raw in enumerate(data[:end].decode("latin-1").splitlines(), start=1):
        words = raw.split()
        problem = FormatError(f"{where}: line {number}: {raw[:60]!r} is no PLY header line")
        match words:
            case [] | ["comment" | "obj_info" | "ply", *_]:
                pass
            case ["format", name, "1.0"] if name in _BYTE_ORDERS:
                order = _BYTE_ORDERS[name]
            case ["element", name, count] if count.isdecimal() and len(count) < 19:
                elements.append(Element(name, int(count), {}, {}))
            case ["property", "list", size, kind, name] if elements:
                if size not in _SCALARS or kind not in _SCALARS or name in elements[-1].types:
                    raise problem
                elements[-1].types[name] = _SCALARS[kind]
                elements[-1].list_sizes[name] = _SCALARS[size]
            case ["property", kind, name] if elements and kind in _SCALARS:
                if name in elements[-1].types:
                    raise problem
                elements[-1].types[name] = _SCALARS[kind]
            case _:
                raise problem
    if order is None:
        raise FormatError(f"{where}: the PLY header names no format")
    return elements, order, start


def _polygons(columns: dict[str, Column], count: int, where: str) -> tuple[IntArray, IntArray]:
    name = next((name for name in _INDEX_NAMES if name in columns), None)
    if name is None:
        if columns:
            raise FormatError(f"{where}: its faces have no list 'vertex_indices'")
        return np.zeros(0, np.int32), np.zeros(0, np.int32)
    column = columns[name]
    if not len(column.sizes):
        raise FormatError(f"{where}: {name!r} must be a list property")
    bad = ~((column.values >= 0) & (column.values < count) & (column.values % 1 == 0))
    if bad.any():
        corner = int(np.argmax(bad))
        polygon = int(np.searchsorted(np.cumsum(column.sizes), corner, side="right"))
        named = column.values[corner]
        raise FormatError(
            f"{where}: polygon {polygon} names vertex {named:g}, the file has {count}"
        )
    return column.values.astype(np.int32), column.sizes.astype(np.int32)


def _uvs(
    columns: dict[str, dict[str, Column]], corners: IntArray, sizes: IntArray, where: str
) -> tuple[FloatArray, IntArray]:
    """Return texture coordinates of corners or, where there are none, of vertices."""
    vertices, faces = columns["vertex"], columns.get("face", {})
    none = np.zeros(0, np.int32)
    if "texcoord" in faces and np.array_equal(faces["texcoord"].sizes, 2 * sizes):
        uvs = as_doubles(faces["texcoord"].values).reshape(-1, 2)
        uv_corners = np.arange(len(corners), dtype=np.int32)
    else:
        names = next((pair for pair in _UV_NAMES if all(n in vertices for n in pair)), None)
        if names is None:
            return np.zeros((0, 2)), none
        uvs = as_doubles(np.stack([vertices[name].values for name in names], axis=1))
        uv_corners = corners
    require_finite(uvs, where)
    return uvs, uv_corners if len(uvs) else none


register(Format("ply", (".ply",), read_head=read_ply))
