"""A mesh exactly as its file holds it: polygons, texture coordinates, names."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from types import MappingProxyType

import numpy as np

from risorius._check import FloatArray, IntArray, as_points, require_indices
from risorius.errors import ShapeError
from risorius.mesh.core import TriMesh

__all__ = ["Labels", "PolygonMesh"]

_NO_INDICES: IntArray = np.zeros(0, np.int32)
_NO_UVS: FloatArray = np.zeros((0, 2))


@dataclass(frozen=True, eq=False)
class Labels:
    """One name per polygon, for example its object, group or material.

    Parameters
    ----------
    names : sequence of str
        The distinct names in order of first appearance.
    of_polygon : (m,) int32
        Index into `names` for each polygon, -1 where it has none.
    """

    names: tuple[str, ...] = ()
    of_polygon: IntArray = field(default_factory=lambda: _NO_INDICES)

    def polygons(self, name: str) -> IntArray:
        """Return the indices (k,) of the polygons that carry `name`."""
        if name not in self.names:
            return _NO_INDICES
        return np.flatnonzero(self.of_polygon == self.names.index(name)).astype(np.int32)


@dataclass(frozen=True, eq=False)
class PolygonMesh:
    """Polygon mesh in the frame and unit of its file; nothing of the file's order is lost.

    Parameters
    ----------
    positions : (n, 3) float64
        Vertices in file order [file unit].
    corners : (c,) int32
        Vertex of every polygon corner, polygon after polygon.
    offsets : (m + 1,) int32
        Polygon f owns the corners ``offsets[f]:offsets[f + 1]``.
    uvs : (k, 2) float64
        Texture coordinates, may be empty.
    uv_corners : (c,) int32
        Texture coordinate of every corner, -1 where it has none; empty without `uvs`.
    objects, groups, materials : Labels
        Names per polygon.
    targets : mapping of str to (n, 3) float64
        Morph targets found in the file, as displacements [file unit].
    """

    positions: FloatArray
    corners: IntArray
    offsets: IntArray
    uvs: FloatArray = field(default_factory=lambda: _NO_UVS)
    uv_corners: IntArray = field(default_factory=lambda: _NO_INDICES)
    objects: Labels = field(default_factory=Labels)
    groups: Labels = field(default_factory=Labels)
    materials: Labels = field(default_factory=Labels)
    targets: Mapping[str, FloatArray] = field(default_factory=lambda: MappingProxyType({}))

    def __post_init__(self) -> None:
        object.__setattr__(self, "positions", as_points("positions", self.positions))
        n, c, m = len(self.positions), len(self.corners), len(self.offsets) - 1
        if m < 0 or self.offsets[0] != 0 or self.offsets[-1] != c:
            raise ShapeError("offsets: must start at 0 and end at the number of corners")
        if (np.diff(self.offsets) < 0).any():
            raise ShapeError("offsets: must not decrease")
        require_indices("corners", self.corners, count=n)
        if len(self.uv_corners) not in (0, c):
            raise ShapeError(f"uv_corners: expected {c} entries or none")
        require_indices("uv_corners", self.uv_corners, count=len(self.uvs), low=-1)
        for name, labels in (
            ("objects", self.objects),
            ("groups", self.groups),
            ("materials", self.materials),
        ):
            if len(labels.of_polygon) not in (0, m):
                raise ShapeError(f"{name}: expected {m} entries or none")
            require_indices(name, labels.of_polygon, count=len(labels.names), low=-1)
        for name, deltas in self.targets.items():
            if deltas.shape != self.positions.shape:
                raise ShapeError(f"target {name!r}: expected shape {self.positions.shape}")

    @property
    def vertex_count(self) -> int:
        """Number of vertices."""
        return len(self.positions)

    @property
    def polygon_count(self) -> int:
        """Number of polygons."""
        return len(self.offsets) - 1

    @cached_property
    def triangle_corners(self) -> IntArray:
        """(t, 3) corner indices of the fan triangulation (from each polygon's first corner)."""
        sizes = np.diff(self.offsets)
        fans = np.maximum(sizes - 2, 0)
        polygon = np.repeat(np.arange(len(sizes)), fans)
        first = np.cumsum(fans) - fans
        step = np.arange(int(fans.sum())) - np.repeat(first, fans)
        start = self.offsets[:-1][polygon]
        return np.stack([start, start + step + 1, start + step + 2], axis=1).astype(np.int32)

    @cached_property
    def triangle_polygon(self) -> IntArray:
        """(t,) polygon that each triangle of `triangles` comes from."""
        fans = np.maximum(np.diff(self.offsets) - 2, 0)
        return np.repeat(np.arange(len(fans)), fans).astype(np.int32)

    @cached_property
    def triangles(self) -> IntArray:
        """(t, 3) vertex indices of the fan triangulation, in polygon order."""
        return np.ascontiguousarray(self.corners[self.triangle_corners])

    def tri_mesh(self) -> TriMesh:
        """Return the fan triangulation over all vertices [file unit]."""
        return TriMesh(self.positions, self.triangles)

    @staticmethod
    def from_polygons(positions: FloatArray, polygons: Sequence[Sequence[int]]) -> PolygonMesh:
        """Build a mesh without texture coordinates from vertex index lists."""
        sizes = [len(polygon) for polygon in polygons]
        flat = [index for polygon in polygons for index in polygon]
        return PolygonMesh(
            np.ascontiguousarray(positions, dtype=np.float64),
            np.array(flat, np.int32),
            np.concatenate([[0], np.cumsum(sizes)]).astype(np.int32),
        )
