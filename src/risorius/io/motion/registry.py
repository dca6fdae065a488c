"""Which ending of a stream is read and written by whom."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from risorius.controls.stream import Stream
from risorius.errors import FormatError
from risorius.io.motion.fap import read_fap, write_fap
from risorius.io.motion.text_lines import refuse_binary_stream
from risorius.io.motion.weights_csv import read_weights_csv, write_weights_csv
from risorius.io.motion.weights_json import read_weights_json, write_weights_json

__all__ = ["read_stream", "stream_endings", "write_stream"]

Reader = Callable[[Path], Stream]
Writer = Callable[[Stream, Path], int]

_FORMATS: dict[str, tuple[Reader, Writer]] = {
    ".fap": (read_fap, write_fap),
    ".csv": (read_weights_csv, write_weights_csv),
    ".json": (read_weights_json, write_weights_json),
}


def stream_endings() -> tuple[str, ...]:
    """Return the endings of streams."""
    return tuple(_FORMATS)


def read_stream(path: str | Path) -> Stream:
    """Open a stream; the ending of `path` says what it is.

    Raises
    ------
    FormatError
        If the ending is unknown or the file is malformed.
    """
    path = Path(path)
    if path.suffix.lower() not in _FORMATS and path.is_file():
        refuse_binary_stream(path, text_expected=False)
    return _of(path)[0](path)


def write_stream(stream: Stream, path: str | Path) -> int:
    """Write a stream and return the number of its frames.

    Raises
    ------
    FormatError
        If the ending is unknown or the file cannot be written.
    """
    return _of(Path(path))[1](stream, Path(path))


def _of(path: Path) -> tuple[Reader, Writer]:
    known = _FORMATS.get(path.suffix.lower())
    if known is None:
        raise FormatError(
            f"{path}: {path.suffix or '(none)'!r} is no ending of a stream; known: "
            f"{' '.join(_FORMATS)}"
        )
    return known
