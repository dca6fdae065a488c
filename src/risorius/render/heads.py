"""Pictures of heads and rigs: parts in their colours, framed by landmarks."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from risorius._check import BoolArray, FloatArray, IntArray, as_points
from risorius.errors import ShapeError
from risorius.head.head import Head
from risorius.head.part_geometry import fit_sphere
from risorius.landmarks.landmark_set import LandmarkSet, resolve
from risorius.mesh.welding import Weld, weld
from risorius.render.camera import Camera
from risorius.render.kernels.raster import area_normals
from risorius.render.materials import colour_of_material, eye_paint, look_of_material
from risorius.render.picture import render
from risorius.render.surface import Surface
from risorius.render.views import camera_for
from risorius.rig.bake import empty_rig
from risorius.rig.rig import Rig

__all__ = ["Portrait", "part_look"]

# An eye that misses the best sphere by more than this share of its radius is not painted.
_ROUND = 0.12
# Triangles that turn away from the camera by more than 120 degrees, or lie beside the picture by
# more than this share of it, come into view in no pose.
_AWAY = -0.5
_BESIDE = 0.15
_HAIR_ON_SKIN = 0.55
# Parts whose own look says more than the names of materials on them.
_BY_PART = ("teeth", "tongue", "gums", "lashes")


@dataclass(frozen=True, eq=False)
class _Piece:
    """Triangles of one look; `vertices` (k,) of the whole head, `faces` (m, 3) count in them."""

    vertices: IntArray
    faces: IntArray
    look: Mapping[str, Any]


@dataclass(frozen=True, eq=False)
class Portrait:
    """A head that sits for pictures.

    Parameters
    ----------
    positions : (n, 3) float64
        All vertices at rest, canonical frame [mm].
    landmarks : LandmarkSet
        In the same frame; may be empty, then the whole mesh is framed.
    """

    positions: FloatArray
    landmarks: LandmarkSet
    _rig: Rig
    _pieces: tuple[_Piece, ...]
    _joined: Weld
    _triangles: IntArray

    @staticmethod
    def of(subject: Rig | Head) -> Portrait:
        """Return the portrait of a rig or of a head."""
        rig = empty_rig(subject) if isinstance(subject, Head) else subject
        positions = rig.frame.to_canonical(rig.mesh.positions)
        marks = LandmarkSet((), positions)
        if rig.landmarks:
            marks = resolve(rig.landmarks, rig.mesh).at(positions)
        # Seams of texture coordinates would show as creases.
        joined = weld(positions, tolerance=0.0)
        return Portrait(positions, marks, rig, _pieces(rig, positions), joined, rig.mesh.triangles)

    def posed(self, weights: Mapping[str, float]) -> FloatArray:
        """Return the positions (n, 3) with weighted targets of the rig [mm].

        Raises
        ------
        ParameterError
            If the rig has no target of such a name.
        """
        return self._rig.frame.to_canonical(self._rig.posed(weights))

    def seen_from(self, camera: Camera, *, aspect: float = 1.0) -> Portrait:
        """Return the portrait without the triangles that `camera` sees in no pose of the face.

        Parameters
        ----------
        camera : Camera
        aspect : float
            Width over height of the picture.
        """
        normals = self._normals(self.positions)
        towards = camera.eye - self.positions
        towards /= np.maximum(np.linalg.norm(towards, axis=1, keepdims=True), 1e-12)
        height = 1000
        place = camera.project(self.positions, (round(aspect * height), height))[:, :2]
        place = np.abs(place / [aspect * height, height] - 0.5)
        # What lies behind the camera has no place; it is kept.
        inside: BoolArray = np.logical_not((place > 0.5 + _BESIDE).any(axis=1))
        seen: BoolArray = inside & ((normals * towards).sum(axis=1) > _AWAY)
        # Brows and lashes let their backs shine through.
        pieces = [
            _kept(piece, seen if piece.look["opacity"] >= 1.0 else inside) for piece in self._pieces
        ]
        triangles = self._triangles[inside[self._triangles].any(axis=1)]
        shown = tuple(piece for piece in pieces if len(piece.faces))
        return replace(self, _pieces=shown, _triangles=triangles)

    def surfaces(self, positions: npt.ArrayLike | None = None) -> list[Surface]:
        """Return what is drawn, at rest or with the vertices at `positions` (n, 3) [mm]."""
        placed = self.positions if positions is None else as_points("positions", positions)
        if placed.shape != self.positions.shape:
            raise ShapeError(
                f"positions: expected shape {self.positions.shape}, got {placed.shape}"
            )
        normals = self._normals(placed)
        return [
            Surface(
                placed[piece.vertices],
                piece.faces,
                normals=normals[piece.vertices],
                **piece.look,
            )
            for piece in self._pieces
        ]

    def camera(
        self, view: str, *, yaw: float | None = None, pitch: float | None = None, aspect: float = 1
    ) -> Camera:
        """Return the camera of a named view (see `risorius.render.views.VIEWS`).

        Parameters
        ----------
        view : str
        yaw, pitch : float, optional
            Turn of the camera instead of the view's own [deg].
        aspect : float
            Width over height of the picture.

        Raises
        ------
        ParameterError
            If there is no such view.
        LandmarkError
            If a close-up lacks its landmarks.
        """
        return camera_for(view, self.landmarks, self.positions, yaw=yaw, pitch=pitch, aspect=aspect)

    def picture(
        self,
        camera: Camera,
        *,
        size: tuple[int, int],
        weights: Mapping[str, float] | None = None,
        supersample: int = 2,
    ) -> npt.NDArray[np.uint8]:
        """Return the picture (h, w, 3) of the head, with weighted targets if `weights` are given.

        Parameters
        ----------
        camera : Camera
        size : (width, height)
        weights : mapping of str to float, optional
        supersample : int
        """
        posed = self.posed(weights) if weights else None
        return render(self.surfaces(posed), camera, size=size, supersample=supersample)

    def _normals(self, placed: FloatArray) -> FloatArray:
        single = np.zeros_like(placed)
        area_normals(placed, self._triangles, single)
        joined = self._joined
        if joined.is_identity:
            return single
        count = len(joined.first)
        whole = np.zeros((count, 3))
        for axis in range(3):
            whole[:, axis] = np.bincount(joined.representative, single[:, axis], count)
        whole /= np.maximum(np.linalg.norm(whole, axis=1, keepdims=True), 1e-12)
        return whole[joined.representative]


def _pieces(rig: Rig, positions: FloatArray) -> tuple[_Piece, ...]:
    """Cut the triangles of a rig by part and material."""
    triangles = rig.mesh.triangles
    part = np.full(len(triangles), -1, np.int32)
    if len(rig.part_of_vertex) and len(triangles):
        part = rig.part_of_vertex[triangles[:, 0]]
    material = np.full(len(triangles), -1, np.int32)
    if len(rig.mesh.materials.of_polygon):
        material = rig.mesh.materials.of_polygon[rig.mesh.triangle_polygon]
    kinds = np.unique(np.stack([part, material], axis=1), axis=0).tolist()
    names = (*rig.part_names, "")
    labels = (*rig.mesh.materials.names, "")
    painted = {
        name: not any(_has_pupil(labels[m]) for p, m in kinds if names[p] == name)
        for name in names
        if _is_eye(name)
    }
    pieces: list[_Piece] = []
    for p, m in kinds:
        faces = triangles[(part == p) & (material == m)]
        vertices, local = np.unique(faces, return_inverse=True)
        look = dict(part_look(names[p], labels[m]))
        if painted.get(names[p], False):
            look.update(_paint(positions, np.flatnonzero(rig.part_of_vertex == p), vertices))
        pieces.append(
            _Piece(vertices.astype(np.int32), local.reshape(-1, 3).astype(np.int32), look)
        )
    return tuple(pieces)


def _kept(piece: _Piece, seen: BoolArray) -> _Piece:
    """Return the triangles of a piece that have a vertex among those `seen` (n,)."""
    rows, local = np.unique(
        piece.faces[seen[piece.vertices][piece.faces].any(axis=1)], return_inverse=True
    )
    look = dict(piece.look)
    if np.ndim(look.get("colour", ())) and len(look["colour"]) == len(piece.vertices):
        look["colour"] = np.asarray(look["colour"])[rows]
    return _Piece(piece.vertices[rows], local.reshape(-1, 3).astype(np.int32), look)


def _is_eye(part: str) -> bool:
    return part.startswith("eye_")


def _has_pupil(material: str) -> bool:
    return colour_of_material(material) in (
        colour_of_material("iris"),
        colour_of_material("pupil"),
    )


def part_look(part: str, material: str) -> dict[str, Any]:
    """Return how a material on a part is drawn, as parameters of `Surface`."""
    if part.startswith(_BY_PART):
        return look_of_material(part)
    if colour_of_material(material) != colour_of_material(""):
        look = look_of_material(material)
        # Hair that is painted on the skin has nothing behind it that could shine through.
        return _painted(look) if part == "skin" and look["opacity"] < 1.0 else look
    return look_of_material("brow" if part == "attached" else part)


def _painted(hair: dict[str, Any]) -> dict[str, Any]:
    """Return the look of skin with hair on it."""
    skin = look_of_material("skin")
    share = _HAIR_ON_SKIN
    both = np.stack([skin["colour"], hair["colour"]])
    return {**skin, "colour": tuple((np.array([1.0 - share, share]) @ both).tolist())}


def _paint(positions: FloatArray, eye: npt.NDArray[np.intp], vertices: IntArray) -> dict[str, Any]:
    """Return colour and ramp for the vertices of a round eye that has no iris of its own."""
    if len(eye) < 12:
        return {}
    points = positions[eye]
    _, radius, residual = fit_sphere(points)
    if residual > _ROUND * radius:
        return {}
    colour, ramp = eye_paint(points)
    place = np.zeros((len(positions), *colour.shape[1:]))
    place[eye] = colour
    return {"colour": place[vertices], "ramp": ramp}
