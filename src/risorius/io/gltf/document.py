"""The JSON of a glTF file with its buffers: typed access, bounded memory, no way out of the folder.

References
----------
Khronos Group, glTF 2.0 specification, sections 3.6 (binary data) and 4 (GLB).
"""

from __future__ import annotations

import base64
import binascii
import struct
from pathlib import Path
from urllib.parse import unquote

import numpy as np

from risorius.errors import FormatError
from risorius.io.bounded import MEGABYTE, parse_json, read_bytes_limited
from risorius.io.json_fields import Fields, whole_number

__all__ = ["Document", "open_document", "optional_index"]

_LIMIT = 512 * MEGABYTE
# Decoded numbers of one file, 8 bytes each: a small file may name the same data many times.
_MOST_VALUES = 1 << 27
_MAGIC = b"glTF"
_JSON_CHUNK, _BINARY_CHUNK = b"JSON", b"BIN\0"

# Extensions that change neither the shape of a head nor where its numbers stand.
_HARMLESS = ("KHR_materials_", "KHR_texture_", "KHR_lights_", "EXT_texture_", "MSFT_texture_")
_READ = {"KHR_mesh_quantization"}
_COMPRESSED = {
    "KHR_draco_mesh_compression": "Draco",
    "EXT_meshopt_compression": "meshopt",
    "KHR_meshopt_compression": "meshopt",
}


class Document:
    """A parsed glTF file.

    Parameters
    ----------
    path : Path
        For messages and as the home of external buffers.
    root : object
        The parsed JSON.
    binary : bytes
        The binary chunk of a GLB, maybe empty.
    """

    def __init__(self, path: Path, root: object, binary: bytes) -> None:
        self.path = path
        self.root = Fields(root, str(path))
        self._binary = binary
        self._buffers: dict[int, bytes] = {}
        self._blank: dict[int, bool] = {}
        self._values_left = _MOST_VALUES
        self._require_understood()

    def elements(self, kind: str) -> range:
        """Return the indices of a top-level list such as ``"nodes"``."""
        return range(len(self.root.items(kind)))

    def element(self, kind: str, index: object, where: str) -> Fields:
        """Return an entry of a top-level list; `where` names what refers to it."""
        items = self.root.items(kind)
        number = whole_number(index, where)
        if number >= len(items):
            raise FormatError(f"{where}: names {kind}[{number}], the file has {len(items)}")
        return Fields(items[number], f"{self.path}: {kind}[{number}]")

    def spend(self, values: int, where: str) -> None:
        """Count decoded numbers and refuse a file that asks for too many of them."""
        self._values_left -= values
        if self._values_left < 0:
            raise FormatError(
                f"{where}: the file unfolds to more than {_MOST_VALUES} numbers; "
                "split it or remove instances and morph targets"
            )

    def view(self, index: object, where: str) -> tuple[memoryview, int | None]:
        """Return the bytes of a buffer view and its stride (None where it is dense)."""
        view = self.element("bufferViews", index, where)
        if any(name in view.fields("extensions") for name in _COMPRESSED):
            raise FormatError(_compressed_message(self.path, "meshopt"))
        data = self._buffer(view.integer("buffer"), view.place("buffer"))
        start, length = view.integer("byteOffset", default=0), view.integer("byteLength", low=1)
        if start + length > len(data):
            raise FormatError(
                f"{view.where}: bytes {start}..{start + length} lie outside its buffer of "
                f"{len(data)} bytes"
            )
        stride = view.integer("byteStride", low=1) if "byteStride" in view else None
        return memoryview(data)[start : start + length], stride

    def is_blank(self, index: object, where: str) -> bool:
        """Return whether a buffer view holds nothing but zero bytes."""
        number = whole_number(index, where)
        if number not in self._blank:
            data, _ = self.view(number, where)
            # Looking costs less than decoding, but overlapping views could ask for it without end.
            self.spend(len(data) // 32, where)
            self._blank[number] = not np.frombuffer(data, np.uint8).any()
        return self._blank[number]

    def _buffer(self, index: int, where: str) -> bytes:
        if index not in self._buffers:
            fields = self.element("buffers", index, where)
            length = fields.integer("byteLength", low=1)
            if "uri" in fields:
                data = self._fetch(fields.text("uri"), fields.place("uri"))
            else:
                data = self._binary if index == 0 else b""
            if len(data) < length:
                raise FormatError(
                    f"{fields.where}: holds {len(data)} bytes and claims {length}; is it cut off?"
                )
            if sum(map(len, self._buffers.values())) + length > _LIMIT:
                raise FormatError(f"{fields.where}: buffers exceed {_LIMIT // MEGABYTE} MB")
            self._buffers[index] = data[:length]
        return self._buffers[index]

    def _fetch(self, uri: str, where: str) -> bytes:
        if uri.startswith("data:"):
            head, comma, text = uri.partition(",")
            if not comma or not head.endswith(";base64"):
                raise FormatError(f"{where}: expected data:...;base64,...")
            try:
                return base64.b64decode(text, validate=True)
            except (binascii.Error, ValueError):
                raise FormatError(f"{where}: is not valid base64") from None
        name = unquote(uri)
        folder = self.path.parent.resolve()
        outside = FormatError(
            f"{where}: {uri[:60]!r} does not lie beside the glTF file; only files in its folder "
            "are read"
        )
        if ":" in name or "\\" in name or "\0" in name or name.startswith("/"):
            raise outside
        try:
            file = (folder / name).resolve()
        except (OSError, RuntimeError):
            raise outside from None
        if folder not in file.parents:
            raise outside
        return read_bytes_limited(file, limit=_LIMIT)

    def _require_understood(self) -> None:
        version = self.root.fields("asset").text("version")
        if not version.startswith("2."):
            raise FormatError(
                f"{self.path}: glTF version {version[:20]!r}, only 2.0 is read; convert it first"
            )
        for name in self.root.texts("extensionsRequired"):
            if name in _COMPRESSED:
                raise FormatError(_compressed_message(self.path, _COMPRESSED[name]))
            if name not in _READ and not name.startswith(_HARMLESS):
                raise FormatError(
                    f"{self.path}: needs the extension {name[:60]!r}, which is not read; "
                    "export the file without it"
                )


def _compressed_message(path: Path, method: str) -> str:
    return (
        f"{path}: the geometry is compressed with {method}, which is not read; export it without "
        "compression"
    )


def open_document(path: str | Path) -> Document:
    """Read a ``.glb`` or ``.gltf`` file; the first bytes decide which it is.

    Raises
    ------
    FormatError
        If the container or its JSON is malformed, or needs what is not read here.
    """
    path = Path(path)
    data = read_bytes_limited(path, limit=_LIMIT)
    if not data.startswith(_MAGIC):
        return Document(path, parse_json(data, str(path)), b"")
    chunks = _chunks(data, path)
    return Document(path, parse_json(chunks[_JSON_CHUNK], str(path)), chunks[_BINARY_CHUNK])


def _chunks(data: bytes, path: Path) -> dict[bytes, bytes]:
    if len(data) < 20:
        raise FormatError(f"{path}: {len(data)} bytes are too few for a GLB; is it cut off?")
    version, length = struct.unpack_from("<II", data, 4)
    if version != 2:
        raise FormatError(f"{path}: GLB version {version}, only 2 is read; convert it first")
    if length > len(data):
        raise FormatError(f"{path}: holds {len(data)} of {length} bytes; the file is cut off")
    chunks: dict[bytes, bytes] = {}
    offset = 12
    while offset + 8 <= length:
        size, kind = struct.unpack_from("<I4s", data, offset)
        if offset + 8 + size > length:
            raise FormatError(f"{path}: the chunk at byte {offset} reaches past the end")
        chunks.setdefault(kind, data[offset + 8 : offset + 8 + size])
        offset += 8 + size
    if _JSON_CHUNK not in chunks:
        raise FormatError(f"{path}: has no JSON chunk; this is no GLB of version 2")
    return {_BINARY_CHUNK: b"", **chunks}


def optional_index(fields: Fields, key: str) -> int | None:
    """Return the index in `key`, or None where it is absent."""
    return fields.integer(key) if key in fields else None
