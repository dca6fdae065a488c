"""Colours on the skin that stand for numbers: influence, strain, displacement."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import numpy.typing as npt

from risorius._check import FloatArray
from risorius.mesh.core import TriMesh
from risorius.render.colours import display_rgb, heat_colours
from risorius.studio.subject import Subject

__all__ = ["HEATS", "heat_of", "paint"]

HEATS = ("none", "displacement", "strain", "influence")
"""What may be painted on the skin."""

# Ends of the scales: displacement [mm of the built-in head], logarithm of the area ratio.
_FAR, _STRAINED = 12.0, 0.5


def heat_of(
    kind: str, subject: Subject, skin: FloatArray, *, muscles: tuple[str, ...] = ()
) -> tuple[FloatArray, float, str] | None:
    """Return the number of every vertex of the skin, the end of its scale, and its unit.

    Parameters
    ----------
    kind : str
        One of `HEATS`.
    subject : Subject
    skin : (n, 3) float64
        Posed vertices of the skin's mesh [mm].
    muscles : tuple of str
        Controls whose influence is asked for.
    """
    mesh = subject.head.skin.mesh
    scale = subject.fitted.scale
    if kind == "displacement":
        return np.linalg.norm(skin - mesh.positions, axis=1), _FAR * scale, "mm"
    if kind == "strain":
        ratio = _areas(mesh.at(skin)) / np.maximum(_areas(mesh), 1e-9)
        return np.abs(np.log(np.clip(ratio, 0.05, 20.0))), _STRAINED, "ln area"
    if kind == "influence":
        field = _influence(subject, muscles)
        return None if field is None else (field, 1.0, "of the largest")
    return None


def paint(values: FloatArray, high: float) -> npt.NDArray[np.uint8]:
    """Return sRGB (n, 3) of `values` (n,) between 0 and `high`."""
    return display_rgb(heat_colours(values, 0.0, max(high, 1e-9)))


def _influence(subject: Subject, muscles: tuple[str, ...]) -> FloatArray | None:
    count = subject.head.skin.vertex_count
    total = np.zeros(count)
    fields: Mapping[str, FloatArray] = subject.bench.face.fields if subject.bench else {}
    if subject.spring_face is not None:
        fields = subject.spring_face.driver.fields
        names = {m.name: m.action.control for m in subject.spring_face.muscles.muscles}
        muscles = tuple(names.get(name, name) for name in muscles)
    vector = subject.vector_face
    for name in muscles:
        if name in fields:
            total = np.maximum(total, np.linalg.norm(fields[name], axis=1))
        elif vector is not None and name in vector.bound:
            bound = vector.bound[name]
            rest = subject.head.skin.mesh.positions[bound.vertices]
            moved = np.zeros(count)
            moved[bound.vertices] = np.linalg.norm(bound.displace(rest, 1.0), axis=1)
            total = np.maximum(total, moved)
    largest = float(total.max(initial=0.0))
    return total / largest if largest > 0.0 else None


def _areas(mesh: TriMesh) -> FloatArray:
    a, b, c = (mesh.positions[mesh.faces[:, k]] for k in range(3))
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    result = np.zeros(mesh.vertex_count)
    for corner in range(3):
        np.add.at(result, mesh.faces[:, corner], area)
    return result
