"""Landmarks bound to a mesh."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.spatial import cKDTree

from risorius._check import FloatArray
from risorius.errors import LandmarkError
from risorius.landmarks.feature_points import mirror_name
from risorius.mesh.polygon_mesh import PolygonMesh

__all__ = ["Landmark", "LandmarkSet", "LandmarkSpec", "resolve"]

# A position farther off the mesh than this share of its size belongs to another mesh or unit.
_FARTHEST = 0.1
_BARY_TOLERANCE = 1e-3


@dataclass(frozen=True)
class LandmarkSpec:
    """A landmark as written in a file: exactly one of the three places is given.

    `face` counts the triangles of the fan triangulation, `position` is in the file's unit.
    """

    vertex: int | None = None
    face: int | None = None
    bary: tuple[float, float, float] | None = None
    position: tuple[float, float, float] | None = None
    confidence: str = ""


@dataclass(frozen=True)
class Landmark:
    """A named point that follows the mesh: a weighted sum of vertices."""

    name: str
    vertices: tuple[int, ...]
    weights: tuple[float, ...]
    confidence: str = ""

    @property
    def vertex(self) -> int:
        """The vertex with the largest weight."""
        return self.vertices[int(np.argmax(self.weights))]

    def at(self, positions: FloatArray) -> FloatArray:
        """Return the landmark's place (3,) on a mesh with `positions` (n, 3)."""
        return np.asarray(self.weights) @ positions[list(self.vertices)]


class LandmarkSet(Mapping[str, Landmark]):
    """Named landmarks on one mesh.

    Parameters
    ----------
    landmarks : iterable of Landmark
    positions : (n, 3) float64
        The mesh's vertices at rest, in the frame that the set shall speak.
    """

    def __init__(self, landmarks: Iterable[Landmark], positions: FloatArray) -> None:
        self._landmarks = {landmark.name: landmark for landmark in landmarks}
        self._positions = positions

    def __getitem__(self, name: str) -> Landmark:
        try:
            return self._landmarks[name]
        except KeyError:
            raise LandmarkError(f"landmarks: {name!r} is missing; add it to the file") from None

    def get(self, name: str, default: Any = None) -> Any:
        """Return landmark `name`, or `default` without it."""
        return self._landmarks.get(name, default)

    def __contains__(self, name: object) -> bool:
        return name in self._landmarks

    def __iter__(self) -> Iterator[str]:
        return iter(self._landmarks)

    def __len__(self) -> int:
        return len(self._landmarks)

    def position(self, name: str) -> FloatArray:
        """Return the rest position (3,) of landmark `name`."""
        return self[name].at(self._positions)

    def positions(self, names: Iterable[str]) -> FloatArray:
        """Return the rest positions (k, 3) of landmarks `names`."""
        return np.array([self.position(name) for name in names]).reshape(-1, 3)

    def vertex(self, name: str) -> int:
        """Return the vertex nearest to landmark `name`."""
        return self[name].vertex

    def missing(self, names: Iterable[str]) -> tuple[str, ...]:
        """Return those of `names` that the set lacks."""
        return tuple(name for name in names if name not in self)

    def common(self, other: Iterable[str]) -> tuple[str, ...]:
        """Return the names that `other` has too, in this set's order."""
        wanted = set(other)
        return tuple(name for name in self if name in wanted)

    def at(self, positions: FloatArray) -> LandmarkSet:
        """Return the same landmarks on the mesh at other `positions`."""
        return LandmarkSet(self.values(), positions)

    def renamed(self, names: Mapping[str, str]) -> LandmarkSet:
        """Return the set with the names in `names` replaced."""
        marks = [
            Landmark(names.get(mark.name, mark.name), mark.vertices, mark.weights, mark.confidence)
            for mark in self.values()
        ]
        return LandmarkSet(marks, self._positions)

    def flipped(self) -> LandmarkSet:
        """Return the set with left and right names exchanged."""
        return self.renamed({name: mirror_name(name) for name in self})


def resolve(specs: Mapping[str, LandmarkSpec], mesh: PolygonMesh) -> LandmarkSet:
    """Bind landmarks as written in a file to the mesh they were made for.

    Raises
    ------
    LandmarkError
        If an index is out of range, barycentric coordinates do not sum to 1, or a position lies
        far off the mesh (over a tenth of its size); the message names the landmark.
    """
    if not len(mesh.triangles):
        raise LandmarkError("landmarks: the mesh has no faces to carry landmarks")
    nearest = _Nearest(mesh)
    landmarks: list[Landmark] = []
    for name, spec in specs.items():
        if spec.vertex is not None:
            landmarks.append(_at_vertex(name, spec.vertex, spec.confidence, mesh))
        elif spec.face is not None and spec.bary is not None:
            landmarks.append(_on_triangle(name, spec.face, spec.bary, spec.confidence, mesh))
        elif spec.position is not None:
            vertex = nearest.vertex(name, spec.position)
            landmarks.append(Landmark(name, (vertex,), (1.0,), spec.confidence))
        else:
            raise LandmarkError(f"landmarks: {name!r} has no vertex, face + bary or position")
    return LandmarkSet(landmarks, mesh.positions)


def _at_vertex(name: str, vertex: int, confidence: str, mesh: PolygonMesh) -> Landmark:
    if not 0 <= vertex < mesh.vertex_count:
        raise LandmarkError(
            f"landmarks: {name!r} names vertex {vertex}, the mesh has {mesh.vertex_count}; "
            "is this the landmark file of another mesh?"
        )
    return Landmark(name, (vertex,), (1.0,), confidence)


def _on_triangle(
    name: str, face: int, bary: tuple[float, float, float], confidence: str, mesh: PolygonMesh
) -> Landmark:
    if not 0 <= face < len(mesh.triangles):
        raise LandmarkError(
            f"landmarks: {name!r} names triangle {face}, the mesh has {len(mesh.triangles)}; "
            "is this the landmark file of another mesh?"
        )
    if not abs(sum(bary) - 1.0) <= _BARY_TOLERANCE or min(bary) < -_BARY_TOLERANCE:
        raise LandmarkError(
            f"landmarks: {name!r} has bary {list(bary)}; the three shares must be 0 or more and "
            "sum to 1"
        )
    corners = tuple(int(vertex) for vertex in mesh.triangles[face])
    return Landmark(name, corners, bary, confidence)


class _Nearest:
    """Finds the vertex, among those that faces use, nearest to a position."""

    def __init__(self, mesh: PolygonMesh) -> None:
        self._used = np.unique(mesh.triangles)
        used_positions = mesh.positions[self._used]
        self._tree = cKDTree(used_positions)
        self._size = float(np.ptp(used_positions, axis=0).max())

    def vertex(self, name: str, position: tuple[float, float, float]) -> int:
        if not np.isfinite(position).all():
            raise LandmarkError(f"landmarks: {name!r} at {list(position)} is not finite")
        distance, row = self._tree.query(np.asarray(position))
        if distance > _FARTHEST * self._size:
            raise LandmarkError(
                f"landmarks: {name!r} at {list(position)} lies {distance:.3g} off the mesh (size "
                f"{self._size:.3g}); positions must be in the mesh's own unit and axes"
            )
        return int(self._used[row])
