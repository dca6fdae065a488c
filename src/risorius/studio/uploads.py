"""Files that a person drops on the page: kept beside the project, never over another file."""

from __future__ import annotations

from collections.abc import Generator, Iterable
from contextlib import contextmanager
from pathlib import Path

from risorius.errors import RisoriusError
from risorius.io.atomic import write_bytes
from risorius.studio.guard import inside

__all__ = ["keep_upload", "trying_upload"]


def keep_upload(folder: Path, name: str, data: bytes, *, endings: Iterable[str]) -> Path:
    """Write an upload into `folder`; return where.

    A file of that name with other content stays; the upload gets a number behind its name.

    Raises
    ------
    ParameterError
        If `name` is no plain file name with one of `endings`.
    FormatError
        If it cannot be written.
    """
    known = tuple(endings)
    path = inside(folder, name, endings=known)
    stem, dot, rest = name.partition(".")
    count = 1
    while path.exists():
        if path.is_file() and path.read_bytes() == data:
            return path
        count += 1
        path = inside(folder, f"{stem}-{count}{dot}{rest}", endings=known)
    write_bytes(path, data)
    return path


@contextmanager
def trying_upload(
    folder: Path, name: str, data: bytes, *, endings: Iterable[str]
) -> Generator[Path]:
    """Keep an upload as `keep_upload` does, but not where what is done with it refuses it."""
    known = set(folder.iterdir())
    path = keep_upload(folder, name, data, endings=endings)
    try:
        yield path
    except RisoriusError:
        if path not in known:
            path.unlink(missing_ok=True)
        raise
