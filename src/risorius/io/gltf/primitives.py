"""Decode the primitives of a placed glTF mesh: triangles, texture coordinates, morph targets."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from risorius._check import FloatArray
from risorius.errors import FormatError
from risorius.io.finite import first_bad_row
from risorius.io.gltf.accessors import element_count, read_floats, read_indices, read_rows
from risorius.io.gltf.document import Document, optional_index
from risorius.io.gltf.nodes import Placed
from risorius.io.json_fields import Fields

__all__ = ["SOURCE_ATTRIBUTE", "Piece", "read_pieces"]

LongArray = npt.NDArray[np.int64]

SOURCE_ATTRIBUTE = "_SOURCE_VERTEX"
"""Attribute that our own writer adds: the vertex of the input that a split vertex came from."""

_POINTS_AND_LINES = (0, 1, 2, 3)
_TRIANGLES, _STRIP, _FAN = 4, 5, 6


@dataclass(frozen=True, eq=False)
class Piece:
    """One primitive in the coordinates of the scene.

    Parameters
    ----------
    name, material : str
        Of its node and its material, maybe empty.
    positions : (n, 3) float64
    triangles : (t, 3) int64
    uvs : (n, 2) float64 or None
        v upwards, as everywhere outside glTF.
    source : (n,) int64 or None
        Input vertices, in files of our own.
    targets : dict
        Target name -> moved vertices (k,) and displacements (k, 3).
    """

    name: str
    material: str
    positions: FloatArray
    triangles: LongArray
    uvs: FloatArray | None
    source: LongArray | None
    targets: dict[str, tuple[LongArray, FloatArray]]


def read_pieces(document: Document, placed: Placed) -> Iterator[Piece]:
    """Yield the triangle primitives of one placed mesh; points and lines are passed over.

    Raises
    ------
    FormatError
        If an accessor is malformed or indices lie out of range.
    """
    mesh = placed.mesh
    for number, value in enumerate(mesh.items("primitives")):
        primitive = Fields(value, f"{mesh.where}.primitives[{number}]")
        mode = primitive.integer("mode", default=_TRIANGLES)
        if mode in _POINTS_AND_LINES:
            continue
        if mode > _FAN:
            raise FormatError(f"{primitive.place('mode')}: {mode} is no mode of a primitive")
        yield _piece(document, placed, primitive, mode)


def _piece(document: Document, placed: Placed, primitive: Fields, mode: int) -> Piece:
    attributes = primitive.fields("attributes")
    if "POSITION" not in attributes:
        raise FormatError(f"{attributes.where}: has no POSITION")
    own = read_floats(document, attributes.value["POSITION"], attributes.place("POSITION"), width=3)
    linear = placed.matrix[:3, :3]
    with np.errstate(over="ignore", invalid="ignore"):
        positions = own @ linear.T + placed.matrix[:3, 3]
        mirrored = np.linalg.det(linear) < 0.0
    if first_bad_row(positions) is not None:
        raise FormatError(f"{primitive.where}: its node carries it to infinity")
    triangles = _triangles(document, primitive, mode, len(positions))
    if mirrored:
        triangles = triangles[:, ::-1]
    return Piece(
        placed.name,
        _material(document, primitive),
        positions,
        np.ascontiguousarray(triangles),
        _uvs(document, attributes, len(positions)),
        _source(document, attributes, len(positions)),
        _targets(document, placed.mesh, primitive, linear, len(positions)),
    )


def _material(document: Document, primitive: Fields) -> str:
    index = optional_index(primitive, "material")
    if index is None:
        return ""
    return document.element("materials", index, primitive.where).text("name", default="")


def _triangles(document: Document, primitive: Fields, mode: int, count: int) -> LongArray:
    index = optional_index(primitive, "indices")
    if index is None:
        corners = np.arange(count, dtype=np.int64)
    else:
        corners = read_indices(document, index, primitive.place("indices"))
        if int(corners.max()) >= count:
            bad = int(np.argmax(corners >= count))
            raise FormatError(
                f"{primitive.place('indices')}: row {bad} is {corners[bad]}, the primitive has "
                f"{count} vertices"
            )
    if mode == _TRIANGLES:
        if len(corners) % 3:
            raise FormatError(f"{primitive.where}: {len(corners)} corners make no triangles")
        return corners.reshape(-1, 3)
    if len(corners) < 3:
        raise FormatError(f"{primitive.where}: {len(corners)} corners make no triangle")
    if mode == _FAN:
        first = np.full(len(corners) - 2, corners[0])
        return np.stack([first, corners[1:-1], corners[2:]], axis=1)
    strip = np.stack([corners[:-2], corners[1:-1], corners[2:]], axis=1)
    strip[1::2] = strip[1::2][:, [0, 2, 1]]
    return strip


def _uvs(document: Document, attributes: Fields, count: int) -> FloatArray | None:
    if "TEXCOORD_0" not in attributes:
        return None
    where = attributes.place("TEXCOORD_0")
    _require_count(document, attributes.value["TEXCOORD_0"], where, count)
    uvs = read_floats(document, attributes.value["TEXCOORD_0"], where, width=2)
    return np.stack([uvs[:, 0], 1.0 - uvs[:, 1]], axis=1)


def _source(document: Document, attributes: Fields, count: int) -> LongArray | None:
    if SOURCE_ATTRIBUTE not in attributes:
        return None
    where = attributes.place(SOURCE_ATTRIBUTE)
    _require_count(document, attributes.value[SOURCE_ATTRIBUTE], where, count)
    values = read_floats(document, attributes.value[SOURCE_ATTRIBUTE], where, width=1)[:, 0]
    if (values < 0).any() or (values != np.floor(values)).any() or values.max() >= 2**31:
        raise FormatError(f"{where}: expected vertex numbers from 0")
    return values.astype(np.int64)


def _targets(
    document: Document, mesh: Fields, primitive: Fields, linear: FloatArray, count: int
) -> dict[str, tuple[LongArray, FloatArray]]:
    values = primitive.items("targets")
    names = _target_names(mesh, primitive, len(values))
    result: dict[str, tuple[LongArray, FloatArray]] = {}
    for name, value in zip(names, values):
        target = Fields(value, f"{primitive.where}.targets[{len(result)}]")
        if "POSITION" not in target:
            result[name] = (np.zeros(0, np.int64), np.zeros((0, 3)))
            continue
        rows, deltas = read_rows(
            document, target.value["POSITION"], target.place("POSITION"), width=3, count=count
        )
        with np.errstate(over="ignore", invalid="ignore"):
            moved = deltas @ linear.T
        if first_bad_row(moved) is not None:
            raise FormatError(f"{target.where}: its node carries it to infinity")
        result[name] = (rows, moved)
    return result


def _target_names(mesh: Fields, primitive: Fields, count: int) -> tuple[str, ...]:
    """Return `count` different names; those that the file lacks are ``target_0``, ..."""
    named = "targetNames"
    owner = mesh if named in mesh.fields("extras") else primitive
    given = owner.fields("extras").texts(named)[:count]
    given += [f"target_{index}" for index in range(len(given), count)]
    names: dict[str, None] = {}
    for name in given:
        unique, repeats = name, 1
        while unique in names:
            repeats += 1
            unique = f"{name}_{repeats}"
        names[unique] = None
    return tuple(names)


def _require_count(document: Document, index: object, where: str, count: int) -> None:
    found = element_count(document, index, where)
    if found != count:
        raise FormatError(f"{where}: {found} elements for {count} vertices")
