"""Surfaces as one set of tables in view coordinates, ready for the kernels."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from risorius._check import FloatArray, IntArray
from risorius.render.camera import Camera
from risorius.render.kernels.raster import area_normals, prepare
from risorius.render.surface import Surface

__all__ = ["Scene", "diagonal", "gather"]

Float32Array = npt.NDArray[np.float32]


@dataclass(frozen=True, eq=False)
class Scene:
    """All triangles, those of opaque surfaces first; see `kernels` for the conventions.

    Parameters
    ----------
    size : (width, height)
        Samples of the picture.
    near : float
        Depth before which nothing is drawn [mm].
    surfaces : tuple of Surface
        In the caller's order.
    order : (s,) int32
        Index of the caller's surface for each gathered one.
    first_face : (s + 1,) int32
        Where the faces of each surface begin.
    opaque_face_count : int
    face_surface : (m,) int32
        Gathered surface of each face.
    edges : (m, 9) float64
    volume : (m,) float64
    box : (m, 4) int32
        First and last column, first and last row that a face may cover.
    normals : (k, 3) float64
        Directions right, down, away; of any length.
    normal_rows : (m, 3) int32
        Row of `normals` for each corner.
    colours : (c, 3) float64
    colour_rows : (m, 3) int32
        Row of `colours` for each corner.
    ramps : (r, 3) float64
        The ramps of all surfaces, one after the other.
    materials : (s, 6) float64
        Specular, gloss, opacity, whether plain, first row and size of the ramp, the size
        negative where the colour is a vector.
    """

    size: tuple[int, int]
    near: float
    surfaces: tuple[Surface, ...]
    order: IntArray
    first_face: IntArray
    opaque_face_count: int
    face_surface: IntArray
    edges: FloatArray
    volume: FloatArray
    box: IntArray
    normals: FloatArray
    normal_rows: IntArray
    colours: FloatArray
    colour_rows: IntArray
    ramps: FloatArray
    materials: FloatArray

    @property
    def face_count(self) -> int:
        """Number of triangles of all surfaces."""
        return len(self.volume)

    @property
    def diagonal(self) -> float:
        """Of the box around everything drawn [mm]."""
        return diagonal(self.surfaces)


# Triangles whose coordinates overflow are left out by `prepare`.
@np.errstate(over="ignore", invalid="ignore")
def gather(surfaces: Sequence[Surface], camera: Camera, size: tuple[int, int]) -> Scene:
    """Return `surfaces` as seen by `camera` on a picture of `size` = (width, height) samples."""
    order = sorted(range(len(surfaces)), key=lambda index: surfaces[index].opacity < 1.0)
    drawn = [surfaces[index] for index in order]
    width, height = size
    counts = [len(surface.faces) for surface in drawn]
    first_face = np.concatenate([[0], np.cumsum(counts)]).astype(np.int32)
    faces = _stacked([s.faces for s in drawn], [len(s.positions) for s in drawn])
    positions = _rows([surface.positions for surface in drawn])
    view = (positions - camera.eye) @ camera.axes.T
    focal = camera.focal(height)
    view *= [focal, -focal, 1.0]

    m = len(faces)
    edges, volume, box = np.empty((m, 9)), np.empty(m), np.empty((m, 4), np.int32)
    prepare(view, faces, camera.near, width, height, edges, volume, box)
    normals, normal_rows = _normals(drawn)
    colours, colour_rows, ramps, spans = _colours(drawn)
    looks = [[s.specular, s.gloss, s.opacity, float(_is_plain(s))] for s in drawn]
    return Scene(
        size=size,
        near=camera.near,
        surfaces=tuple(surfaces),
        order=np.array(order, np.int32),
        first_face=first_face,
        opaque_face_count=sum(len(s.faces) for s in drawn if s.opacity >= 1.0),
        face_surface=np.repeat(np.arange(len(drawn)), counts).astype(np.int32),
        edges=edges,
        volume=volume,
        box=box,
        normals=np.ascontiguousarray(normals @ camera.axes.T * [1.0, -1.0, 1.0]),
        normal_rows=normal_rows,
        colours=colours,
        colour_rows=colour_rows,
        ramps=ramps,
        materials=np.hstack([np.array(looks).reshape(-1, 4), spans]),
    )


def _normals(surfaces: Sequence[Surface]) -> tuple[FloatArray, IntArray]:
    tables: list[FloatArray] = []
    rows: list[IntArray] = []
    for surface in surfaces:
        if surface.smooth:
            own = surface.normals
            # By area and compiled: `mesh.normals`, by angle, costs as much as half a picture.
            if own is None:
                own = np.zeros_like(surface.positions)
                area_normals(surface.positions, surface.faces, own)
            tables.append(own)
            rows.append(surface.faces)
        else:
            corners = surface.positions[surface.faces]
            tables.append(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]))
            rows.append(_each_face(len(surface.faces)))
    return _rows(tables), _stacked(rows, [len(table) for table in tables])


def _colours(
    surfaces: Sequence[Surface],
) -> tuple[FloatArray, IntArray, FloatArray, FloatArray]:
    """Return colour table, its rows for each corner, ramps, and first row and size of each."""
    tables: list[FloatArray] = []
    rows: list[IntArray] = []
    ramps: list[FloatArray] = []
    spans = np.zeros((len(surfaces), 2))
    filled = 0
    for index, surface in enumerate(surfaces):
        colour = surface.colour_array
        if surface.ramp is not None:
            by_angle = colour.ndim == 2
            table = colour if by_angle else np.repeat(colour[:, None], 3, axis=1)
            own = surface.faces
            ramps.append(surface.ramp)
            spans[index] = filled, -len(surface.ramp) if by_angle else len(surface.ramp)
            filled += len(surface.ramp)
        elif colour.ndim == 1:
            table, own = colour[None], np.zeros_like(surface.faces)
        elif len(colour) == len(surface.positions):
            table, own = colour, surface.faces
        else:
            table, own = colour, _each_face(len(surface.faces))
        tables.append(table)
        rows.append(own)
    stacked = _stacked(rows, [len(table) for table in tables])
    return _rows(tables), stacked, _rows(ramps), spans


def _is_plain(surface: Surface) -> bool:
    """Whether colour and normal vary so gently that few samples tell a pixel's shade."""
    return surface.smooth and surface.ramp is None and surface.colour_array.ndim == 1


def _each_face(count: int) -> IntArray:
    return np.repeat(np.arange(count, dtype=np.int32)[:, None], 3, axis=1)


def _rows(tables: Sequence[FloatArray]) -> FloatArray:
    return np.ascontiguousarray(np.concatenate([np.zeros((0, 3)), *tables]))


def _stacked(rows: Sequence[IntArray], lengths: Sequence[int]) -> IntArray:
    offsets = np.concatenate([[0], np.cumsum(lengths)])
    moved = [own + offset for own, offset in zip(rows, offsets[:-1], strict=True)]
    return np.concatenate([np.zeros((0, 3), np.int32), *moved]).astype(np.int32)


def diagonal(surfaces: Sequence[Surface]) -> float:
    """Return the diagonal of the box around the faces of `surfaces` [mm], 0 if there are none."""
    low, high = np.full(3, np.inf), np.full(3, -np.inf)
    for surface in surfaces:
        used = np.zeros(len(surface.positions), bool)
        used[surface.faces] = True
        if used.any():
            places = surface.positions[used]
            low = np.minimum(low, places.min(axis=0))
            high = np.maximum(high, places.max(axis=0))
    return float(np.linalg.norm(high - low)) if (low <= high).all() else 0.0
