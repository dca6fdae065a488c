"""Registry of file formats by ending; `risorius.io` fills it, everything else asks it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import Any

from risorius.errors import FormatError

__all__ = [
    "Format",
    "formats",
    "load_on_demand",
    "read_head",
    "read_landmarks",
    "read_rig",
    "register",
    "write_rig",
]

# The types belong to stations below this one: (PolygonMesh, {name: LandmarkSpec}) and Rig.
ReadHead = Callable[[Path], tuple[Any, Mapping[str, Any]]]
ReadRig = Callable[[Path], Any]
WriteRig = Callable[[Any, Path], None]
ReadLandmarks = Callable[[Path], Mapping[str, Any]]


@dataclass(frozen=True)
class Format:
    """One file format: its endings and what can be read and written.

    `read_folder` takes a folder, whatever its name ends in.
    """

    name: str
    endings: tuple[str, ...]
    read_head: ReadHead | None = None
    read_rig: ReadRig | None = None
    write_rig: WriteRig | None = None
    read_landmarks: ReadLandmarks | None = None
    read_folder: ReadRig | None = None


_FORMATS: list[Format] = []
_ON_DEMAND: list[str] = []


def load_on_demand(module: str) -> None:
    """Name a module whose import registers formats; it is imported at the first question."""
    _ON_DEMAND.append(module)


def register(file_format: Format) -> None:
    """Add a format; called once by each module of `risorius.io`."""
    _FORMATS.append(file_format)


def formats() -> tuple[Format, ...]:
    """Return all registered formats."""
    for module in _ON_DEMAND:
        import_module(module)
    return tuple(_FORMATS)


def _find(path: Path, verb: str) -> Any:
    ending = path.suffix.lower()
    known: list[str] = []
    for file_format in formats():
        function = getattr(file_format, verb)
        if function is None:
            continue
        if ending in file_format.endings:
            return function
        known.extend(file_format.endings)
    action, _, thing = verb.partition("_")
    thing = thing if thing == "landmarks" else f"a {thing}"
    raise FormatError(
        f"{path}: cannot {action} {thing} with the ending {ending or '(none)'!r}; "
        f"known: {' '.join(sorted(set(known)))}"
    )


def _existing(path: Path) -> Path:
    if path.is_dir():
        raise FormatError(f"{path}: is a folder, a file was expected")
    if not path.exists():
        raise FormatError(f"{path}: no such file; check its name and its folder")
    return path


def read_head(path: Path) -> tuple[Any, Mapping[str, Any]]:
    """Read a mesh and the landmarks it carries: ``(PolygonMesh, {name: LandmarkSpec})``."""
    return _find(path, "read_head")(_existing(path))


def read_rig(path: Path) -> Any:
    """Read a `Rig` from a file or a folder of files."""
    if path.is_dir():
        readers = (file_format.read_folder for file_format in formats())
        return next(reader for reader in readers if reader is not None)(path)
    return _find(path, "read_rig")(_existing(path))


def write_rig(rig: Any, path: Path) -> None:
    """Write a `Rig`; an existing file is replaced only by a complete one."""
    _find(path, "write_rig")(rig, path)


def read_landmarks(path: Path) -> Mapping[str, Any]:
    """Read landmarks: ``{name: LandmarkSpec}``."""
    return _find(path, "read_landmarks")(_existing(path))
