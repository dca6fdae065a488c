"""Write files and folders so that they are complete or not there at all."""

from __future__ import annotations

import json
import os
import secrets
import shutil
from collections.abc import Generator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from risorius.errors import FormatError

__all__ = ["atomic_folder", "atomic_write", "write_bytes", "write_json"]


@contextmanager
def atomic_write(path: str | Path) -> Generator[Path]:
    """Give a temporary path beside `path`; move what was written there into place at the end.

    On any error, and on an interruption, the temporary file is removed and an old file at `path`
    stays as it was. Links are followed, so that the file behind a link is replaced.

    Parameters
    ----------
    path : path
        Where the file shall be.

    Yields
    ------
    Path
        A name in the same folder with the same ending; the caller creates the file.

    Raises
    ------
    FormatError
        If the folder is missing, `path` is a folder, or the system refuses to write.
    """
    path = Path(path)
    goal = Path(os.path.realpath(path))
    _require_parent(path, goal)
    if goal.is_dir():
        raise FormatError(f"{path}: is a folder, cannot write a file there; give a file name")
    temporary = _temporary_name(goal)
    try:
        yield temporary
        _flush_to_disk(temporary)
        if goal.exists():
            shutil.copymode(goal, temporary)
        temporary.replace(goal)
    except OSError as error:
        raise _refused(path, error) from error
    finally:
        temporary.unlink(missing_ok=True)


@contextmanager
def atomic_folder(path: str | Path) -> Generator[Path]:
    """Give an empty temporary folder beside `path`; move it into place at the end.

    A folder that is already at `path` is removed only after the new one has taken its place, so
    the caller decides beforehand whether it may go. On an error nothing changes.

    Raises
    ------
    FormatError
        If the parent is missing, `path` is a file, or the system refuses to write.
    """
    path = Path(path)
    goal = Path(os.path.realpath(path))
    _require_parent(path, goal)
    if goal.exists() and not goal.is_dir():
        raise FormatError(f"{path}: is a file, cannot write a folder there; remove it first")
    temporary, old = _temporary_name(goal), _temporary_name(goal)
    try:
        temporary.mkdir()
        yield temporary
        for file in sorted(temporary.iterdir()):
            _flush_to_disk(file)
        if goal.exists():
            goal.rename(old)
        try:
            temporary.rename(goal)
        except OSError:
            if old.exists():
                old.rename(goal)
            raise
    except OSError as error:
        raise _refused(path, error) from error
    finally:
        shutil.rmtree(temporary, ignore_errors=True)
        if goal.exists():
            shutil.rmtree(old, ignore_errors=True)


def write_bytes(path: str | Path, data: bytes) -> None:
    """Write `data` to `path` as a whole or not at all (see `atomic_write`)."""
    with atomic_write(path) as temporary:
        temporary.write_bytes(data)


def write_json(path: str | Path, document: Mapping[str, Any]) -> None:
    """Write `document` as JSON that people read, as a whole or not at all."""
    text = json.dumps(document, indent=1, ensure_ascii=False, allow_nan=False)
    write_bytes(path, f"{text}\n".encode())


def _require_parent(path: Path, goal: Path) -> None:
    if not path.name:
        raise FormatError(f"{path}: is no file name; give one")
    if not goal.parent.is_dir():
        raise FormatError(f"{path}: the folder {path.parent} does not exist; create it first")


def _temporary_name(goal: Path) -> Path:
    # Long names are cut: most file systems end at 255 bytes.
    stem = goal.stem.encode()[:100].decode(errors="ignore")
    return goal.with_name(f".{stem}.{secrets.token_hex(4)}.tmp{goal.suffix[:20]}")


def _flush_to_disk(file: Path) -> None:
    descriptor = os.open(file, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


def _refused(path: Path, error: OSError) -> FormatError:
    return FormatError(f"{path}: cannot be written ({error.strerror or error})")
