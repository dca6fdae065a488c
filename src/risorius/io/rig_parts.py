"""The parts of a rig, and normals that are smooth within each of them."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from risorius._check import BoolArray, FloatArray, IntArray
from risorius.mesh.normals import NormalsOperator, vertex_normals
from risorius.rig.rig import MorphTarget, Rig

__all__ = ["RigNormals", "longer_than", "polygon_parts"]

LongArray = npt.NDArray[np.int64]

# A normal that turns by less than this is not stored (0.006 degrees).
_STILL_NORMAL = 1e-4


def polygon_parts(rig: Rig) -> tuple[tuple[str, ...], IntArray]:
    """Return part names and the part (m,) of every polygon.

    The parts of the head if the rig knows them, else the objects of its file, else one.
    Polygons that belong to none are ``"other"``.
    """
    mesh = rig.mesh
    if len(rig.part_of_vertex):
        names = rig.part_names
        first = np.minimum(mesh.offsets[:-1], max(len(mesh.corners) - 1, 0))
        part = rig.part_of_vertex[mesh.corners[first]].astype(np.int32)
    elif mesh.objects.names:
        names, part = mesh.objects.names, mesh.objects.of_polygon.copy()
    else:
        names, part = ("head",), np.zeros(mesh.polygon_count, np.int32)
    if (part < 0).any():
        if "other" not in names:
            names = (*names, "other")
        part[part < 0] = names.index("other")
    return names, part


class RigNormals:
    """Normals of the neutral and of every target of a rig.

    They are smooth across UV seams and material borders; vertices that the file holds twice at
    one place count as one if they face one way and move alike in every target (lips that touch
    do neither). Parts do not influence each other.

    Parameters
    ----------
    rig : Rig
    part_of_polygon : (m,) int32
    triangles : (t, 3) int32
        Corner indices.

    Attributes
    ----------
    of_corner : (c,) int64
        Row of `rest` for every polygon corner.
    rest : (k, 3) float64
        Unit normals of the neutral.
    """

    def __init__(self, rig: Rig, part_of_polygon: IntArray, triangles: IntArray) -> None:
        mesh = rig.mesh
        part = np.repeat(part_of_polygon, np.diff(mesh.offsets)).astype(np.int64)
        keys = part * mesh.vertex_count + mesh.corners
        distinct, corner_key = np.unique(keys, return_inverse=True)
        vertex = distinct % mesh.vertex_count
        faces = corner_key[triangles].astype(np.int32)
        seams = _seams(rig, vertex, distinct // mesh.vertex_count, faces)
        self.of_corner: LongArray = seams[corner_key]
        self._vertex = np.zeros(int(seams.max(initial=-1)) + 1, np.int64)
        self._vertex[seams] = vertex
        self._positions = mesh.positions[self._vertex]
        self._vertex_count = mesh.vertex_count
        self._operator = NormalsOperator(seams[faces].astype(np.int32), len(self._vertex))
        self.rest: FloatArray = self._operator(self._positions)

    def turned(self, target: MorphTarget) -> FloatArray:
        """Return how the rows of `rest` turn (k, 3) in a target; zero where hardly."""
        if not len(target.vertices):
            return np.zeros_like(self.rest)
        moved = np.zeros(self._vertex_count, bool)
        moved[target.vertices] = True
        here = moved[self._vertex]
        positions = self._positions.copy()
        positions[here] += target.deltas[np.searchsorted(target.vertices, self._vertex[here])]
        change = self._operator.update(self.rest, positions, here) - self.rest
        change[~longer_than(_STILL_NORMAL, change)] = 0.0
        return change


def longer_than(still: float, vectors: npt.NDArray[np.floating]) -> BoolArray:
    """Return which of `vectors` (n, 3) have a component beyond `still`."""
    # Three columns at a time are several times faster than three numbers at a time.
    x, y, z = np.abs(vectors).T
    return (x > still) | (y > still) | (z > still)


def _seams(rig: Rig, vertex: LongArray, part: LongArray, faces: IntArray) -> LongArray:
    """Return a number (k,) for each entry of `vertex`, equal for those that are one point."""
    positions = rig.mesh.positions[vertex]
    rows = np.concatenate([part[:, None], positions], axis=1)
    _, first, place = np.unique(rows, axis=0, return_index=True, return_inverse=True)
    place = place.ravel()
    if len(first) == len(vertex):
        return np.arange(len(vertex))
    normals = vertex_normals(positions, faces)
    same_side = np.einsum("ij,ij->i", normals, normals[first[place]]) > 0.0
    motion = _motion_signature(rig)[vertex]
    table = np.concatenate([place[:, None], same_side[:, None], motion], axis=1)
    return np.unique(table, axis=0, return_inverse=True)[1].ravel()


def _motion_signature(rig: Rig) -> FloatArray:
    """Return numbers (n, 3) that agree for vertices that move alike in all targets."""
    signature = np.zeros((rig.mesh.vertex_count, 3))
    weights = np.random.default_rng(0).uniform(0.5, 1.5, len(rig.targets))
    for weight, target in zip(weights, rig.targets):
        signature[target.vertices] += weight * target.deltas
    return signature
