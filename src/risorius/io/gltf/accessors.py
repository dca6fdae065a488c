"""Decode glTF accessors: any component type, strided, normalised, sparse.

References
----------
Khronos Group, glTF 2.0 specification, section 3.6.2.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from risorius._check import FloatArray
from risorius.errors import FormatError
from risorius.io.finite import as_doubles, require_finite
from risorius.io.gltf.document import Document
from risorius.io.json_fields import Fields

__all__ = ["element_count", "read_floats", "read_indices", "read_rows"]

NumberArray = npt.NDArray[np.number]
LongArray = npt.NDArray[np.int64]

_COMPONENTS = {
    5120: np.dtype("<i1"),
    5121: np.dtype("<u1"),
    5122: np.dtype("<i2"),
    5123: np.dtype("<u2"),
    5125: np.dtype("<u4"),
    5126: np.dtype("<f4"),
}
_WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}
_MOST_UNBACKED = 1 << 22  # elements that may be all zero, as no data in the file stand for them


@dataclass(frozen=True)
class _Layout:
    fields: Fields
    count: int
    width: int
    dtype: np.dtype[np.number]
    normalised: bool

    def floats(self, raw: NumberArray) -> FloatArray:
        """Return raw components as float64, normalised integers in -1..1."""
        values = as_doubles(raw)
        if self.normalised and self.dtype.kind in "iu":
            bits = 8 * self.dtype.itemsize - (self.dtype.kind == "i")
            values = np.maximum(values / (2.0**bits - 1.0), -1.0)
        return values


def element_count(document: Document, index: object, where: str) -> int:
    """Return how many elements an accessor claims to have."""
    return document.element("accessors", index, where).integer("count", low=1)


def read_floats(document: Document, index: object, where: str, *, width: int) -> FloatArray:
    """Return an accessor of `width` components as (count, width) float64.

    Raises
    ------
    FormatError
        If it lies outside its buffer, has another width, or holds NaN or infinity (the first bad
        row is named).
    """
    layout = _layout(document, index, where, width)
    values = layout.floats(_base(document, layout))
    rows, replaced = _replaced(document, layout)
    values[rows] = layout.floats(replaced)
    require_finite(values, layout.fields.where)
    return values


def read_rows(
    document: Document, index: object, where: str, *, width: int, count: int
) -> tuple[LongArray, FloatArray]:
    """Return the rows (k,) of an accessor that are not zero, and their values (k, width).

    `count` is how many elements it must have; a sparse accessor on zeros is never unfolded.
    """
    layout = _layout(document, index, where, width)
    if layout.count != count:
        raise FormatError(f"{layout.fields.where}: expected {count} elements, not {layout.count}")
    rows, replaced = _replaced(document, layout)
    values = layout.floats(replaced)
    if "bufferView" in layout.fields and not _is_blank(document, layout):
        dense = layout.floats(_base(document, layout))
        dense[rows] = values
        rows = np.arange(count, dtype=np.int64)
        values = dense
    require_finite(values, layout.fields.where)
    moves = values.any(axis=1)
    return rows[moves], values[moves]


def read_indices(document: Document, index: object, where: str) -> LongArray:
    """Return an accessor of vertex indices as (count,) int64."""
    layout = _layout(document, index, where, 1)
    if layout.dtype.kind != "u":
        raise FormatError(f"{layout.fields.where}: indices must be unsigned integers")
    values = _base(document, layout).astype(np.int64)
    rows, replaced = _replaced(document, layout)
    values[rows] = replaced.astype(np.int64)
    return values[:, 0]


def _layout(document: Document, index: object, where: str, width: int) -> _Layout:
    fields = document.element("accessors", index, where)
    component = fields.integer("componentType")
    kind = fields.text("type")
    if component not in _COMPONENTS:
        raise FormatError(f"{fields.where}: {component} is no component type")
    if _WIDTHS.get(kind) != width:
        raise FormatError(f"{fields.where}: expected {width} components, found {kind[:20]!r}")
    normalised = fields.value.get("normalized") is True
    count = fields.integer("count", low=1)
    return _Layout(fields, count, width, _COMPONENTS[component], normalised)


def _base(document: Document, layout: _Layout) -> NumberArray:
    """Return the raw components (count, width) before sparse replacement."""
    fields = layout.fields
    if "bufferView" in fields:
        offset = fields.integer("byteOffset", default=0)
        data, stride = document.view(fields.value["bufferView"], fields.place("bufferView"))
        raw = _strided(data, offset, stride, layout, layout.count)
    elif layout.count > _MOST_UNBACKED:
        raise FormatError(f"{fields.where}: {layout.count} elements without a buffer view")
    else:
        raw = np.zeros((layout.count, layout.width), layout.dtype)
    document.spend(raw.size, fields.where)
    return raw


def _is_blank(document: Document, layout: _Layout) -> bool:
    """Return whether an accessor's buffer view is long enough and holds nothing but zeros."""
    fields = layout.fields
    index, place = fields.value["bufferView"], fields.place("bufferView")
    data, stride = document.view(index, place)
    _strided(data, fields.integer("byteOffset", default=0), stride, layout, layout.count)
    return document.is_blank(index, place)


def _strided(
    data: memoryview, offset: int, stride: int | None, layout: _Layout, count: int
) -> NumberArray:
    size = layout.dtype.itemsize * layout.width
    step = size if stride is None else stride
    if step < size:
        raise FormatError(f"{layout.fields.where}: a stride of {step} bytes makes elements overlap")
    if offset + step * (count - 1) + size > len(data):
        raise FormatError(
            f"{layout.fields.where}: {count} elements from byte {offset} do not fit into its "
            f"buffer view of {len(data)} bytes"
        )
    return np.ndarray(
        (count, layout.width), layout.dtype, data, offset, (step, layout.dtype.itemsize)
    )


def _replaced(document: Document, layout: _Layout) -> tuple[LongArray, NumberArray]:
    """Return rows (k,) and raw values (k, width) of the sparse part."""
    if "sparse" not in layout.fields:
        return np.zeros(0, np.int64), np.zeros((0, layout.width), layout.dtype)
    sparse = layout.fields.fields("sparse")
    count = sparse.integer("count", low=1)
    if count > layout.count:
        raise FormatError(f"{sparse.where}: replaces {count} of {layout.count} elements")
    document.spend(count * layout.width, sparse.where)
    places, values = sparse.fields("indices"), sparse.fields("values")
    component = places.integer("componentType")
    dtype = _COMPONENTS.get(component)
    if dtype is None or dtype.kind != "u":
        raise FormatError(f"{places.where}: {component} is no type of an index")
    index_layout = _Layout(places, count, 1, dtype, False)
    rows = _part(document, places, index_layout)[:, 0].astype(np.int64)
    if (rows >= layout.count).any() or (np.diff(rows) <= 0).any():
        raise FormatError(f"{places.where}: rows must rise and lie in 0..{layout.count - 1}")
    value_layout = _Layout(values, count, layout.width, layout.dtype, False)
    return rows, _part(document, values, value_layout)


def _part(document: Document, fields: Fields, layout: _Layout) -> NumberArray:
    data, _ = document.view(fields.value.get("bufferView"), fields.place("bufferView"))
    return _strided(data, fields.integer("byteOffset", default=0), None, layout, layout.count)
