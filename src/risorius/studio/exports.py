"""Files that leave the studio, all in the folder of the project."""

from __future__ import annotations

import tempfile
import zipfile
from pathlib import Path

from risorius.errors import FormatError
from risorius.io.atomic import atomic_write
from risorius.io.gltf.write import write_glb
from risorius.rig.rig import Rig
from risorius.studio.guard import inside
from risorius.studio.jobs import Job

__all__ = ["KINDS", "export_rig"]

KINDS = (".glb", ".usdc", ".usda", ".npz", ".zip")
"""Endings of rigs; a zip holds a folder of OBJ files."""


def export_rig(
    rig: Rig, folder: Path, name: str, job: Job, *, animation: bool = False, metres: bool = False
) -> Path:
    """Write a rig into `folder` and return where.

    Parameters
    ----------
    rig : Rig
    folder : Path
    name : str
        A plain file name with one of `KINDS`.
    job : Job
    animation : bool
        Add an animation that shows every shape, where the format can hold one.
    metres : bool
        Let a GLB appear in metres.

    Raises
    ------
    ParameterError
        If the name is not plain.
    FormatError
        If the file cannot be written.
    ImportError
        If the format needs an extra that is not installed.
    """
    path = inside(folder, name, endings=KINDS)
    job.step("write")
    ending = path.suffix.lower()
    if ending == ".glb":
        write_glb(rig, path, animation=animation, metres=metres)
    elif ending.startswith(".usd"):
        from risorius.io.usd import write_usd

        write_usd(rig, path, animation=animation)
    elif ending == ".npz":
        rig.save(path)
    else:
        _write_zip(rig, path)
    return path


def _write_zip(rig: Rig, path: Path) -> None:
    from risorius.io.obj_folder import write_obj_folder

    with tempfile.TemporaryDirectory() as place, atomic_write(path) as temporary:
        shapes = Path(place) / "shapes"
        write_obj_folder(rig, shapes)
        try:
            with zipfile.ZipFile(temporary, "w", zipfile.ZIP_DEFLATED) as archive:
                for file in sorted(shapes.iterdir()):
                    entry = zipfile.ZipInfo(file.name, (1980, 1, 1, 0, 0, 0))
                    entry.compress_type = zipfile.ZIP_DEFLATED
                    archive.writestr(entry, file.read_bytes())
        except OSError as error:
            raise FormatError(f"{path}: cannot be written ({error.strerror})") from error
