"""From what a pointer hit, as a page reports it, to places on the head at rest."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from risorius._check import FloatArray
from risorius.errors import FormatError
from risorius.io.json_fields import Fields
from risorius.studio.scene import Stage

__all__ = ["Place", "place_of", "text_of"]

_TOLERANCE = 1e-3


@dataclass(frozen=True, eq=False)
class Place:
    """A point on a mesh of the viewport.

    Parameters
    ----------
    mesh : str
        Its name.
    group : str
    face : int
    bary : (3,) float64
    position : (3,) float64
        At rest, canonical frame [mm].
    """

    mesh: str
    group: str
    face: int
    bary: FloatArray
    position: FloatArray


def place_of(message: object, stage: Stage) -> Place:
    """Return the place that a message of the pointer names.

    Raises
    ------
    FormatError
        If the message is malformed or names what is not there.
    """
    fields = Fields(message, "pointer")
    name = fields.text("mesh")
    found = stage.mesh(name)
    if found is None:
        raise FormatError(f"pointer: there is no mesh {name[:40]!r} any more")
    face = fields.integer("face")
    if face >= found.mesh.face_count:
        raise FormatError(f"pointer: {name} has no face {face}")
    bary = np.array(fields.numbers("bary", 3))
    if bary.min() < -_TOLERANCE or abs(bary.sum() - 1.0) > _TOLERANCE:
        raise FormatError("pointer: bary: three shares must be 0 or more and sum to 1")
    bary = np.maximum(bary, 0.0)
    bary /= bary.sum()
    position = bary @ found.mesh.positions[found.mesh.faces[face]]
    return Place(name, found.group, face, bary, position)


def text_of(message: object, key: str) -> str:
    """Return a text of a message of the page.

    Raises
    ------
    FormatError
        If it is not there.
    """
    return Fields(message, "page").text(key)
