"""Read glTF files as heads and as rigs, our own ones back to the input's vertices and polygons."""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from risorius._check import IntArray
from risorius.errors import FormatError, RisoriusWarning
from risorius.head.frame import Frame
from risorius.io.gltf.document import Document, open_document
from risorius.io.gltf.nodes import Placed, placed_meshes
from risorius.io.gltf.primitives import read_pieces
from risorius.io.gltf.soup import Soup, joined
from risorius.io.gltf.topology import restore
from risorius.io.json_fields import Fields
from risorius.io.rig_json import RigInfo, rig_info
from risorius.landmarks.landmark_set import LandmarkSpec
from risorius.mesh.polygon_mesh import PolygonMesh
from risorius.rig.rig import MorphTarget, Rig

__all__ = ["read_gltf_head", "read_gltf_landmarks", "read_gltf_rig"]

_METRES = 1000.0  # the unit of glTF [mm]


@dataclass(frozen=True, eq=False)
class _Content:
    mesh: PolygonMesh
    targets: tuple[MorphTarget, ...]
    part_names: tuple[str, ...]
    part_of_vertex: IntArray
    info: RigInfo | None


def read_gltf_head(path: str | Path) -> tuple[PolygonMesh, Mapping[str, LandmarkSpec]]:
    """Read all meshes of a glTF file as one mesh, and the landmarks of a file of our own.

    Raises
    ------
    FormatError
        On a malformed file, or geometry that is compressed.

    Warns
    -----
    RisoriusWarning
        If skins, lines or what our own files carry had to be left out.
    """
    document = open_document(path)
    content = _content(document)
    for target in content.targets:
        document.spend(3 * content.mesh.vertex_count, f"{path}: target {target.name[:40]!r}")
    targets = {target.name: target.dense(content.mesh.vertex_count) for target in content.targets}
    return replace(content.mesh, targets=targets), content.info.landmarks if content.info else {}


def read_gltf_landmarks(path: str | Path) -> Mapping[str, LandmarkSpec]:
    """Read the landmarks of a GLB of our own.

    Raises
    ------
    FormatError
        If the file carries none.
    """
    info = _content(open_document(path)).info
    if info is None or not info.landmarks:
        raise FormatError(f"{path}: carries no landmarks; give a landmark file")
    return info.landmarks


def read_gltf_rig(path: str | Path) -> Rig:
    """Read a rig; a file of another program is taken as metres, +Y up, +Z forward.

    Raises
    ------
    FormatError
        As `read_gltf_head`.
    """
    content = _content(open_document(path))
    info = content.info
    if info is None:
        frame = Frame(np.eye(3), _METRES, np.zeros(3), "m")
        names, parts = content.part_names, content.part_of_vertex
        return Rig(content.mesh, content.targets, names, parts, frame=frame)
    targets = [replace(t, pose=dict(info.poses.get(t.name, {}))) for t in content.targets]
    return Rig(
        content.mesh,
        tuple(targets),
        content.part_names,
        content.part_of_vertex,
        info.landmarks,
        info.frame,
        info.controls,
        info.left_out,
    )


def _content(document: Document) -> _Content:
    block = document.root.fields("asset").fields("extras").value.get("risorius")
    own = None if block is None else Fields(block, f"{document.path}: asset.extras.risorius")
    placed = list(placed_meshes(document, keep_unit=own is not None))
    soup = _soup(document, placed)
    if own is not None and soup.source is None:
        warnings.warn(
            f"{document.path}: another program has changed the mesh; landmarks, controls and "
            "poses in the file no longer fit and are left out",
            RisoriusWarning,
            stacklevel=4,
        )
        own = None
        soup = _soup(document, list(placed_meshes(document, keep_unit=False)))
    if own is None:
        every = np.arange(len(soup.positions))
        parts = np.full(len(every), -1, np.int32)
        if len(soup.objects.of_polygon):
            parts[soup.triangles] = soup.objects.of_polygon[:, None]
        targets = soup.morph_targets(every)
        return _Content(soup.mesh(), targets, soup.objects.names, parts, None)
    info = rig_info(own.value, own.where)
    restored = restore(document, own.fields("topology"), soup, part_count=len(info.part_names))
    if not restored.has_polygons:
        info = replace(info, landmarks=_without_faces(document, info))
    targets = soup.morph_targets(restored.vertex)
    return _Content(restored.mesh, targets, info.part_names, restored.part_of_vertex, info)


def _soup(document: Document, placed: Sequence[Placed]) -> Soup:
    pieces = [piece for mesh in placed for piece in read_pieces(document, mesh)]
    if not pieces:
        raise FormatError(f"{document.path}: the scene shows no triangles; export a mesh with it")
    skinned = sum(mesh.skinned for mesh in placed)
    if skinned:
        warnings.warn(
            f"{document.path}: {skinned} skin(s) left out, the mesh is read in its rest pose",
            RisoriusWarning,
            stacklevel=5,
        )
    return joined(pieces)


def _without_faces(document: Document, info: RigInfo) -> dict[str, LandmarkSpec]:
    """Return the landmarks that do not count triangles, which are no longer the input's."""
    kept = {name: spec for name, spec in info.landmarks.items() if spec.face is None}
    lost = [name for name in info.landmarks if name not in kept]
    warnings.warn(
        f"{document.path}: another program has rewritten the file; it holds triangles where the "
        f"input had polygons{', without landmarks ' + ', '.join(lost[:5]) if lost else ''}",
        RisoriusWarning,
        stacklevel=5,
    )
    return kept
