"""Bone landmarks of a skull of one's own."""

from __future__ import annotations

import warnings
from dataclasses import replace
from pathlib import Path

from risorius import _formats
from risorius.errors import RisoriusWarning
from risorius.io.bounded import read_json
from risorius.io.json_fields import Fields
from risorius.landmarks.landmark_set import LandmarkSpec
from risorius.mesh.polygon_mesh import PolygonMesh

__all__ = ["read_bone_landmarks"]

# What others call the landmarks of the built-in skull.
_OTHER_NAMES = {"condylion": "condyle", "gnathion": "menton", "zygomatic": "zygion"}
_MANDIBLE = ("mandib", "jaw")


def read_bone_landmarks(path: Path, meshes: list[PolygonMesh]) -> dict[str, LandmarkSpec]:
    """Read the landmarks of a skull, named as in a muscle map.

    Sides may be written ``_L`` or ``_l``, alternatives with a slash (``gnathion/menton``). Where
    the skull has a file for the mandible, an entry ``"part"`` says whose vertices it counts;
    vertices without one run through both files.

    Parameters
    ----------
    path : Path
    meshes : list of PolygonMesh
        Of one or two files, cranium first.

    Raises
    ------
    FormatError
        If the file is missing or malformed.
    """
    with warnings.catch_warnings():
        # Bone landmarks are no feature points of a face, which the reader would warn of.
        warnings.simplefilter("ignore", RisoriusWarning)
        specs = _formats.read_landmarks(path)
    parts: dict[str, str] = {}
    if path.suffix.lower() == ".json" and len(meshes) > 1:
        entries = Fields(read_json(path), str(path)).fields("landmarks")
        parts = {name: entries.fields(name).text("part", default="") for name in entries}
    result: dict[str, LandmarkSpec] = {}
    for name, spec in specs.items():
        moved = spec
        if spec.vertex is not None and any(w in parts.get(name, "").lower() for w in _MANDIBLE):
            moved = replace(spec, vertex=spec.vertex + meshes[0].vertex_count)
        for known in _names(name):
            result.setdefault(known, moved)
    return result


def _names(name: str) -> list[str]:
    stem, side = name, ""
    if name[-2:].lower() in ("_l", "_r"):
        stem, side = name[:-2], name[-2:].lower()
    words = [word.strip().lower() for word in stem.split("/")]
    return [_OTHER_NAMES.get(word, word) + side for word in words]
