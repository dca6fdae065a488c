"""A rig as a folder: ``neutral.obj``, one OBJ file per shape, and ``rig.json`` beside them."""

from __future__ import annotations

import json
import re
import warnings
from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path

from risorius._formats import Format, register
from risorius.errors import FormatError, RisoriusWarning
from risorius.head.frame import Frame
from risorius.io.atomic import atomic_folder
from risorius.io.bounded import read_json
from risorius.io.json_fields import Fields
from risorius.io.obj import read_obj, read_obj_positions
from risorius.io.obj_text import ObjText
from risorius.io.rig_json import rig_info, rig_to_json, runs_from_json, runs_to_json
from risorius.mesh.polygon_mesh import PolygonMesh
from risorius.rig.rig import MorphTarget, Rig

__all__ = ["read_obj_folder", "write_obj_folder"]

_NEUTRAL = "neutral.obj"
_TABLE = "rig.json"
_OTHER_NEUTRALS = ("base.obj", "basis.obj", "rest.obj")
_UNSAFE = re.compile(r"[^\w.+-]+", re.ASCII)


def write_obj_folder(rig: Rig, path: str | Path) -> None:
    """Write a rig as a folder of OBJ files; every file is a whole head.

    Raises
    ------
    FormatError
        If a folder of that name holds anything but an older rig, or cannot be written.
    """
    path = Path(path)
    _require_replaceable(path)
    text = ObjText(rig.mesh)
    files = _file_names(rig.names)
    table = {
        **rig_to_json(rig),
        "neutral": _NEUTRAL,
        "shapes": files,
        "part_of_vertex": runs_to_json(rig.part_of_vertex),
    }
    with atomic_folder(path) as folder:
        (folder / _NEUTRAL).write_bytes(text.neutral())
        for target in rig.targets:
            positions = rig.mesh.positions[target.vertices] + target.deltas
            (folder / files[target.name]).write_bytes(text.shape(target.vertices, positions))
        document = json.dumps(table, indent=1, ensure_ascii=False, allow_nan=False)
        (folder / _TABLE).write_text(document + "\n", encoding="utf-8", newline="\n")


def read_obj_folder(path: str | Path) -> Rig:
    """Read a folder of OBJ files of one topology.

    Without ``rig.json``, ``neutral.obj`` (or base, basis, rest) is the neutral and every other
    OBJ file a shape named like the file.

    Raises
    ------
    FormatError
        If a file is missing or malformed, or a shape has another number of vertices.
    """
    path = Path(path)
    if not path.is_dir():
        raise FormatError(f"{path}: a folder of OBJ files was expected")
    if not (path / _TABLE).exists():
        mesh, files = _foreign(path)
        frame = Frame.canonical()
        return Rig(mesh, tuple(_target(mesh, name, file) for name, file in files), frame=frame)
    where = str(path / _TABLE)
    fields = Fields(read_json(path / _TABLE), where)
    info = rig_info(fields.value, where)
    mesh, _ = read_obj(_inside(path, fields.text("neutral"), where))
    shapes = fields.fields("shapes")
    targets = [_target(mesh, name, _inside(path, shapes.text(name), where)) for name in shapes]
    return Rig(
        mesh,
        tuple(replace(t, pose=dict(info.poses.get(t.name, {}))) for t in targets),
        info.part_names,
        runs_from_json(
            fields, "part_of_vertex", count=mesh.vertex_count, high=len(info.part_names) - 1
        ),
        info.landmarks,
        info.frame,
        info.controls,
        info.left_out,
    )


def _target(mesh: PolygonMesh, name: str, file: Path) -> MorphTarget:
    positions = read_obj_positions(file)
    if len(positions) != mesh.vertex_count:
        raise FormatError(
            f"{file}: has {len(positions)} vertices, the neutral has {mesh.vertex_count}; "
            "every shape must keep the neutral's vertices"
        )
    return MorphTarget.from_dense(name, positions - mesh.positions)


def _foreign(path: Path) -> tuple[PolygonMesh, list[tuple[str, Path]]]:
    files = {file.name.lower(): file for file in sorted(path.iterdir()) if _is_obj(file)}
    for name in (_NEUTRAL, *_OTHER_NEUTRALS):
        if name in files:
            mesh, _ = read_obj(files.pop(name))
            warnings.warn(
                f"{path}: has no {_TABLE}; unit and landmarks are unknown, millimetres are taken",
                RisoriusWarning,
                stacklevel=3,
            )
            return mesh, [(file.stem, file) for file in files.values()]
    raise FormatError(f"{path}: holds neither {_TABLE} nor {_NEUTRAL}; name the neutral so")


def _is_obj(file: Path) -> bool:
    return file.suffix.lower() == ".obj" and not file.name.startswith(".")


def _inside(folder: Path, name: str, where: str) -> Path:
    if not name or "\0" in name or Path(name).name != name or "\\" in name:
        raise FormatError(f"{where}: {name[:60]!r} is no name of a file in this folder")
    return folder / name


def _file_names(names: Iterable[str]) -> dict[str, str]:
    """Return a file name for each target, different also where case does not count."""
    taken = {_NEUTRAL, _TABLE}
    files: dict[str, str] = {}
    for name in names:
        stem = _UNSAFE.sub("_", name)[:100].strip(".") or "shape"
        file, repeats = f"{stem}.obj", 1
        while file.lower() in taken:
            repeats += 1
            file = f"{stem}_{repeats}.obj"
        taken.add(file.lower())
        files[name] = file
    return files


def _require_replaceable(path: Path) -> None:
    """Refuse a folder with files that are not an older rig's: they would be lost."""
    if not path.is_dir():
        return
    found = {file.name for file in path.iterdir()}
    if not found:
        return
    if _TABLE in found:
        fields = Fields(read_json(path / _TABLE), str(path / _TABLE))
        shapes = fields.fields("shapes")
        found -= {_TABLE, _NEUTRAL, *(shapes.text(name) for name in shapes)}
    if found:
        raise FormatError(
            f"{path}: holds files that are no rig's ({', '.join(sorted(found)[:3])}) and would be "
            "lost; choose a new folder"
        )


register(Format("OBJ folder", (".obj",), write_rig=write_obj_folder, read_folder=read_obj_folder))
