"""Collect the accessors, buffer views and bytes of a GLB that is being written.

References
----------
Khronos Group, glTF 2.0 specification, sections 3.6.2 (accessors), 4.4 (GLB layout).
"""

from __future__ import annotations

import json
import struct
from typing import Any

import numpy as np
import numpy.typing as npt

__all__ = ["BinaryBuilder"]

ARRAY_BUFFER, ELEMENT_ARRAY_BUFFER = 34962, 34963
_COMPONENT = {"f4": 5126, "u4": 5125, "u2": 5123}
_TYPE = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4"}


class _Pool:
    """A buffer view that many sparse accessors share; each keeps its byte offset."""

    def __init__(self, view: int) -> None:
        self.view = view
        self.parts: list[bytes] = []
        self.size = 0

    def add(self, data: bytes) -> dict[str, int]:
        offset = self.size
        self.parts.append(data + bytes(-len(data) % 4))
        self.size += len(self.parts[-1])
        return {"bufferView": self.view, "byteOffset": offset}


class BinaryBuilder:
    """The binary chunk and the JSON lists that describe it."""

    def __init__(self) -> None:
        self._views: list[dict[str, Any]] = []
        self._accessors: list[dict[str, Any]] = []
        self._parts: list[bytes] = []
        self._size = 0
        self._pools: dict[str, _Pool] = {}
        self._zeros: dict[int, int] = {}
        self._zero_views: dict[int, int] = {}

    def view(self, data: npt.NDArray[Any], *, target: int | None = None, name: str = "") -> int:
        """Add the bytes of `data` (...) and return the index of its buffer view."""
        view: dict[str, Any] = {"buffer": 0, **self._place(data.tobytes())}
        if target is not None:
            view["target"] = target
        if name:
            view["name"] = name
        self._views.append(view)
        return len(self._views) - 1

    def accessor(
        self, values: npt.NDArray[Any], *, target: int | None = ARRAY_BUFFER, bounds: bool = False
    ) -> int:
        """Add `values` (n,) or (n, 2..4) and return the index of their accessor."""
        accessor = _described(values, bounds)
        accessor["bufferView"] = self.view(values, target=target)
        return self._add(accessor)

    def displacements(
        self,
        rows: npt.NDArray[np.int64],
        values: npt.NDArray[np.float32],
        count: int,
        *,
        bounds: bool,
    ) -> int:
        """Add an accessor of `count` vectors, zero but for `values` (k, 3) in `rows` (k,).

        It is sparse, or full where that is smaller; without rows it is shared. glTF lets both go
        without a buffer view, but several importers fail there (Unity's glTFast and UnityGLTF),
        and Unreal's drops such accessors and miscounts those behind them: they stand on zeros
        that all of one length share.
        """
        if not len(rows):
            return self._all_zero(count)
        dtype = "<u2" if count <= 65535 else "<u4"
        if len(rows) * (np.dtype(dtype).itemsize + 12) >= count * 12:
            full = np.zeros((count, 3), "<f4")
            full[rows] = values
            return self.accessor(full, bounds=bounds)
        accessor = _described(values, bounds)
        accessor["count"] = count
        accessor["bufferView"] = self._zero_view(count)
        if bounds and len(rows) < count:
            accessor["min"] = np.minimum(accessor["min"], 0.0).tolist()
            accessor["max"] = np.maximum(accessor["max"], 0.0).tolist()
        accessor["sparse"] = {
            "count": len(rows),
            "indices": {
                **self._pool(dtype).add(rows.astype(dtype).tobytes()),
                "componentType": _COMPONENT[dtype[1:]],
            },
            "values": self._pool("<f4").add(values.astype("<f4").tobytes()),
        }
        return self._add(accessor)

    def glb(self, content: dict[str, Any]) -> bytes:
        """Return the finished file with `content` as the rest of its JSON."""
        for pool in self._pools.values():
            self._views[pool.view].update(self._place(b"".join(pool.parts)))
        binary = b"".join(self._parts)
        described = {
            **content,
            "accessors": self._accessors,
            "bufferViews": self._views,
            "buffers": [{"byteLength": len(binary)}],
        }
        text = json.dumps(described, separators=(",", ":"), ensure_ascii=False, allow_nan=False)
        head = text.encode()
        head += b" " * (-len(head) % 4)
        return b"".join(
            [
                struct.pack("<4sII", b"glTF", 2, 28 + len(head) + len(binary)),
                struct.pack("<I4s", len(head), b"JSON"),
                head,
                struct.pack("<I4s", len(binary), b"BIN\0"),
                binary,
            ]
        )

    def _add(self, accessor: dict[str, Any]) -> int:
        self._accessors.append(accessor)
        return len(self._accessors) - 1

    def _all_zero(self, count: int) -> int:
        if count not in self._zeros:
            accessor = _described(np.zeros((1, 3), "<f4"), True)
            accessor.update(count=count, bufferView=self._zero_view(count))
            self._zeros[count] = self._add(accessor)
        return self._zeros[count]

    def _zero_view(self, count: int) -> int:
        """Return the buffer view of `count` zero vectors, which many accessors share."""
        if count not in self._zero_views:
            view = self.view(np.zeros((count, 3), "<f4"), target=ARRAY_BUFFER, name="zeros")
            self._views[view]["byteStride"] = 12
            self._zero_views[count] = view
        return self._zero_views[count]

    def _pool(self, key: str) -> _Pool:
        if key not in self._pools:
            self._views.append({"buffer": 0})
            self._pools[key] = _Pool(len(self._views) - 1)
        return self._pools[key]

    def _place(self, data: bytes) -> dict[str, int]:
        place = {"byteOffset": self._size, "byteLength": len(data)}
        self._parts.append(data + bytes(-len(data) % 4))
        self._size += len(self._parts[-1])
        return place


def _described(values: npt.NDArray[Any], bounds: bool) -> dict[str, Any]:
    width = 1 if values.ndim == 1 else values.shape[1]
    accessor: dict[str, Any] = {
        "componentType": _COMPONENT[values.dtype.str[1:]],
        "count": len(values),
        "type": _TYPE[width],
    }
    if bounds:
        accessor["min"] = np.atleast_1d(values.min(axis=0)).tolist()
        accessor["max"] = np.atleast_1d(values.max(axis=0)).tolist()
    return accessor
