"""Look into GLB files without the code under test, and make glTF files by hand."""

from __future__ import annotations

import base64
import json
import struct
from typing import Any

import numpy as np

TYPES = {5120: "<i1", 5121: "<u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}


def unpack(data: bytes) -> tuple[dict[str, Any], bytes]:
    """Return JSON and binary chunk."""
    assert data[:4] == b"glTF"
    assert struct.unpack_from("<II", data, 4) == (2, len(data))
    size, kind = struct.unpack_from("<I4s", data, 12)
    assert kind == b"JSON"
    document = json.loads(data[20 : 20 + size])
    length, kind = struct.unpack_from("<I4s", data, 20 + size)
    assert kind == b"BIN\0"
    assert 28 + size + length == len(data)
    return document, data[28 + size :]


def pack(document: dict[str, Any], binary: bytes) -> bytes:
    """Return a GLB."""
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    return b"".join(
        [
            struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(binary)),
            struct.pack("<I4s", len(text), b"JSON") + text,
            struct.pack("<I4s", len(binary), b"BIN\0") + binary,
        ]
    )


def values(document: dict[str, Any], binary: bytes, index: int) -> np.ndarray:
    """Return an accessor (n, width) of a dense, float or integer, maybe sparse kind."""
    accessor = document["accessors"][index]
    width, dtype = WIDTHS[accessor["type"]], np.dtype(TYPES[accessor["componentType"]])
    result = np.zeros((accessor["count"], width), dtype)
    if "bufferView" in accessor:
        view = document["bufferViews"][accessor["bufferView"]]
        start = view["byteOffset"] + accessor.get("byteOffset", 0)
        result[:] = np.frombuffer(binary, dtype, result.size, start).reshape(result.shape)
    if "sparse" in accessor:
        sparse = accessor["sparse"]
        rows, replaced = sparse["indices"], sparse["values"]
        index_type = TYPES[rows["componentType"]]
        start = document["bufferViews"][rows["bufferView"]]["byteOffset"] + rows["byteOffset"]
        places = np.frombuffer(binary, index_type, sparse["count"], start)
        start = document["bufferViews"][replaced["bufferView"]]["byteOffset"]
        start += replaced["byteOffset"]
        count = sparse["count"] * width
        result[places] = np.frombuffer(binary, dtype, count, start).reshape(-1, width)
    return result


class Maker:
    """Build a small glTF file: arrays become views and accessors of one buffer."""

    def __init__(self) -> None:
        self.data = b""
        self.document: dict[str, Any] = {
            "asset": {"version": "2.0"},
            "scene": 0,
            "scenes": [{"nodes": [0]}],
            "nodes": [{"mesh": 0}],
            "meshes": [{"primitives": []}],
            "accessors": [],
            "bufferViews": [],
            "buffers": [],
        }

    def view(self, data: bytes, **fields: Any) -> int:
        self.data += bytes(-len(self.data) % 4)
        place = {"buffer": 0, "byteOffset": len(self.data), "byteLength": len(data)}
        self.data += data
        self.document["bufferViews"].append({**place, **fields})
        return len(self.document["bufferViews"]) - 1

    def accessor(self, array: Any, **fields: Any) -> int:
        array = np.asarray(array)
        component = next(k for k, v in TYPES.items() if np.dtype(v) == array.dtype)
        width = 1 if array.ndim == 1 else array.shape[1]
        kind = next(k for k, v in WIDTHS.items() if v == width)
        self.document["accessors"].append(
            {
                "bufferView": self.view(array.tobytes()),
                "componentType": component,
                "count": len(array),
                "type": kind,
                **fields,
            }
        )
        return len(self.document["accessors"]) - 1

    def primitive(self, positions: Any, indices: Any = None, **fields: Any) -> dict[str, Any]:
        position = self.accessor(np.asarray(positions, "<f4"))
        primitive: dict[str, Any] = {"attributes": {"POSITION": position}, **fields}
        if indices is not None:
            primitive["indices"] = self.accessor(np.asarray(indices))
        self.document["meshes"][0]["primitives"].append(primitive)
        return primitive

    def glb(self) -> bytes:
        self.document["buffers"] = [{"byteLength": len(self.data)}]
        return pack(self.document, self.data)

    def gltf(self, uri: str | None = None) -> bytes:
        """Return JSON with the buffer inside, or naming the file `uri`."""
        inside = "data:application/octet-stream;base64," + base64.b64encode(self.data).decode()
        self.document["buffers"] = [{"byteLength": len(self.data), "uri": uri or inside}]
        return json.dumps(self.document).encode()
