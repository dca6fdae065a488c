"""All primitives of a glTF file as one triangle mesh, in node order."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from risorius._check import FloatArray
from risorius.io.gltf.primitives import Piece
from risorius.mesh.polygon_mesh import Labels, PolygonMesh
from risorius.rig.rig import MorphTarget

__all__ = ["Soup", "joined"]

LongArray = npt.NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Soup:
    """Vertices and triangles as the file stores them, split at seams and material borders.

    Parameters
    ----------
    positions : (n, 3) float64
    triangles : (t, 3) int64
    uvs : (n, 2) float64
        Zero where `has_uv` is false.
    has_uv : (n,) bool
    source : (n,) int64 or None
        Input vertex of each vertex, if the whole file tells it.
    objects, materials : Labels
        Per triangle.
    targets : dict
        Target name -> vertices (k,) and displacements (k, 3).
    """

    positions: FloatArray
    triangles: LongArray
    uvs: FloatArray
    has_uv: npt.NDArray[np.bool_]
    source: LongArray | None
    objects: Labels
    materials: Labels
    targets: dict[str, tuple[LongArray, FloatArray]]

    def mesh(self) -> PolygonMesh:
        """Return the triangles as they stand, without morph targets."""
        corners = self.triangles.ravel().astype(np.int32)
        offsets = np.arange(0, len(corners) + 1, 3, dtype=np.int32)
        return PolygonMesh(
            self.positions,
            corners,
            offsets,
            uvs=self.uvs if self.has_uv.any() else np.zeros((0, 2)),
            uv_corners=self.uv_corners(corners),
            objects=self.objects,
            materials=self.materials,
        )

    def uv_corners(self, corners: npt.NDArray[np.integer]) -> npt.NDArray[np.int32]:
        """Return the texture coordinate (c,) of `corners` (c,) given by vertices of this soup."""
        if not self.has_uv.any():
            return np.zeros(0, np.int32)
        return np.where(self.has_uv[corners], corners, -1).astype(np.int32)

    def morph_targets(self, vertex: LongArray) -> tuple[MorphTarget, ...]:
        """Return the targets on a mesh whose vertex `vertex` (n,) each vertex here is."""
        result: list[MorphTarget] = []
        for name, (rows, deltas) in self.targets.items():
            vertices, first = np.unique(vertex[rows], return_index=True)
            result.append(MorphTarget(name, vertices.astype(np.int32), deltas[first]))
        return tuple(result)


def joined(pieces: Sequence[Piece]) -> Soup:
    """Put pieces one behind the other; targets of one name become one."""
    counts = [len(piece.positions) for piece in pieces]
    starts = np.concatenate([[0], np.cumsum(counts)])[:-1].tolist()
    has_uv = [np.full(n, piece.uvs is not None) for n, piece in zip(counts, pieces)]
    uvs = [np.zeros((n, 2)) if piece.uvs is None else piece.uvs for n, piece in zip(counts, pieces)]
    sources = [piece.source for piece in pieces if piece.source is not None]
    parts: dict[str, list[tuple[LongArray, FloatArray]]] = {}
    for start, piece in zip(starts, pieces):
        for name, (rows, deltas) in piece.targets.items():
            parts.setdefault(name, []).append((rows + start, deltas))
    triangle_counts = [len(piece.triangles) for piece in pieces]
    return Soup(
        np.concatenate([piece.positions for piece in pieces]),
        np.concatenate([piece.triangles + start for start, piece in zip(starts, pieces)]),
        np.concatenate(uvs),
        np.concatenate(has_uv),
        np.concatenate(sources) if len(sources) == len(pieces) else None,
        _labels((piece.name for piece in pieces), triangle_counts),
        _labels((piece.material for piece in pieces), triangle_counts),
        {
            name: (np.concatenate([r for r, _ in rows]), np.concatenate([d for _, d in rows]))
            for name, rows in parts.items()
        },
    )


def _labels(names: Iterable[str], counts: Sequence[int]) -> Labels:
    index: dict[str, int] = {}
    runs = [index.setdefault(name, len(index)) if name else -1 for name in names]
    if not index:
        return Labels()
    return Labels(tuple(index), np.repeat(np.array(runs, np.int32), counts))
