"""What the skin hangs on: anchors found by rays along its normals (spec 2.10)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from risorius._check import BoolArray, FloatArray, IntArray
from risorius.anatomy.mechanics import Mechanics
from risorius.errors import MeshError
from risorius.layered.faithful.anatomy import Anatomy
from risorius.layered.faithful.parameters import FaithfulParameters
from risorius.mesh.core import TriMesh
from risorius.mesh.normals import vertex_normals
from risorius.mesh.surface_point import SurfacePoints
from risorius.spatial.closest import closest_points
from risorius.spatial.raycast import Scene

__all__ = ["Anchors", "bind_skin", "jaw_side"]

# Around the mouth skin belongs to one lip, unless both are about as near [built-in mm].
_LIP, _EVEN = 45.0, 1.5
# Lid vertices that follow their margin by more than this share hang on nothing.
_LID = 0.25
# Fewest anchored vertices of the face's front, as share.
_FEWEST = 0.3
_UPPER, _LOWER = 1, -1


@dataclass(frozen=True, eq=False)
class Anchors:
    """Skin vertices and the points beneath that they hang on.

    Parameters
    ----------
    vertices : (a,) int32
        Of the skin, ascending.
    points : SurfacePoints
        (a,) of them on the faces of the anatomy.
    owners : (a,) int32
        Number of the surface of each, in the order of `names`.
    names : tuple of str
    lengths : (a,) float64
        Distances at rest [mm].
    """

    vertices: IntArray
    points: SurfacePoints
    owners: IntArray
    names: tuple[str, ...]
    lengths: FloatArray

    def places(self, positions: FloatArray, faces: IntArray) -> FloatArray:
        """Return where the points (a, 3) are on an anatomy with `positions` [mm]."""
        return self.points.interpolate(positions, faces)

    def on(self, *names: str) -> BoolArray:
        """Return which anchors (a,) hang on the surfaces `names`."""
        return np.isin(self.owners, [self.names.index(name) for name in names])


def jaw_side(anatomy: Anatomy, mouth_height: float) -> IntArray:
    """Return for every face (m,) of the anatomy which lip must not hang on it.

    1 for what goes with the jaw (not for the upper lip), -1 for what goes with the skull, 0 for
    what both may hang on: muscles that lie on both. A ring is parted at the height of the mouth.
    """
    result = np.zeros(len(anatomy.faces), np.int32)
    result[anatomy.surfaces["cranium"].rows] = _LOWER
    result[anatomy.surfaces["mandible"].rows] = _UPPER
    supports = anatomy.supports()
    for laid in anatomy.muscles:
        rows = laid.surface.rows
        if laid.muscle.kind == "sphincter":
            height = anatomy.positions[anatomy.faces[rows]].mean(axis=1)[:, 1]
            result[rows] = np.where(height < mouth_height, _UPPER, _LOWER)
            continue
        beneath = supports[laid.name] & {"cranium", "mandible"}
        if beneath == {"mandible"}:
            result[rows] = _UPPER
        elif beneath == {"cranium"}:
            result[rows] = _LOWER
    return result


def bind_skin(
    anatomy: Anatomy, mechanics: Mechanics, scale: float, parameters: FaithfulParameters
) -> Anchors:
    """Hang the skin of a head on what lies beneath.

    A ray outwards looks for a muscle that the skin has sunk into, rays inwards for the muscles of
    each layer, superficial before deep, and for bone; the first layer counts, not the nearest hit.

    Parameters
    ----------
    anatomy : Anatomy
        Fitted into the head.
    mechanics : Mechanics
        Of the head.
    scale : float
        Size of the head over that of the built-in one.
    parameters : FaithfulParameters

    Raises
    ------
    MeshError
        If less than 30 % of the front of the face hang on anything.
    """
    finder = _Finder(anatomy, mechanics, scale, parameters)
    thickest = max((laid.muscle.thickness for laid in anatomy.muscles), default=0.0) * scale
    layers = anatomy.layers
    names = tuple(laid.name for layer in layers for laid in layer)
    finder.look(names, outwards=True, reach=2.0 * thickest)
    reach = parameters.anchor_reach * scale
    for layer in reversed(layers):
        finder.look(tuple(laid.name for laid in layer), outwards=False, reach=reach)
    finder.look(("cranium", "mandible"), outwards=False, reach=reach)
    finder.hang_lining()
    return finder.anchors()


class _Finder:
    def __init__(
        self, anatomy: Anatomy, mechanics: Mechanics, scale: float, p: FaithfulParameters
    ) -> None:
        self._anatomy, self._mechanics, self._scale, self._p = anatomy, mechanics, scale, p
        mesh = mechanics.head.skin.mesh
        self._mesh = mesh
        self._normals = vertex_normals(mesh.positions, mesh.faces)
        self._face = np.full(mesh.vertex_count, -1, np.int32)
        self._bary = np.zeros((mesh.vertex_count, 3))
        self._scene = Scene([TriMesh(anatomy.positions, anatomy.faces)])
        lips = mechanics.lips
        height = float(mechanics.head.landmarks.positions(("2.2", "2.3"))[:, 1].mean())
        self._forbidden = jaw_side(anatomy, height)
        even = np.abs(np.nan_to_num(lips.to_upper - lips.to_lower)) < _EVEN * scale
        sided = (lips.distance < _LIP * scale) & ~lips.corner & ~even
        self._lip = np.where(sided, np.where(lips.upper, _UPPER, _LOWER), 0)
        self._free = (self._normals != 0.0).any(axis=1) & ~lips.inside
        for side, lids in mechanics.lids.items():
            self._free &= ~mechanics.margins[side].slit.inside
            self._free[lids.vertices[lids.weight > _LID]] = False

    def look(self, names: tuple[str, ...], *, outwards: bool, reach: float) -> None:
        if not names:
            return
        wanted = np.zeros(len(self._anatomy.faces), bool)
        wanted[self._anatomy.rows_of(names)] = True
        for lip in (0, _UPPER, _LOWER):
            rows = np.flatnonzero(self._free & (self._face < 0) & (self._lip == lip))
            mask = wanted & ((self._forbidden != lip) | (lip == 0))
            if not len(rows) or not mask.any():
                continue
            way = self._normals[rows] * (1.0 if outwards else -1.0)
            hits = self._scene.cast(
                self._mesh.positions[rows], way, max_distance=reach, face_mask=mask
            )
            turned = np.einsum("nd,nd->n", np.nan_to_num(hits.normals), self._normals[rows])
            good = hits.hit & (turned > self._p.facing)
            self._face[rows[good]], self._bary[rows[good]] = hits.face[good], hits.bary[good]

    def hang_lining(self) -> None:
        """Hang the lining of the mouth, away from the lips, on the bone of its lip."""
        lips = self._mechanics.lips
        deep = lips.inside & (lips.distance > self._p.lining_gap * self._scale)
        for lip, name in ((lips.upper, "cranium"), (lips.lower, "mandible")):
            rows = np.flatnonzero(deep & lip & np.isfinite(lips.distance))
            if not len(rows):
                continue
            faces = self._anatomy.surfaces[name].rows
            bone = TriMesh(self._anatomy.positions, self._anatomy.faces[faces])
            near = closest_points(bone, self._mesh.positions[rows]).surface_points()
            self._face[rows], self._bary[rows] = faces[near.faces], near.bary

    def anchors(self) -> Anchors:
        mesh, marks = self._mesh, self._mechanics.head.landmarks
        front = (mesh.positions[:, 2] > self._mechanics.jaw.hinge[2]) & self._free
        front &= mesh.positions[:, 1] > marks.position("2.1")[1]
        share = float((self._face[front] >= 0).mean()) if front.any() else 1.0
        if share < _FEWEST:
            raise MeshError(
                f"skin: {share:.0%} of the front of the face hang on muscle or bone, "
                f"{_FEWEST:.0%} are needed; the skull does not fit, check the landmarks"
            )
        vertices = np.flatnonzero(self._face >= 0).astype(np.int32)
        points = SurfacePoints(self._face[vertices], self._bary[vertices])
        names = tuple(self._anatomy.surfaces)
        owner = np.zeros(len(self._anatomy.faces), np.int32)
        for number, surface in enumerate(self._anatomy.surfaces.values()):
            owner[surface.rows] = number
        places = points.interpolate(self._anatomy.positions, self._anatomy.faces)
        lengths = np.linalg.norm(mesh.positions[vertices] - places, axis=1)
        return Anchors(vertices, points, owner[points.faces], names, lengths)
