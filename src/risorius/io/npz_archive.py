"""Read arrays out of NumPy archives of unknown origin: no pickles, no bombs."""

from __future__ import annotations

import io
import math
import re
import struct
import zipfile
import zlib
from collections.abc import Generator, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import IO, Any

import numpy as np
import numpy.typing as npt

from risorius._check import FloatArray, IntArray
from risorius.errors import FormatError
from risorius.io.bounded import MEGABYTE, read_bytes_limited
from risorius.io.finite import as_doubles, require_finite

__all__ = ["Archive"]

_LIMIT = 512 * MEGABYTE
_UNPACKED_LIMIT = 2048 * MEGABYTE
_MAGIC = b"\x93NUMPY\x01\x00"
_HEADER = re.compile(
    rb"\{'descr': '([<|](?:f[248]|[iu][1248]|U[1-9]\d{0,8}))', 'fortran_order': False, "
    rb"'shape': \(((?:\d{1,18}, ?)*(?:\d{1,18})?)\), \}\s*"
)
# Everything that the standard library raises on broken archives.
_BROKEN = (
    zipfile.BadZipFile,
    zlib.error,
    struct.error,
    EOFError,
    ValueError,
    OverflowError,
    NotImplementedError,
    RuntimeError,
    OSError,
)


class Archive:
    """A NumPy archive in memory.

    Parameters
    ----------
    path : path

    Raises
    ------
    FormatError
        If it is no archive or would unpack to more than 2 GB.
    """

    def __init__(self, path: str | Path) -> None:
        self.path = Path(path)
        data = read_bytes_limited(path, limit=_LIMIT)
        with self._refusing(""):
            self._zip = zipfile.ZipFile(io.BytesIO(data))
            entries = self._zip.infolist()
        self._entries = {entry.filename: entry for entry in entries}
        if sum(entry.file_size for entry in entries) > _UNPACKED_LIMIT:
            raise FormatError(f"{path}: unpacks to more than {_UNPACKED_LIMIT // MEGABYTE} MB")

    def __contains__(self, name: str) -> bool:
        """Return whether there is an array of this name."""
        return f"{name}.npy" in self._entries

    def text(self, name: str) -> str:
        """Return a single text."""
        with self._open(name) as (file, dtype, shape):
            return self._texts(name, file.read(), dtype, shape, 0)[0]

    def texts(self, name: str) -> list[str]:
        """Return texts (k,)."""
        with self._open(name) as (file, dtype, shape):
            return self._texts(name, file.read(), dtype, shape, 1)

    def _texts(
        self, name: str, data: bytes, dtype: np.dtype[Any], shape: tuple[int, ...], dimensions: int
    ) -> list[str]:
        if dtype.kind != "U" or len(shape) != dimensions:
            raise self._unexpected(name, dtype, shape)
        size = dtype.itemsize
        return [
            data[size * row : size * (row + 1)].decode("utf-32-le").rstrip("\0")
            for row in range(math.prod(shape))
        ]

    def floats(self, name: str, width: int) -> FloatArray:
        """Return finite numbers (k, width)."""
        values = as_doubles(self._array(name, "f", 2))
        if values.shape[1] != width:
            raise FormatError(f"{self.path}: {name}: expected {width} columns")
        require_finite(values, f"{self.path}: {name}")
        return values

    def integers(self, name: str, *, high: int) -> IntArray:
        """Return whole numbers (k,) in -1..high; -1 stands for none and is judged later."""
        values = self._array(name, "iu", 1)
        if len(values) and (values.min() < -1 or values.max() > high):
            raise FormatError(f"{self.path}: {name}: numbers must lie in -1..{high}")
        return values.astype(np.int32)

    def rows(self, name: str, shape: tuple[int, ...]) -> Iterator[FloatArray]:
        """Yield the float64 entries (...) of an array (k, ...) of `shape` one by one."""
        with self._open(name) as (file, dtype, found):
            if found != shape or dtype.kind != "f":
                raise FormatError(f"{self.path}: {name}: expected numbers of shape {shape}")
            size = math.prod(shape[1:]) * dtype.itemsize
            for index in range(shape[0]):
                row = np.frombuffer(file.read(size), dtype).reshape(shape[1:])
                values = as_doubles(row)
                require_finite(values, f"{self.path}: {name}[{index}]")
                yield values

    def _array(self, name: str, kinds: str, dimensions: int) -> npt.NDArray[Any]:
        with self._open(name) as (file, dtype, shape):
            if dtype.kind not in kinds or len(shape) != dimensions:
                raise self._unexpected(name, dtype, shape)
            return np.frombuffer(file.read(), dtype).reshape(shape)

    def _unexpected(self, name: str, dtype: np.dtype[Any], shape: tuple[int, ...]) -> FormatError:
        return FormatError(
            f"{self.path}: {name}: holds {dtype} of shape {shape}, which is not expected"
        )

    @contextmanager
    def _open(self, name: str) -> Generator[tuple[IO[bytes], np.dtype[Any], tuple[int, ...]]]:
        entry = self._entries.get(f"{name}.npy")
        if entry is None:
            raise FormatError(f"{self.path}: has no array {name!r}; is it a rig of risorius?")
        if entry.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
            raise FormatError(f"{self.path}: {name}: compressed in a way that is not read")
        with self._refusing(name), self._zip.open(entry) as file:
            start = file.read(10)
            length = int.from_bytes(start[8:], "little")
            header = _HEADER.fullmatch(file.read(length))
            if not start.startswith(_MAGIC) or header is None:
                raise FormatError(f"{self.path}: {name}: has no plain array header")
            dtype = np.dtype(header[1].decode())
            shape = tuple(int(number) for number in header[2].replace(b",", b" ").split())
            if math.prod(shape) * dtype.itemsize != entry.file_size - 10 - length:
                raise FormatError(
                    f"{self.path}: {name}: {entry.file_size} bytes do not hold an array of {shape}"
                )
            yield file, dtype, shape

    @contextmanager
    def _refusing(self, name: str) -> Generator[None]:
        try:
            yield
        except _BROKEN as error:
            place = f"{name}: " if name else ""
            raise FormatError(f"{self.path}: {place}broken archive ({error})") from error
