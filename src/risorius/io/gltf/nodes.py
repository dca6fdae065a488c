"""Walk the node tree of a glTF scene: which meshes stand where."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from risorius._check import FloatArray
from risorius.errors import FormatError
from risorius.io.gltf.accessors import read_floats
from risorius.io.gltf.document import Document, optional_index
from risorius.io.json_fields import Fields, whole_number

__all__ = ["METRES_MARK", "Placed", "placed_meshes"]

METRES_MARK = "to_metres"
"""Stands in the extras of the node that our own writer adds to turn a head to metres, Y up."""


@dataclass(frozen=True, eq=False)
class Placed:
    """A mesh of the file and its place.

    Parameters
    ----------
    name : str
        Name of the node, or of the mesh.
    mesh : Fields
        The mesh in the file.
    matrix : (4, 4) float64
        From the mesh's own coordinates to those of the scene.
    skinned : bool
        Whether a skeleton holds it.
    """

    name: str
    mesh: Fields
    matrix: FloatArray
    skinned: bool


def placed_meshes(document: Document, *, keep_unit: bool) -> Iterator[Placed]:
    """Yield every mesh of the default scene, depth first in the order of the file.

    Parameters
    ----------
    document : Document
    keep_unit : bool
        Ignore the node that our own writer adds to turn a head to metres.

    Raises
    ------
    FormatError
        If nodes form a cycle or have two parents.
    """
    matrices: dict[int, FloatArray] = {}
    found: list[tuple[Fields, FloatArray]] = []
    pending = [(root, np.eye(4)) for root in reversed(_roots(document))]
    while pending:
        reference, parent = pending.pop()
        index = whole_number(reference, f"{document.path}: nodes of the scene")
        node = document.element("nodes", index, f"{document.path}: scene")
        if index in matrices:
            raise FormatError(f"{node.where}: is reached twice; nodes must form a tree")
        marked = keep_unit and node.fields("extras").value.get("risorius") == METRES_MARK
        with np.errstate(over="ignore", invalid="ignore"):
            matrices[index] = parent if marked else parent @ _local(node)
        if "mesh" in node:
            found.append((node, matrices[index]))
        pending.extend((child, matrices[index]) for child in reversed(node.items("children")))
    for node, matrix in found:
        mesh = document.element("meshes", node.value["mesh"], node.place("mesh"))
        name = node.text("name", default="") or mesh.text("name", default="")
        skinned = "skin" in node
        place = _rest_of_skin(document, node, matrices) if skinned else matrix
        yield Placed(name, mesh, place, skinned)


def _roots(document: Document) -> list[object]:
    where = f"{document.path}: scene"
    if document.elements("scenes"):
        chosen = optional_index(document.root, "scene")
        return document.element("scenes", chosen or 0, where).items("nodes")
    children: set[object] = set()
    for index in document.elements("nodes"):
        children.update(
            child
            for child in document.element("nodes", index, where).items("children")
            if isinstance(child, int | float)
        )
    return [index for index in document.elements("nodes") if index not in children]


def _local(node: Fields) -> FloatArray:
    """Return the matrix (4, 4) of a node relative to its parent."""
    if "matrix" in node:
        return np.array(node.numbers("matrix", 16)).reshape(4, 4).T
    matrix = np.eye(4)
    if "rotation" in node:
        matrix[:3, :3] = _rotation(node)
    if "scale" in node:
        matrix[:3, :3] *= node.numbers("scale", 3)
    if "translation" in node:
        matrix[:3, 3] = node.numbers("translation", 3)
    return matrix


def _rotation(node: Fields) -> FloatArray:
    quaternion = np.array(node.numbers("rotation", 4))
    length = float(np.linalg.norm(quaternion / max(np.abs(quaternion).max(), 1e-300)))
    if length == 0.0:
        raise FormatError(f"{node.place('rotation')}: a quaternion of zeros is no rotation")
    x, y, z, w = quaternion / np.linalg.norm(quaternion)
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


def _rest_of_skin(document: Document, node: Fields, matrices: dict[int, FloatArray]) -> FloatArray:
    """Return where the skeleton holds a mesh at rest.

    In the rest pose every joint carries the mesh to the same place, so one joint tells it.
    """
    skin = document.element("skins", node.value["skin"], node.place("skin"))
    joints = skin.items("joints")
    inverse = optional_index(skin, "inverseBindMatrices")
    if not joints or inverse is None:
        return np.eye(4)
    joint = whole_number(joints[0], skin.place("joints"))
    bind = read_floats(document, inverse, skin.place("inverseBindMatrices"), width=16)
    with np.errstate(over="ignore", invalid="ignore"):
        return matrices.get(joint, np.eye(4)) @ bind[0].reshape(4, 4).T
