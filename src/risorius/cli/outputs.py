"""Where results go: checked before the work begins, written whole or not at all."""

from __future__ import annotations

import os
from importlib.util import find_spec
from pathlib import Path

from risorius._formats import formats
from risorius.errors import FormatError
from risorius.rig.rig import Rig

__all__ = [
    "is_folder_output",
    "make_folder",
    "require_json_output",
    "require_picture_output",
    "require_rig_output",
    "write_rig",
]

_USD = ".usd"


def require_rig_output(text: str) -> Path:
    """Return the path of a rig that can be written there.

    Raises
    ------
    FormatError
        If the ending is unknown, or the folder is missing or not writable.
    ImportError
        If the ending needs an extra that is not installed.
    """
    path = Path(text)
    if is_folder_output(text):
        _require_writable_folder(path)
        if path.exists() and not path.is_dir():
            raise FormatError(f"{path}: is a file, a folder of OBJ files cannot be written there")
        if path.suffix and not path.is_dir():
            raise FormatError(
                f"{path}: a new folder of OBJ files has a name without ending; leave out "
                f"{path.suffix!r}, or make the folder first"
            )
        return path
    ending = path.suffix.lower()
    if ending == ".obj":
        raise FormatError(
            f"{path}: an OBJ file holds one shape only; give a folder, such as {path.stem}/"
        )
    known = _rig_endings()
    if ending not in known:
        raise FormatError(
            f"{path}: cannot write a rig with the ending {ending!r}; known: "
            f"{' '.join(known)}, or a folder for OBJ files"
        )
    if ending.startswith(_USD) and find_spec("pxr") is None:
        raise ImportError(f"{path}: USD needs an extra; pip install risorius[usd]")
    _require_writable_file(path)
    return path


def require_picture_output(path: Path) -> Path:
    """Return `path` if a PNG file can be written there.

    Raises
    ------
    FormatError
        If the ending is not ``.png``, or the folder is missing or not writable.
    """
    if path.suffix.lower() != ".png":
        raise FormatError(f"{path}: pictures are PNG files; give a name that ends in .png")
    _require_writable_file(path)
    return path


def require_json_output(path: Path) -> Path:
    """Return `path` if a recipe can be written there.

    Raises
    ------
    FormatError
        If the ending is not ``.json``, or the folder is missing or not writable.
    """
    if path.suffix.lower() != ".json":
        raise FormatError(f"{path}: a recipe is a text file; give a name that ends in .json")
    _require_writable_file(path)
    return path


def make_folder(path: Path) -> None:
    """Make a folder for results, unless it is there.

    Raises
    ------
    FormatError
        If it is a file, or its own folder is missing or not writable.
    """
    if path.is_dir():
        return
    if path.exists():
        raise FormatError(f"{path}: is a file, a folder was expected; choose another name")
    _require_writable_folder(path)
    path.mkdir()


def is_folder_output(text: str) -> bool:
    """Return whether an output path means a folder of OBJ files."""
    return text.endswith(("/", os.sep)) or not Path(text).suffix or Path(text).is_dir()


def write_rig(rig: Rig, path: Path, *, animation: bool = False, metres: bool = False) -> None:
    """Write a rig to a path that `require_rig_output` returned.

    Parameters
    ----------
    rig : Rig
    path : Path
    animation : bool
        Add an animation of all shapes, in formats that can hold one.
    metres : bool
        Add a node that turns the head to metres, in a GLB.

    Raises
    ------
    FormatError
        If it cannot be written.
    """
    ending = path.suffix.lower()
    if is_folder_output(str(path)):
        from risorius.io.obj_folder import write_obj_folder

        write_obj_folder(rig, path)
    elif ending == ".glb":
        from risorius.io.gltf import write_glb

        write_glb(rig, path, animation=animation, metres=metres)
    elif ending.startswith(_USD):
        from risorius.io.usd import write_usd

        write_usd(rig, path, animation=animation)
    else:
        rig.save(path)


def _rig_endings() -> list[str]:
    """Return the endings of a rig in one file."""
    endings = {ending for each in formats() if each.write_rig for ending in each.endings}
    return sorted(endings - {".obj"})


def _require_writable_file(path: Path) -> None:
    if path.is_dir():
        raise FormatError(f"{path}: is a folder, cannot write a file there; give a file name")
    _require_writable_folder(path)


def _require_writable_folder(path: Path) -> None:
    """Refuse a place whose parent folder is missing or not writable."""
    parent = path.parent
    if not parent.is_dir():
        raise FormatError(f"{path}: the folder {parent} does not exist; create it first")
    if not os.access(parent, os.W_OK | os.X_OK):
        raise FormatError(f"{path}: the folder {parent} is not writable; choose another one")
