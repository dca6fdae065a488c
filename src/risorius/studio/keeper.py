"""The file of a project: one owner at a time, never lost, never overwritten unseen."""

from __future__ import annotations

import os
from io import TextIOWrapper
from pathlib import Path

from risorius.errors import FormatError
from risorius.io.atomic import write_bytes
from risorius.project import Project, read_project

__all__ = ["Keeper"]


class Keeper:
    """Holds a project file while the studio is open.

    A lock file beside it names the process; the system lets go of it when the process ends,
    however it ends. What another program wrote meanwhile is never replaced: the work goes on in a
    new file beside it.

    Parameters
    ----------
    path : Path
        Of the project; need not exist yet.
    lock : file
        The locked file.
    """

    def __init__(self, path: Path, lock: TextIOWrapper) -> None:
        self.path = path
        self._lock = lock
        self._last: bytes | None = path.read_bytes() if path.is_file() else None
        self.moved_from: Path | None = None

    @staticmethod
    def take(path: Path) -> Keeper:
        """Lock a project file.

        Raises
        ------
        FormatError
            If another studio has it open, its folder is missing, or it is no text file by name.
        """
        path = Path(os.path.abspath(path))  # noqa: PTH100 - links stay links
        if path.suffix.lower() != ".json":
            raise FormatError(f"{path}: a project is a text file; give a name that ends in .json")
        if not path.parent.is_dir():
            raise FormatError(f"{path}: the folder {path.parent} does not exist; create it first")
        place = path.with_name(f".{path.name}.lock")
        try:
            lock = place.open("a+", encoding="utf-8")
        except OSError as error:
            raise FormatError(f"{place}: cannot be written ({error.strerror})") from error
        if not _locked(lock):
            lock.seek(0)
            owner = lock.read(200).strip() or "unknown"
            lock.close()
            raise FormatError(
                f"{path}: is open in another studio (process {owner}); use its window, close it "
                "first, or open a copy"
            )
        lock.truncate(0)
        lock.write(str(os.getpid()))
        lock.flush()
        return Keeper(path, lock)

    @property
    def folder(self) -> Path:
        """The folder that everything is written below."""
        return self.path.parent

    def read(self) -> Project | None:
        """Return the project; None where the file does not exist yet.

        Raises
        ------
        FormatError
            If it is malformed.
        """
        return read_project(self.path) if self.path.is_file() else None

    @property
    def content(self) -> bytes | None:
        """What the file held when it was read or written last; None where there is none."""
        return self._last

    def settle(self) -> bool:
        """Find the place that the next state goes to; tell whether it is another one.

        Where somebody else has changed the file since, it is left alone and the project goes to
        a free name, `path` from then on; `moved_from` remembers the old one.
        """
        found = self.path.read_bytes() if self.path.is_file() else None
        if found is None or found == self._last:
            return False
        self.moved_from = self.path
        self.path = _free(self.path)
        return True

    def write(self, content: bytes) -> None:
        """Write the project as a whole or not at all, to where `settle` found that it goes.

        Raises
        ------
        FormatError
            If it cannot be written.
        """
        write_bytes(self.path, content)
        self._last = content

    def release(self) -> None:
        """Let go of the file."""
        place = Path(self._lock.name)
        if not self._lock.closed:
            self._lock.close()
        place.unlink(missing_ok=True)


def _free(path: Path) -> Path:
    count = 2
    while (name := path.with_name(f"{path.stem}.{count}{path.suffix}")).exists():
        count += 1
    return name


def _locked(file: TextIOWrapper) -> bool:
    """Lock an open file without waiting; tell whether it worked."""
    try:
        if os.name == "nt":  # pragma: no cover
            import msvcrt

            msvcrt.locking(file.fileno(), msvcrt.LK_NBLCK, 1)  # pyright: ignore
        else:
            import fcntl

            fcntl.flock(file.fileno(), fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        return False
    return True
