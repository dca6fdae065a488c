"""What a clone is compared with: the nearest vertex, and deformation transfer.

The published method is a profile of the package.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from scipy.sparse import csc_matrix, csr_matrix, diags, eye
from scipy.spatial import cKDTree

from risorius.cloning import CloneParameters, Cloning
from risorius.head import Head
from risorius.mesh.factorisation import factorise
from risorius.mesh.normals import face_normals
from risorius.spatial.closest import closest_points

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int32]

# Displacements below this are rest [mm]; the smallest share of stiffness that keeps pieces
# without an anchor solvable.
_STILL, _LOOSE = 1e-4, 1e-9


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

    Every target triangle takes over the deformation gradient S of the source triangle under its
    middle; vertices solve the least squares problem sum_t area_t |T_t - S_t|^2 with T_t the
    gradient of the target's own motion (their equation 8 with the fourth vertex eliminated, whose
    normal equations are G^T A G u = G^T A (S - I) with the gradient operator G). One operator is
    both in the matrix and on the right, so that a motion that is a gradient is reproduced exactly.
    Per shape, vertices whose source does not move are anchors.
    """
    bound = _bound(source, target)
    mesh, mapping = bound.target.mesh, bound.skin.mapping
    similarity = bound.skin.pairs.similarity
    ours = _skin(source, deltas) @ similarity.linear.T
    points = similarity.apply(bound.source.mesh.positions)
    owner = _under_middles(mesh.faces, mesh.positions, bound)
    inverse = np.linalg.pinv(_frames(points[bound.source.mesh.faces]))
    gradient, areas = _gradient(mesh.positions, mesh.faces)
    weighted = csr_matrix(gradient.T @ diags(np.repeat(areas, 3)))
    stiff = csr_matrix(weighted @ gradient)
    made = np.zeros((len(ours), mesh.vertex_count, 3))
    for shape, moved in enumerate(ours):
        moves = np.linalg.norm(moved, axis=1) > _STILL
        free = np.flatnonzero(mapping.moved(moves))
        if not len(free):
            continue
        after = _frames((points + moved)[bound.source.mesh.faces])
        change = (after @ inverse - np.eye(3))[owner]
        right = weighted @ np.swapaxes(change, 1, 2).reshape(-1, 3)
        loose = _LOOSE * float(stiff.diagonal().mean()) * eye(len(free))
        made[shape, free] = factorise(csc_matrix(stiff[free][:, free] + loose))(right[free])
    return _spread(target, made)


def _under_middles(faces: IntArray, positions: FloatArray, bound: Cloning) -> IntArray:
    """Return the source face (m,) under each target triangle's middle, on its side of the lips."""
    fitted, source, target = bound.skin.fitted, bound.source, bound.target
    middles, normals = positions[faces].mean(axis=1), face_normals(positions, faces)
    result = np.zeros(len(faces), np.int32)
    for side in (0, 1, -1):
        rows = np.flatnonzero(target.face_side == side)
        mask = source.face_side * side >= 0
        if len(rows):
            found = closest_points(
                fitted, middles[rows], normals=normals[rows], max_angle=75.0, face_mask=mask
            )
            lost = found.face < 0
            result[rows] = found.face
            if lost.any():
                result[rows[lost]] = closest_points(
                    fitted, middles[rows[lost]], face_mask=mask
                ).face
    return result


def _gradient(positions: FloatArray, faces: IntArray) -> tuple[csr_matrix, FloatArray]:
    """Return the gradient operator (3 m, n) of the triangles along themselves, and areas (m,)."""
    corners = positions[faces]
    facing = corners[:, [2, 0, 1]] - corners[:, [1, 2, 0]]
    doubled = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    square = np.maximum((doubled**2).sum(axis=1), 1e-16)
    slopes = np.cross(doubled[:, None], facing) / square[:, None, None]
    m = len(faces)
    rows = np.repeat(3 * np.arange(m), 9) + np.tile(np.repeat(np.arange(3), 3), m)
    columns = np.repeat(faces, 3, axis=0).ravel()
    values = np.swapaxes(slopes, 1, 2).ravel()
    return csr_matrix((values, (rows, columns)), (3 * m, len(positions))), 0.5 * np.sqrt(square)


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
