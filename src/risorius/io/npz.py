"""Rigs as NumPy archives: plain arrays for those who compute with them."""

from __future__ import annotations

import json
import zipfile
from collections.abc import Iterable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from risorius._formats import Format, register
from risorius.errors import FormatError, ShapeError
from risorius.io.atomic import atomic_write
from risorius.io.bounded import parse_json
from risorius.io.json_fields import Fields
from risorius.io.npz_archive import Archive
from risorius.io.rig_json import RigInfo, labels_from_json, labels_to_json, rig_info, rig_to_json
from risorius.landmarks.landmark_set import LandmarkSpec
from risorius.mesh.polygon_mesh import PolygonMesh
from risorius.rig.rig import MorphTarget, Rig

__all__ = ["read_npz_head", "read_npz_rig", "write_npz"]


def write_npz(rig: Rig, path: str | Path) -> None:
    """Write a rig as compressed NumPy archive.

    It holds ``names (k,)``, ``deltas (k, n, 3)`` and ``neutral (n, 3)`` in the input's frame and
    unit, ``faces (t, 3)``, the polygons as ``corners (c,)`` and ``offsets (m + 1,)``,
    ``uvs (q, 2)`` and ``uv_corners (c,)``, ``part_of_vertex (n,)`` and ``meta``, a JSON text with
    landmarks, frame, controls, poses and the names of objects, groups and materials. Everything
    reads back bit by bit.

    Raises
    ------
    FormatError
        If the file cannot be written.
    """
    mesh = rig.mesh
    meta = {
        **rig_to_json(rig),
        "objects": labels_to_json(mesh.objects),
        "groups": labels_to_json(mesh.groups),
        "materials": labels_to_json(mesh.materials),
    }
    arrays: dict[str, npt.NDArray[Any]] = {
        "meta": np.array(json.dumps(meta, ensure_ascii=False, allow_nan=False)),
        "names": np.array(rig.names, dtype=np.str_),
        "neutral": mesh.positions,
        "faces": mesh.triangles,
        "corners": mesh.corners,
        "offsets": mesh.offsets,
        "uvs": mesh.uvs,
        "uv_corners": mesh.uv_corners,
        "part_of_vertex": rig.part_of_vertex,
    }
    with (
        atomic_write(path) as temporary,
        zipfile.ZipFile(temporary, "w", zipfile.ZIP_DEFLATED, compresslevel=3) as archive,
    ):
        for name, array in arrays.items():
            _add(archive, name, array.dtype, array.shape, [array])
        shape = (len(rig.targets), mesh.vertex_count, 3)
        dense = (target.dense(mesh.vertex_count) for target in rig.targets)
        _add(archive, "deltas", np.dtype(np.float64), shape, dense)


def read_npz_rig(path: str | Path) -> Rig:
    """Read a rig that `write_npz` wrote.

    Raises
    ------
    FormatError
        If the archive or an array in it is malformed.
    """
    archive = Archive(path)
    mesh, info = _mesh(archive)
    names = archive.texts("names")
    if len(set(names)) < len(names):
        raise FormatError(f"{path}: names: two targets have the same name")
    shape = (len(names), mesh.vertex_count, 3)
    targets = tuple(
        replace(MorphTarget.from_dense(name, deltas), pose=dict(info.poses.get(name, {})))
        for name, deltas in zip(names, archive.rows("deltas", shape))
    )
    part = archive.integers("part_of_vertex", high=len(info.part_names) - 1)
    if len(part) not in (0, mesh.vertex_count):
        raise FormatError(f"{path}: part_of_vertex: expected {mesh.vertex_count} numbers")
    return Rig(
        mesh,
        targets,
        info.part_names,
        part,
        info.landmarks,
        info.frame,
        info.controls,
        info.left_out,
    )


def read_npz_head(path: str | Path) -> tuple[PolygonMesh, Mapping[str, LandmarkSpec]]:
    """Read the neutral and the landmarks of a rig that `write_npz` wrote.

    Raises
    ------
    FormatError
        As `read_npz_rig`.
    """
    mesh, info = _mesh(Archive(path))
    return mesh, info.landmarks


def _mesh(archive: Archive) -> tuple[PolygonMesh, RigInfo]:
    where = f"{archive.path}: meta"
    meta = Fields(parse_json(archive.text("meta").encode(), where), where)
    info = rig_info(meta.value, where)
    positions = archive.floats("neutral", 3)
    corners = archive.integers("corners", high=len(positions) - 1)
    offsets = archive.integers("offsets", high=len(corners))
    if not len(offsets) or (np.diff(offsets) < 0).any():
        raise FormatError(f"{archive.path}: offsets: must start at 0 and rise")
    uvs = archive.floats("uvs", 2)
    polygons = len(offsets) - 1
    try:
        mesh = PolygonMesh(
            positions,
            corners,
            offsets,
            uvs=uvs,
            uv_corners=archive.integers("uv_corners", high=len(uvs) - 1),
            objects=labels_from_json(meta.fields("objects"), polygons),
            groups=labels_from_json(meta.fields("groups"), polygons),
            materials=labels_from_json(meta.fields("materials"), polygons),
        )
    except ShapeError as error:
        raise FormatError(f"{archive.path}: {error}") from None
    return mesh, info


def _add(
    archive: zipfile.ZipFile,
    name: str,
    dtype: np.dtype[Any],
    shape: tuple[int, ...],
    parts: Iterable[npt.NDArray[Any]],
) -> None:
    """Add an array that is given in parts; entries made by name carry no time of day."""
    with archive.open(f"{name}.npy", "w", force_zip64=True) as file:
        header = {"descr": dtype.str, "fortran_order": False, "shape": shape}
        np.lib.format.write_array_header_1_0(file, header)
        for part in parts:
            file.write(np.ascontiguousarray(part).data)


register(
    Format(
        "npz",
        (".npz",),
        read_head=read_npz_head,
        read_rig=read_npz_rig,
        write_rig=write_npz,
    )
)
