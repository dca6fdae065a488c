"""Landmarks bound to a mesh."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from risorius._check import FloatArray, IntArray
from risorius.errors import LandmarkError
from risorius.landmarks.feature_points import mirror_name
from risorius.mesh.polygon_mesh import PolygonMesh

__all__ = ["Landmark", "LandmarkSet", "LandmarkSpec", "resolve"]


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
        If an index is out of range or a position lies far off the mesh (over a tenth of the
        mesh's size); the message names the landmark.
    """
    triangles: IntArray = mesh.triangles
    used = np.unique(triangles)
    if not len(used):
        raise LandmarkError("landmarks: the mesh has no faces to carry landmarks")
    tree = cKDTree(mesh.positions[used])
    size = float(np.ptp(mesh.positions[used], axis=0).max())
    landmarks: list[Landmark] = []
    for name, spec in specs.items():
        if spec.vertex is not None:
            if not 0 <= spec.vertex < mesh.vertex_count:
                raise LandmarkError(
                    f"landmarks: {name!r} names vertex {spec.vertex}, the mesh has "
                    f"{mesh.vertex_count}; is this the landmark file of another mesh?"
                )
            landmarks.append(Landmark(name, (spec.vertex,), (1.0,), spec.confidence))
        elif spec.face is not None and spec.bary is not None:
            if not 0 <= spec.face < len(triangles):
                raise LandmarkError(
                    f"landmarks: {name!r} names triangle {spec.face}, the mesh has "
                    f"{len(triangles)}; is this the landmark file of another mesh?"
                )
            corners = tuple(int(v) for v in triangles[spec.face])
            landmarks.append(Landmark(name, corners, spec.bary, spec.confidence))
        elif spec.position is not None:
            distance, nearest = tree.query(np.asarray(spec.position))
            if distance > 0.1 * size:
                raise LandmarkError(
                    f"landmarks: {name!r} at {list(spec.position)} lies {distance:.3g} off the "
                    f"mesh (size {size:.3g}); positions must be in the mesh's own unit and axes"
                )
            landmarks.append(Landmark(name, (int(used[nearest]),), (1.0,), spec.confidence))
        else:
            raise LandmarkError(f"landmarks: {name!r} has no vertex, face + bary or position")
    return LandmarkSet(landmarks, mesh.positions)
