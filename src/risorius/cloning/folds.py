"""Skin that folds or tears on the target and not on the source is smoothed.

The same motion that fits under one chin is too long for the skin under another: what moves passes
what rests, and the skin folds over. At the corners of a mouth neighbours may have taken their
motion from places far apart, and the edge between them tears. There the motion gives way to the
smoothest one that joins what moves to what rests farther off.
"""

from __future__ import annotations

import numpy as np
from scipy.sparse import csc_matrix, csr_matrix, diags
from scipy.sparse.csgraph import dijkstra

from risorius._check import BoolArray, FloatArray, IntArray
from risorius.cloning.mapping import Mapping
from risorius.cloning.subject import Subject
from risorius.mesh.connectivity import edges
from risorius.mesh.core import TriMesh
from risorius.mesh.factorisation import factorise
from risorius.mesh.laplacian import cotangent_laplacian, mass
from risorius.mesh.slit import edge_graph

__all__ = ["FoldRelief", "least_progress"]

# Skin that keeps this share of its length along itself has not folded; by how much less than the
# source's it must keep to count in full, and at all.
_UNFOLDED, _FULL, _LEAST = 0.5, 0.3, 0.25
# How far around a fold motion gives way: a share of what moves there, within limits [mm].
_REACH, _SMALLEST, _LARGEST = 0.8, 3.0, 25.0
# An edge stretched to so many times its length, and so many times what the source's are, tears;
# by how much more it does so in full, the least growth as a share of the face's height, and the
# reach around a tear [mm].
_STRETCHED, _OVER, _TORN, _GROWTH, _TEAR_REACH = 1.8, 1.25, 0.7, 0.003, 3.0
# Stiffness against bending [mm], trust in motion at a full fold and away from it.
_BEND, _DOUBT, _TRUST = 10.0, 1e-3, 1e4
# Faces thinner than this share of their longer side.
_THIN = 0.05
# Skin nearer to lips, in mouth widths, or to lids, in eye heights, folds as it likes.
_LIPS, _LIDS = 0.35, 1.0


def least_progress(mesh: TriMesh, moved: FloatArray) -> FloatArray:
    """Return the least share (n,) of its length that skin keeps along itself, in any direction.

    For a direction d in a face and the displacement's gradient G along the face, 1 + d.Gd; the
    least over directions is one plus the smaller eigenvalue of (G + G^T) / 2. Mean over the faces
    of a vertex by area. 1 at rest, 0 where skin stands square to itself or has shrunk to a line,
    negative where it turned round.

    Parameters
    ----------
    mesh : TriMesh
    moved : (n, 3) float64
        Displacements [mm].
    """
    corners, shifts = mesh.positions[mesh.faces], moved[mesh.faces]
    sides, change = corners[:, 1:] - corners[:, :1], shifts[:, 1:] - shifts[:, :1]
    first = sides[:, 0] / np.maximum(np.linalg.norm(sides[:, 0], axis=1), 1e-12)[:, None]
    off = sides[:, 1] - np.einsum("fj,fj->f", sides[:, 1], first)[:, None] * first
    height = np.linalg.norm(off, axis=1)
    second = off / np.maximum(height, 1e-12)[:, None]
    # Sides are (a, 0) and (b, height) in the frame of the face; thin faces tell nothing.
    a = np.einsum("fj,fj->f", sides[:, 0], first)
    b = np.einsum("fj,fj->f", sides[:, 1], first)
    thin = height < _THIN * np.maximum(a, np.abs(b))
    along = np.stack([first, second], axis=1) @ np.swapaxes(change, 1, 2)
    g0 = along[:, :, 0] / np.maximum(a, 1e-12)[:, None]
    g1 = (along[:, :, 1] - b[:, None] * g0) / np.maximum(height, 1e-12)[:, None]
    mean, half = 0.5 * (g0[:, 0] + g1[:, 1]), 0.5 * (g0[:, 0] - g1[:, 1])
    least = 1.0 + mean - np.hypot(half, 0.5 * (g0[:, 1] + g1[:, 0]))
    area = np.where(thin, 0.0, 0.5 * a * height)
    n, rows = mesh.vertex_count, mesh.faces.ravel()
    total = np.bincount(rows, np.repeat(area * least, 3), n)
    around = np.bincount(rows, np.repeat(area, 3), n)
    return np.where(around > 0.0, total / np.maximum(around, 1e-300), 1.0)


class FoldRelief:
    """Smooths motion where the target's skin folds more than the source's.

    Parameters
    ----------
    source, target : Subject
    mapping : Mapping
        Places of the target's vertices on the source.
    """

    def __init__(self, source: Subject, target: Subject, mapping: Mapping) -> None:
        self._source, self._mesh, self._mapping = source.mesh, target.mesh, mapping
        self._edges, self._source_edges = edges(target.mesh.faces), edges(source.mesh.faces)
        self._seen, self._height = ~target.inside, target.head.height
        self._open = _open(target)
        self._graph = edge_graph(target.mesh)
        stiff = cotangent_laplacian(target.mesh.positions, target.mesh.faces)
        self._mass = np.maximum(mass(target.mesh.positions, target.mesh.faces), 1e-9)
        self._bent = csr_matrix(_BEND**4 * (stiff @ diags(1.0 / self._mass) @ stiff))

    def excess(self, ours: FloatArray, theirs: FloatArray) -> FloatArray:
        """Return how much more (n,) the target's skin folds at each vertex, 0 to 1.

        Parameters
        ----------
        ours : (v, 3) float64
            Displacement of the source's skin [mm].
        theirs : (n, 3) float64
            Displacement of the target's skin [mm].
        """
        made = least_progress(self._mesh, theirs)
        made[~self._open] = 1.0
        if not (made < _UNFOLDED).any():
            return np.zeros(len(theirs))
        given = least_progress(self._source, ours)
        given = np.minimum(given[self._mapping.faces].min(axis=1), _UNFOLDED)
        return np.clip((given - made) / _FULL, 0.0, 1.0)

    def torn(self, ours: FloatArray, theirs: FloatArray) -> FloatArray:
        """Return how much more (n,) edges at each vertex are stretched on the target, 0 to 1.

        Parameters
        ----------
        ours : (v, 3) float64
            Displacement of the source's skin [mm].
        theirs : (n, 3) float64
            Displacement of the target's skin [mm].
        """
        least = _GROWTH * self._height
        made = _stretch(self._mesh, self._edges, theirs, least)
        made[~self._seen] = 1.0
        if not (made > _STRETCHED).any():
            return np.zeros(len(theirs))
        given = _stretch(self._source, self._source_edges, ours, 0.0)
        given = np.maximum(_OVER * given[self._mapping.faces].max(axis=1), _STRETCHED)
        return np.clip((made - given) / _TORN, 0.0, 1.0)

    def relieve(self, ours: FloatArray, theirs: FloatArray) -> FloatArray:
        """Return the target's displacement (n, 3) without folds that the source does not have.

        Parameters
        ----------
        ours : (k, 3) float64
            Displacement of the source's skin [mm].
        theirs : (n, 3) float64
            Displacement of the target's skin, as cloned [mm].
        """
        excess, torn = self.excess(ours, theirs), self.torn(ours, theirs)
        folds = np.flatnonzero(excess > _LEAST).astype(np.int32)
        tears = np.flatnonzero(torn > 0.0).astype(np.int32)
        if not len(folds) + len(tears):
            return theirs
        doubt = np.zeros(len(theirs))
        if len(folds):
            doubt = self._doubt(folds, excess, self._reach(folds, theirs))
        if len(tears):
            reach = np.full(len(tears), _TEAR_REACH)
            doubt = np.maximum(doubt, self._doubt(tears, torn, reach))
        zone, held = np.flatnonzero(doubt > 0.0), np.flatnonzero(doubt == 0.0)
        trust = np.minimum(_DOUBT / np.maximum(doubt, 1e-6) ** 2, _TRUST) * self._mass
        rows = self._bent[zone]
        right = trust[zone, None] * theirs[zone] - rows[:, held] @ theirs[held]
        system = rows[:, zone] + diags(trust[zone])
        result = theirs.copy()
        result[zone] = factorise(csc_matrix(system))(right)
        return result

    def _reach(self, folds: IntArray, theirs: FloatArray) -> FloatArray:
        """Return how far (k,) around each fold motion gives way, by what moves there [mm]."""
        size = np.linalg.norm(theirs, axis=1)
        around = size.copy()
        np.maximum.at(around, self._edges.ravel(), size[self._edges[:, ::-1]].ravel())
        return np.clip(_REACH * around[folds], _SMALLEST, _LARGEST)

    def _doubt(self, rows: IntArray, excess: FloatArray, reach: FloatArray) -> FloatArray:
        """Return how little (n,) motion is trusted around `rows` (k,), fading along the skin."""
        away = dijkstra(self._graph, indices=rows, limit=float(reach.max()))
        near = np.maximum(1.0 - away / reach[:, None], 0.0)
        return (excess[rows, None] * near).max(axis=0)


def _stretch(mesh: TriMesh, pairs: IntArray, moved: FloatArray, least: float) -> FloatArray:
    """Return the largest stretch (n,) of edges at each vertex; growth below `least` is none."""
    along = mesh.positions[pairs[:, 1]] - mesh.positions[pairs[:, 0]]
    length = np.linalg.norm(along, axis=1)
    after = np.linalg.norm(along + moved[pairs[:, 1]] - moved[pairs[:, 0]], axis=1)
    ratio = np.where(after - length > least, after / np.maximum(length, 1e-9), 1.0)
    result = np.ones(mesh.vertex_count)
    np.maximum.at(result, pairs.ravel(), np.repeat(ratio, 2))
    return result


def _open(target: Subject) -> BoolArray:
    seen = ~target.inside
    if target.lips is not None:
        seen &= target.lips.distance > _LIPS * target.lips.width
    for margins in target.lids.values():
        seen &= margins.distance > _LIDS * margins.height
    return seen
