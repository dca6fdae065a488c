"""The skin that muscles are fitted under."""

from __future__ import annotations

import warnings
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import numpy.typing as npt
from scipy.spatial import cKDTree

from risorius._check import BoolArray, FloatArray, IntArray
from risorius.anatomy.mechanics import Mechanics
from risorius.anatomy.outwards import unit
from risorius.anatomy.skull_fit import hidden_skin
from risorius.anatomy.template import SURE_LANDMARKS, builtin_head, warp_between
from risorius.errors import RisoriusWarning
from risorius.head.head import Head
from risorius.mesh.connectivity import Neighbours, vertex_neighbours
from risorius.mesh.core import TriMesh
from risorius.mesh.laplacian import averaging
from risorius.mesh.lips import LipSides
from risorius.mesh.normals import vertex_normals
from risorius.spatial.closest import closest_points
from risorius.spatial.raycast import Scene
from risorius.springmuscle.measure import FaceMeasure

__all__ = ["SkinSurface", "label_lips"]

# Skin within this distance of the lip line is lip rather than face, and nearer to both lips than
# the second number it belongs to neither [mm at the reference width].
_LIP, _EVEN = 45.0, 1.5
# Around the commissures both lips are one, in widths of the face (finding S7).
_CORNER = 0.11
_SMOOTHING = 8
# Outside is told from a capsule inside the head: its ends above the chin and the brows, and how
# far it lies behind the eye corners in widths of the face.
_LOW, _HIGH, _BEHIND = 8.0, 15.0, 0.75
# The neck begins so far behind the chin, in widths of the face; how fast the capsule grows there.
_NECK, _STEEP = 0.35, 2.0
# Outlines are looked for from this far outside [mm at the reference width].
_START, _REACH = 50.0, 120.0
# A point beside the skin may be moved so far [mm at the reference width].
_NEAREST = 12.0


@dataclass(frozen=True, eq=False)
class SkinSurface:
    """A welded skin of n vertices and m faces, with its face measured.

    Parameters
    ----------
    mesh : TriMesh
        Canonical frame [mm].
    measure : FaceMeasure
    lips : (n,) int8
        1 on the upper lip and above it, -1 on the lower and below, 0 elsewhere and at the corners.
    sides : (n,) int8
        The same without the neutral zone at the corners.
    hidden : (n,) bool
        Skin that lies inside: mouth bag, eye sockets.
    normals, broad_normals : (n, 3) float64
        Unit normals of the vertices, and of their surroundings.
    """

    mesh: TriMesh
    measure: FaceMeasure
    lips: npt.NDArray[np.int8]
    sides: npt.NDArray[np.int8]
    hidden: BoolArray
    normals: FloatArray
    broad_normals: FloatArray

    @staticmethod
    def build(mechanics: Mechanics) -> SkinSurface:
        """Measure the skin of a head whose moving parts are known.

        Landmarks that the head lacks are carried over from the built-in head, with a warning.

        Raises
        ------
        LandmarkError
            If outer eye corners or inner lips are missing, or fewer than eight landmarks are known.
        """
        mesh = mechanics.head.skin.mesh
        measure = _completed(FaceMeasure.of(mechanics.head.landmarks), mechanics.head)
        normals = vertex_normals(mesh.positions, mesh.faces)
        average, broad = averaging(mesh.faces, mesh.vertex_count), normals
        for _ in range(_SMOOTHING):
            broad = average @ broad
        lips, sides = label_lips(mechanics.lips, measure)
        hidden = hidden_skin(mechanics.lips, mechanics.margins)
        return SkinSurface(mesh, measure, lips, sides, hidden, normals, unit(broad))

    @property
    def scale(self) -> float:
        """Millimetres of this head per millimetre of a recipe."""
        return self.measure.scale

    @cached_property
    def visible(self) -> IntArray:
        """Faces (v,) that are seen from outside: none in the mouth or in the sockets."""
        return np.flatnonzero(~self.hidden[self.mesh.faces].any(axis=1)).astype(np.int32)

    @cached_property
    def corners(self) -> FloatArray:
        """Corners (v, 3, 3) of the visible faces [mm]."""
        return self.mesh.positions[self.mesh.faces[self.visible]]

    @cached_property
    def face_normals(self) -> FloatArray:
        """Unit normals (v, 3) of the visible faces, 0 where they have no area."""
        a, b, c = self.corners.transpose(1, 0, 2)
        return unit(np.cross(b - a, c - a))

    @cached_property
    def face_turns(self) -> FloatArray:
        """Cosine (v,) of the angle between a visible face's normal and its surroundings'."""
        around = unit(self.broad_normals[self.mesh.faces[self.visible]].mean(axis=1))
        return np.einsum("vd,vd->v", self.face_normals, around)

    @cached_property
    def face_radii(self) -> FloatArray:
        """Distance (v,) of the farthest corner of each visible face from its middle [mm]."""
        middle = self.corners.mean(axis=1, keepdims=True)
        return np.linalg.norm(self.corners - middle, axis=2).max(axis=1)

    @cached_property
    def face_tree(self) -> cKDTree:
        """Middles of the visible faces."""
        return cKDTree(self.corners.mean(axis=1))

    @cached_property
    def scene(self) -> Scene:
        """The visible faces."""
        return Scene([TriMesh(self.mesh.positions, self.mesh.faces[self.visible])])

    @cached_property
    def neighbours(self) -> Neighbours:
        """Neighbours of every vertex."""
        return vertex_neighbours(self.mesh.faces, self.mesh.vertex_count)

    def outwards(self, points: FloatArray) -> FloatArray:
        """Return unit directions (q, 3) out of the head at `points` (q, 3).

        Away from the axis of an upright capsule inside the face: smooth where normals are not.
        """
        marks, scale = self.measure.landmarks, self.scale
        brow = max(float(marks[name][1]) for name in ("3.7", "4.1") if name in marks)
        chin, width = marks["2.1"], self.measure.width
        # Behind the chin the axis goes on down the neck.
        neck = np.maximum(chin[2] - _NECK * width - points[:, 2], 0.0)
        low = chin[1] + _LOW * scale - _STEEP * neck
        centre = np.zeros_like(points)
        centre[:, 1] = np.clip(points[:, 1], low, brow + _HIGH * scale)
        centre[:, 2] = float(marks["3.7"][2]) - _BEHIND * self.measure.width
        return unit(points - centre)

    def project(self, points: FloatArray) -> tuple[FloatArray, BoolArray]:
        """Lay `points` (q, 3) of an outline on the skin, from outside; tell which (q,) found it.

        They come in along `outwards`, else they take the nearest skin if there is some near; what
        finds none keeps its place.
        """
        ahead, reach = self.outwards(points), _START * self.scale
        start = points + reach * ahead
        hits = self.scene.cast(start, -ahead, max_distance=_REACH * self.scale)
        found = np.where(hits.hit[:, None], np.nan_to_num(hits.positions), points)
        missed = np.flatnonzero(~hits.hit)
        if not len(missed):
            return found, hits.hit
        nearest = closest_points(self.scene, points[missed])
        near = nearest.distance < _NEAREST * self.scale
        found[missed[near]] = nearest.positions[near]
        met = hits.hit.copy()
        met[missed[near]] = True
        return found, met


def _completed(measure: FaceMeasure, head: Head) -> FaceMeasure:
    """Return `measure` with the landmarks that outlines hang on, guessed where missing."""
    template = builtin_head().landmarks
    missing = [name for name in SURE_LANDMARKS if name not in measure.landmarks]
    if not missing:
        return measure
    warp = warp_between(template, head.landmarks)
    guessed = dict(zip(missing, warp(template.positions(missing))))
    warnings.warn(
        f"landmarks: {', '.join(missing)} are guessed from the others, muscles there may lie "
        "wrong; add them to the landmark file",
        RisoriusWarning,
        stacklevel=4,
    )
    return replace(measure, landmarks={**measure.landmarks, **guessed})


def label_lips(
    lips: LipSides, measure: FaceMeasure
) -> tuple[npt.NDArray[np.int8], npt.NDArray[np.int8]]:
    """Return the labels (n,) of `SkinSurface.lips` and `SkinSurface.sides`."""
    apart = np.nan_to_num(lips.to_lower - lips.to_upper, nan=0.0, posinf=0.0, neginf=0.0)
    near = lips.distance < _LIP * measure.scale
    sides = np.where(near & (np.abs(apart) > _EVEN * measure.scale), np.sign(apart), 0.0)
    labels = np.where(lips.to_corner < _CORNER * measure.width, 0.0, sides)
    return labels.astype(np.int8), sides.astype(np.int8)
