"""The muscles of a layered face as bodies that can be drawn, at rest and in a pose."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from risorius._check import FloatArray, IntArray
from risorius.anatomy.outwards import outwards, unit
from risorius.controls.control import Pose
from risorius.layered.drawing import SkullSpace
from risorius.layered.face import LayeredFace
from risorius.layered.fibres import grid_faces, refine
from risorius.layered.muscle import Muscle, Ring
from risorius.mesh.core import TriMesh

__all__ = ["MuscleShapes"]

_ACROSS = 5
_AROUND, _ROWS = 36, 4
# A sphincter lies this deep below the skin [mm].
_DEPTH = 3.0
_ENDS = 0.3
# Shares of the thickness above and below the fibres.
_ABOVE, _BELOW = 0.7, 0.3


@dataclass(frozen=True, eq=False)
class _Circle:
    """Vertices of the skin (h, w) above the grid of a sphincter, and the way down to it."""

    vertices: IntArray
    offset: FloatArray


@dataclass(frozen=True, eq=False)
class _Body:
    """How a body stands on its grid (h, w, 3): `lift` of the upper side, `times` refined."""

    lift: FloatArray
    refined: bool

    def vertices(self, grid: FloatArray) -> FloatArray:
        if self.refined:
            grid = refine(grid, 2)[::2]
        return np.concatenate(
            [(grid + _ABOVE * self.lift).reshape(-1, 3), (grid - _BELOW * self.lift).reshape(-1, 3)]
        )

    def faces(self) -> IntArray:
        rows, columns = self.lift.shape[:2]
        top = grid_faces(rows, columns)
        return np.concatenate([top, top[:, ::-1] + rows * columns]).astype(np.int32)


@dataclass(frozen=True, eq=False)
class MuscleShapes:
    """Bodies of all muscles of a face.

    Parameters
    ----------
    face : LayeredFace
    meshes : mapping of str to TriMesh
        At rest, by muscle and side; canonical frame [mm].
    """

    face: LayeredFace
    meshes: Mapping[str, TriMesh]
    _bodies: Mapping[str, _Body]
    _circles: Mapping[str, _Circle]

    @staticmethod
    def of(face: LayeredFace, space: SkullSpace) -> MuscleShapes:
        """Return the bodies of the muscles of `face`."""
        circles: dict[str, _Circle] = {}
        meshes: dict[str, TriMesh] = {}
        bodies: dict[str, _Body] = {}
        for muscle in face.muscle_map.muscles:
            names = [muscle.name]
            if muscle.mirror:
                names = [f"{muscle.name}_l", f"{muscle.name}_r"]
            for name, side in zip(names, (muscle, muscle.mirrored())):
                if name in face.fibres:
                    grid = face.fibres[name]
                elif isinstance(muscle.shape, Ring):
                    circles[name] = _circle(side, face, space)
                    grid = face.skin.positions[circles[name].vertices] + circles[name].offset
                else:
                    continue
                thickness = muscle.thickness * face.skin.scale
                bodies[name] = _body(grid, thickness, closed=name in circles)
                meshes[name] = TriMesh(bodies[name].vertices(grid), bodies[name].faces())
        return MuscleShapes(face, meshes, bodies, circles)

    def posed(self, pose: Pose, positions: FloatArray) -> dict[str, FloatArray]:
        """Return the vertices (k, 3) of every body in a pose, by muscle and side [mm].

        Parameters
        ----------
        pose : Pose
        positions : (n, 3) float64
            Input vertices of the head in that pose [mm].
        """
        grids = self.face.posed_fibres(pose)
        if self._circles:
            skin = positions[self.face.head.skin.first_source()]
            for name, circle in self._circles.items():
                grids[name] = skin[circle.vertices] + circle.offset
        return {name: self._bodies[name].vertices(grids[name]) for name in self.meshes}


def _body(grid: FloatArray, thickness: float, *, closed: bool) -> _Body:
    """Return the body over a grid: fullest in the middle, flat at the rim."""
    refined = not closed and 1 < grid.shape[1] < _ACROSS
    if refined:
        grid = refine(grid, 2)[::2]
    rows, columns = grid.shape[:2]
    across = np.linspace(-1.0, 1.0, columns) if columns > 1 else np.zeros(1)
    bulge = np.sqrt(np.maximum(1.0 - across**2, 0.0))[None, :]
    if not closed:
        along = np.linspace(0.0, 1.0, rows)
        bulge = bulge * (_ENDS + (1.0 - _ENDS) * np.sqrt(np.sin(np.pi * along)))[:, None]
    return _Body((thickness * bulge)[..., None] * _normals(grid), refined)


def _normals(grid: FloatArray) -> FloatArray:
    """Return the outward unit normals (h, w, 3) of a grid."""
    outward = outwards(grid.reshape(-1, 3)).reshape(grid.shape)
    if min(grid.shape[:2]) < 2:
        return outward
    normal = unit(np.cross(np.gradient(grid, axis=0), np.gradient(grid, axis=1)))
    sign = np.sign(np.einsum("hwd,hwd->hw", normal, outward))
    return normal * np.where(sign == 0.0, 1.0, sign)[..., None]


def _circle(muscle: Muscle, face: LayeredFace, space: SkullSpace) -> _Circle:
    ring = muscle.shape
    assert isinstance(ring, Ring)
    angle = np.linspace(0.0, 2.0 * np.pi, _AROUND + 1)[:, None]
    share = np.linspace(0.0, 1.0, _ROWS)
    half = ring.inner[:, None] * (1.0 - share) + ring.outer[:, None] * share
    flat = np.stack(
        [half[0] * np.cos(angle), half[1] * np.sin(angle), np.zeros((_AROUND + 1, _ROWS))], axis=2
    )
    places = space.to_head((ring.centre + flat).reshape(-1, 3))
    skin = face.skin
    seen = np.flatnonzero(~skin.hidden)
    # Seen from the front, because the eye and the mouth lie between the skin and its other side.
    front = seen[skin.positions[seen][:, 2] > places[:, 2].min() - 25.0 * skin.scale]
    tree = cKDTree(skin.positions[front][:, :2])
    vertices = front[tree.query(places[:, :2])[1]].reshape(_AROUND + 1, _ROWS)
    aside = places.reshape(_AROUND + 1, _ROWS, 3)[..., :2] - skin.positions[vertices][..., :2]
    offset = -_DEPTH * skin.scale * skin.broad_normals[vertices]
    offset[..., :2] += aside
    return _Circle(vertices.astype(np.int32), offset)
