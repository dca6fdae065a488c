"""Add the morph targets of a rig to the meshes of a GLB that is being written."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from risorius._check import FloatArray
from risorius.io.gltf.binary import BinaryBuilder
from risorius.io.gltf.split import Split
from risorius.io.rig_parts import longer_than
from risorius.rig.rig import Rig

__all__ = ["add_targets"]


def add_targets(
    meshes: Sequence[dict[str, Any]], rig: Rig, parts: Split, binary: BinaryBuilder
) -> list[int]:
    """Give every mesh that moves in any target all targets, in the order of the rig.

    Parameters
    ----------
    meshes : sequence of dict
        glTF meshes whose primitives stand in the order of `parts`.
    rig : Rig
    parts : Split
    binary : BinaryBuilder

    Returns
    -------
    list of int
        Indices of the meshes that move.
    """
    moved = np.zeros(rig.mesh.vertex_count, bool)
    for target in rig.targets:
        moved[target.vertices[longer_than(0.0, target.deltas.astype(np.float32))]] = True
    described = [primitive for mesh in meshes for primitive in mesh["primitives"]]
    owners = [index for index, mesh in enumerate(meshes) for _ in mesh["primitives"]]
    moving = sorted(
        {owner for owner, one in zip(owners, parts.primitives) if moved[one.source].any()}
    )
    chosen = [
        (primitive, json)
        for primitive, json, owner in zip(parts.primitives, described, owners)
        if owner in moving
    ]
    for _, json in chosen:
        json["targets"] = []
    dense = np.zeros((rig.mesh.vertex_count, 3))
    for target in rig.targets:
        dense[target.vertices] = target.deltas
        change = parts.normals.turned(target)
        for primitive, json in chosen:
            json["targets"].append(
                {
                    "POSITION": _add(binary, dense, primitive.source, bounds=True),
                    "NORMAL": _add(binary, change, primitive.normal),
                }
            )
        dense[target.vertices] = 0.0
    for index in moving:
        meshes[index]["weights"] = [0.0] * len(rig.targets)
        meshes[index]["extras"] = {"targetNames": list(rig.names)}
    return moving


def _add(
    binary: BinaryBuilder, values: FloatArray, place: npt.NDArray[np.int64], *, bounds: bool = False
) -> int:
    own = values[place].astype("<f4")
    rows = np.flatnonzero(longer_than(0.0, own))
    return binary.displacements(rows, own[rows], len(place), bounds=bounds)
