"""What a clone is compared with: the nearest vertex, and deformation transfer.

The published method is a profile of the package.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from scipy.sparse import csc_matrix, diags
from scipy.spatial import cKDTree

from risorius.cloning import CloneParameters, Cloning
from risorius.head import Head
from risorius.mesh.factorisation import factorise
from risorius.mesh.laplacian import cotangent_laplacian

FloatArray = npt.NDArray[np.float64]


def nearest_copy(source: Head, target: Head, deltas: FloatArray) -> FloatArray:
    """Copy the motion of the nearest source vertex after the similarity of the landmarks."""
    bound = _bound(source, target)
    similarity = bound.skin.pairs.similarity
    points = similarity.apply(bound.source.mesh.positions)
    nearest = cKDTree(points).query(bound.target.mesh.positions)[1]
    ours = _skin(source, deltas) @ similarity.linear.T
    return _spread(target, ours[:, nearest])


def deformation_transfer(source: Head, target: Head, deltas: FloatArray) -> FloatArray:
    """Sumner, Popovic 2004, on the correspondence of the package, anchored where nothing moves.

    The gradient of each target triangle's motion is that of the source triangle under it; the
    Poisson system is solved for the displacements.
    """
    bound = _bound(source, target)
    rest, mesh = bound.source.mesh, bound.target.mesh
    ours = _skin(source, deltas) @ bound.skin.pairs.similarity.linear.T
    points = bound.skin.pairs.similarity.apply(rest.positions)
    mapping = bound.skin.mapping
    # The source face of a target face: that under the corner with the largest share.
    owner = {tuple(sorted(face)): row for row, face in enumerate(rest.faces.tolist())}
    faces = np.array([owner[tuple(sorted(face))] for face in mapping.faces.tolist()])
    corner_face = faces[mesh.faces[:, 0]]
    moves = np.linalg.norm(ours, axis=2) > 1e-4
    still = ~moves.any(axis=0)[mapping.faces].any(axis=1)
    still[np.argmin(mesh.positions[:, 2])] = True
    free = np.flatnonzero(~still)
    stiff = cotangent_laplacian(mesh.positions, mesh.faces)
    solve = factorise(csc_matrix(stiff[free][:, free] + 1e-9 * diags(np.ones(len(free)))))
    weights, edges = _cotangents(mesh.positions, mesh.faces)
    made = np.zeros((len(ours), mesh.vertex_count, 3))
    inverse = np.linalg.pinv(_frames(points[rest.faces]))
    for shape, moved in enumerate(ours):
        change = _frames((points + moved)[rest.faces]) @ inverse - np.eye(3)
        right = np.zeros((mesh.vertex_count, 3))
        for (a, b), weight in zip(edges, weights):
            span = mesh.positions[b] - mesh.positions[a]
            pull = weight[:, None] * np.einsum("tij,tj->ti", change[corner_face], span)
            np.add.at(right, b, pull)
            np.add.at(right, a, -pull)
        made[shape][free] = solve(right[free])
    return _spread(target, made)


def _bound(source: Head, target: Head) -> Cloning:
    parameters = CloneParameters(lip_contact=False, lid_contact=False, parts=False)
    return Cloning.build(source, target, parameters=parameters)


def _skin(head: Head, deltas: FloatArray) -> FloatArray:
    return head.frame.vectors_to_canonical(deltas)[:, head.skin.first_source()]


def _spread(target: Head, made: FloatArray) -> FloatArray:
    result = np.zeros((len(made), target.vertex_count, 3))
    for shape, moved in zip(result, made):
        target.skin.spread(moved, shape)
    return target.frame.vectors_to_input(result)


def _frames(corners: FloatArray) -> FloatArray:
    a, b = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    normal = np.cross(a, b)
    length = np.sqrt(np.maximum(np.linalg.norm(normal, axis=1), 1e-30))
    return np.stack([a, b, normal / length[:, None]], axis=2)


def _cotangents(
    positions: FloatArray, faces: npt.NDArray[np.int32]
) -> tuple[list[FloatArray], list[tuple[FloatArray, FloatArray]]]:
    weights, edges = [], []
    for k in range(3):
        a, b, o = faces[:, k], faces[:, (k + 1) % 3], faces[:, (k + 2) % 3]
        u, v = positions[a] - positions[o], positions[b] - positions[o]
        area = np.maximum(np.linalg.norm(np.cross(u, v), axis=1), 1e-12)
        weights.append(np.clip(0.5 * (u * v).sum(axis=1) / area, 0.02, 10.0))
        edges.append((a, b))
    return weights, edges
