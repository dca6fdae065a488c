"""Read files of unknown origin in bounded memory: raw bytes and JSON."""

from __future__ import annotations

import json
import os
import stat
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NoReturn, cast

from risorius.errors import FormatError

__all__ = ["MEGABYTE", "check_schema", "parse_json", "read_bytes_limited", "read_json"]

MEGABYTE = 1 << 20
_DIGITS = 300  # longest number a JSON file may hold; the largest float64 has 309 digits


def read_bytes_limited(path: str | Path, *, limit: int = 512 * MEGABYTE) -> bytes:
    """Return the content of a regular file of at most `limit` bytes.

    Raises
    ------
    FormatError
        If the file is missing, a folder or a device, too large or not readable.
    """
    path = Path(path)
    try:
        with path.open("rb") as file:
            status = os.fstat(file.fileno())
            if not stat.S_ISREG(status.st_mode):
                raise FormatError(f"{path}: is not a regular file")
            if status.st_size > limit:
                raise FormatError(
                    f"{path}: larger than {limit // MEGABYTE} MB, the limit for this format"
                )
            # Reading up to the limit would set that much memory aside first.
            return file.read(status.st_size)
    except IsADirectoryError:
        raise FormatError(f"{path}: is a folder, a file was expected") from None
    except FileNotFoundError:
        raise FormatError(f"{path}: no such file; check its name and its folder") from None
    except (OSError, ValueError) as error:
        raise FormatError(f"{path}: cannot be read ({error})") from error


def read_json(
    path: str | Path,
    *,
    schema: str | None = None,
    version: int = 1,
    limit: int = 64 * MEGABYTE,
) -> dict[str, Any]:
    """Read a JSON file whose top level is an object.

    Parameters
    ----------
    path : path
    schema : str, optional
        What ``"schema"`` must say, for example ``"risorius/landmarks"``.
    version : int
        Newest version of the schema that the caller understands.
    limit : int
        Largest size of the file [bytes].

    Raises
    ------
    FormatError
        On malformed JSON (line and column are named), doubled keys, NaN, numbers beyond float64,
        nesting bombs, another schema or a newer version.
    """
    where = str(path)
    document = parse_json(read_bytes_limited(path, limit=limit), where)
    if not isinstance(document, dict):
        raise FormatError(f"{where}: expected a JSON object, found {_kind(document)}")
    result = cast("dict[str, Any]", document)
    if schema is not None:
        check_schema(result, where, schema=schema, version=version)
    return result


def check_schema(document: Mapping[str, Any], where: str, *, schema: str, version: int) -> None:
    """Refuse a document of another schema or of a newer version."""
    found = document.get("schema")
    if found != schema:
        raise FormatError(f'{where}: expected "schema": "{schema}", found {_short(found)}')
    number = document.get("version")
    if not isinstance(number, int) or isinstance(number, bool) or number < 1:
        raise FormatError(f'{where}: "version" must be a whole number from 1, not {_short(number)}')
    if number > version:
        raise FormatError(
            f"{where}: written in version {_short(number)} of {schema}, this risorius reads up to "
            f"version {version}; update risorius"
        )


def parse_json(data: bytes, where: str) -> Any:
    """Parse UTF-8 JSON strictly; `where` opens every message.

    Raises
    ------
    FormatError
        As `read_json`.
    """
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise FormatError(f"{where}: byte {error.start} is not UTF-8; save it as UTF-8") from None

    def number(digits: str) -> float:
        value = float(digits)
        if value in (float("inf"), float("-inf")):
            raise FormatError(f"{where}: the number {_short(digits)} is too large")
        return value

    def whole(digits: str) -> int:
        if len(digits) > _DIGITS:
            raise FormatError(f"{where}: a number has {len(digits)} digits")
        return int(digits)

    def constant(name: str) -> NoReturn:
        raise FormatError(f"{where}: {name} is not JSON; every number must be finite")

    def unique(pairs: Sequence[tuple[str, Any]]) -> dict[str, Any]:
        result = dict(pairs)
        if len(result) < len(pairs):
            keys = [key for key, _ in pairs]
            twice = next(key for key in keys if keys.count(key) > 1)
            raise FormatError(f"{where}: {_short(twice)} is given twice; keep one of them")
        return result

    try:
        return json.loads(
            text,
            parse_float=number,
            parse_int=whole,
            parse_constant=constant,
            object_pairs_hook=unique,
        )
    except json.JSONDecodeError as error:
        raise FormatError(
            f"{where}: line {error.lineno}, column {error.colno}: {error.msg}"
        ) from None
    except RecursionError:
        raise FormatError(f"{where}: nested too deeply to be sensible JSON") from None


def _kind(value: object) -> str:
    if value is None:
        return "null"
    names: dict[type, str] = {list: "a list", str: "a text", bool: "true or false", dict: "object"}
    return names.get(type(value), "a number")


def _short(value: object, *, length: int = 60) -> str:
    """Return `value` as it stands in the file, cut to a length that fits a message."""
    text = json.dumps(value) if value is None or isinstance(value, str | int) else _kind(value)
    return text if len(text) <= length else f"{text[:length]}..."
