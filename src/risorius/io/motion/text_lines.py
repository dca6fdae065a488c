"""Lines of a text file of unknown origin, one at a time and of bounded length."""

from __future__ import annotations

import os
import stat
from collections.abc import Iterator
from pathlib import Path

from risorius.errors import FormatError

__all__ = ["LONGEST_LINE", "bounded_lines", "parse_number", "refuse_binary_stream"]

LONGEST_LINE = 1 << 16
_LARGEST = 1e12
_MOST_DIGITS = 40
_START = 512
_START_CODE = b"\0\0\1"


def bounded_lines(path: Path) -> Iterator[tuple[int, str]]:
    """Go through a UTF-8 file: (number from 1, line without its end).

    Raises
    ------
    FormatError
        If the file is missing, no regular file, not text, or has a line beyond `LONGEST_LINE`.
    """
    try:
        with path.open("rb") as file:
            if not stat.S_ISREG(os.fstat(file.fileno()).st_mode):
                raise FormatError(f"{path}: is not a regular file")
            number = 0
            while line := file.readline(LONGEST_LINE + 1):
                number += 1
                if len(line) > LONGEST_LINE:
                    raise FormatError(f"{path}: line {number} is longer than {LONGEST_LINE} bytes")
                yield number, _decoded(line, f"{path}: line {number}")
    except IsADirectoryError:
        raise FormatError(f"{path}: is a folder, a file was expected") from None
    except FileNotFoundError:
        raise FormatError(f"{path}: no such file; check its name and its folder") from None
    except OSError as error:
        raise FormatError(f"{path}: cannot be read ({error})") from error


def _decoded(line: bytes, where: str) -> str:
    try:
        text = line.decode("utf-8-sig")
    except UnicodeDecodeError:
        text = line.decode("latin-1")
    if "\0" in text:
        raise FormatError(f"{where}: is not text; is this a binary file?")
    return text.rstrip("\r\n")


def parse_number(text: str, where: str) -> float:
    """Return a finite number of sane size; `where` opens the message."""
    try:
        value = float(text) if len(text) <= _MOST_DIGITS else float("nan")
    except ValueError:
        value = float("nan")
    if not abs(value) <= _LARGEST:
        raise FormatError(f"{where}: {text[:40]!r} is no number within {_LARGEST:g}")
    return value


def refuse_binary_stream(path: Path, *, text_expected: bool) -> None:
    """Refuse a file that looks like a coded stream of MPEG-4 (FBA).

    Coded streams open with a start code, two bytes of zero and a one. Where text is expected any
    zero among the first bytes tells enough.

    Raises
    ------
    FormatError
        If it does.
    """
    try:
        with path.open("rb") as file:
            start = file.read(_START)
    except OSError:
        return  # said better by the reader of lines
    if start.startswith(_START_CODE) or (text_expected and b"\0" in start):
        raise FormatError(
            f"{path}: is a binary stream (MPEG-4 FBA), only text streams of version 2.1 are read; "
            "convert it with the tool that made it"
        )
