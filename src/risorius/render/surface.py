"""What is drawn: a triangle mesh with colour and gloss."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from risorius._check import FloatArray, IntArray, as_faces, as_number, as_points
from risorius.errors import ParameterError, ShapeError
from risorius.mesh.core import TriMesh
from risorius.render.materials import SKIN

__all__ = ["Surface"]


@dataclass(frozen=True, eq=False)
class Surface:
    """A triangle mesh to be drawn.

    Parameters
    ----------
    positions : (n, 3) array_like
        Vertex positions [mm].
    faces : (m, 3) array_like of int
        Triangles, counter-clockwise from outside; back faces are drawn darker.
    colour : (3,), (n, 3) or (m, 3) array_like, with `ramp` (n,) or (n, 3)
        Linear RGB in 0..1 of the whole, of each vertex, or of each face (vertices win where
        n == m). With a `ramp`: the place of each vertex on it, in 0..1; or a vector for each
        vertex, whose angle from +Z over 180 degrees is the place.
    smooth : bool
        Interpolate vertex normals over the faces.
    specular : float
        Strength of reflections in 0..1; 0.5 is skin, plastic or water.
    gloss : float
        Sharpness of reflections in 0..1.
    opacity : float
        Below 1, what lies behind shines through; grazing parts are denser, as in thin glass.
    normals : (n, 3) array_like, optional
        Vertex normals, used when `smooth`; default: the mean over the faces
        by area.
    ramp : (k, 3) array_like, optional
        Linear RGB that is looked up for each pixel, so that edges in it (the rim of an iris,
        a step of a scale) stay sharper than the mesh is fine.

    Raises
    ------
    ShapeError
        On wrong shapes, non-finite values or indices out of range.
    ParameterError
        On colours or numbers outside 0..1.
    """

    positions: FloatArray
    faces: IntArray
    colour: npt.ArrayLike = SKIN
    smooth: bool = True
    specular: float = 0.4
    gloss: float = 0.3
    opacity: float = 1.0
    normals: FloatArray | None = None
    ramp: FloatArray | None = None

    def __post_init__(self) -> None:
        positions = as_points("positions", self.positions)
        faces = as_faces("faces", self.faces, vertex_count=len(positions))
        _set(self, "positions", positions)
        _set(self, "faces", faces)
        for name in ("specular", "gloss", "opacity"):
            _set(self, name, as_number(name, getattr(self, name), low=0.0, high=1.0))
        if self.normals is not None:
            normals = as_points("normals", self.normals)
            if len(normals) != len(positions):
                raise ShapeError(f"normals: expected {len(positions)} rows, got {len(normals)}")
            _set(self, "normals", normals)
        if self.ramp is not None:
            ramp = as_points("ramp", self.ramp)
            if not len(ramp):
                raise ShapeError("ramp: expected at least one colour")
            _set(self, "ramp", _in_unit_range("ramp", ramp))
        _set(self, "colour", self._checked_colour())

    def _checked_colour(self) -> FloatArray:
        colour = np.ascontiguousarray(self.colour, dtype=np.float64)
        n, m = len(self.positions), len(self.faces)
        allowed = [(n,), (n, 3)] if self.ramp is not None else [(3,), (n, 3), (m, 3)]
        if colour.shape not in allowed:
            shapes = " or ".join(str(shape) for shape in allowed)
            raise ShapeError(f"colour: expected shape {shapes}, got {colour.shape}")
        if self.ramp is not None and colour.ndim == 2:
            return as_points("colour", colour)
        return _in_unit_range("colour", colour)

    @property
    def colour_array(self) -> FloatArray:
        """The colour as float64 of shape (3,), (n, 3), (m, 3) or, with a ramp, (n,)."""
        return np.asarray(self.colour, dtype=np.float64)

    @staticmethod
    def of(mesh: TriMesh, **look: Any) -> Surface:
        """Return `mesh` as a surface; `look` are the other parameters of `Surface`."""
        return Surface(mesh.positions, mesh.faces, **look)


def _set(surface: Surface, name: str, value: object) -> None:
    object.__setattr__(surface, name, value)


def _in_unit_range(name: str, value: FloatArray) -> FloatArray:
    bad = ~((value >= 0.0) & (value <= 1.0))
    if bad.any():
        row = int(np.argmax(bad.reshape(len(value), -1).any(axis=1)))
        raise ParameterError(
            f"{name}: entry {row} is {value[row].tolist()}, linear colours lie in 0..1; "
            f"divide 8-bit colours by 255 and linearise them"
        )
    return value
