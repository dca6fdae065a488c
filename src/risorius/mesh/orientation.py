"""Make the faces of a mesh turn the same way, outwards."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from risorius._check import BoolArray, FloatArray, IntArray
from risorius.errors import MeshError
from risorius.mesh.connectivity import EdgeFaces, components, edge_faces
from risorius.mesh.volume import capped_volumes

__all__ = ["Orientation", "agreeing_edges", "orient"]

# Share of area^1.5 (a sphere: 0.094) that a piece must enclose to have an outside. Open pieces
# below it are sheets, like lashes, whose capped volume says nothing.
_SHEET = 0.02
_CLOSED_SHEET = 1e-9


class Orientation(NamedTuple):
    """Faces after re-orientation.

    Parameters
    ----------
    faces : (m, 3) int32
    flipped : (m,) bool
        Which of them were turned.
    """

    faces: IntArray
    flipped: BoolArray


def agreeing_edges(faces: IntArray, table: EdgeFaces) -> BoolArray:
    """Return the mask (e,) of edges whose first two faces run along them in opposite senses.

    Edges without a second face agree.
    """
    forward = np.zeros((len(table.edges), 2), bool)
    for corner in range(3):
        edge = table.face_edges[:, corner]
        rows = np.flatnonzero(edge >= 0)
        along = faces[rows, corner] == table.edges[edge[rows], 0]
        for side in range(2):
            mine = table.faces[edge[rows], side] == rows
            forward[edge[rows[mine]], side] = along[mine]
    return (table.counts < 2) | (forward[:, 0] != forward[:, 1])


def orient(positions: FloatArray, faces: IntArray) -> Orientation:
    """Turn faces so that neighbours agree and every loose piece looks outwards.

    Neighbours across edges of exactly two faces are made to agree; of the two choices that a
    patch then has, it takes the one that turns fewer faces. After that each loose piece whose
    volume (holes capped) is negative is turned as a whole. Open sheets that enclose little, like
    lashes, keep the side of their majority.

    Parameters
    ----------
    positions : (n, 3) float64
        Vertices [mm].
    faces : (m, 3) int32

    Raises
    ------
    MeshError
        If a patch has only one side, like a Moebius strip.
    """
    m = len(faces)
    if not m:
        return Orientation(faces.copy(), np.zeros(0, bool))
    table = edge_faces(faces)
    flipped = _flood(faces, table, agreeing_edges(faces, table))
    result = faces.copy()
    result[flipped] = result[flipped][:, [0, 2, 1]]
    pieces = components(result, len(positions))
    volume = capped_volumes(positions, result, pieces)
    corners = positions[result]
    doubled = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    area = np.bincount(pieces.of_face, 0.5 * np.linalg.norm(doubled, axis=1), pieces.piece_count)
    open_pieces = np.zeros(pieces.piece_count, bool)
    open_pieces[pieces.of_face[table.faces[table.counts == 1, 0]]] = True
    inward = volume < -np.where(open_pieces, _SHEET, _CLOSED_SHEET) * area**1.5
    turn = inward[pieces.of_face]
    result[turn] = result[turn][:, [0, 2, 1]]
    return Orientation(result, flipped ^ turn)


def _flood(faces: IntArray, table: EdgeFaces, agrees: BoolArray) -> BoolArray:
    """Return which faces (m,) to turn so that neighbours agree, as few as possible per patch.

    Every face gets two nodes, as it is and turned; agreeing neighbours join equal nodes, the
    others opposite ones. A patch with one side falls into one piece instead of two.
    """
    m = len(faces)
    shared = np.flatnonzero(table.counts == 2)
    first, second = table.faces[shared, 0], table.faces[shared, 1]
    cross = np.where(agrees[shared], 0, m)
    rows = np.concatenate([first, first + m])
    columns = np.concatenate([second + cross, second + (m - cross)])
    graph = coo_matrix((np.ones(len(rows), np.int8), (rows, columns)), shape=(2 * m, 2 * m))
    labels = connected_components(graph, directed=False)[1]
    kept, turned = labels[:m], labels[m:]
    one_sided = np.flatnonzero(kept == turned)
    if len(one_sided):
        raise MeshError(
            f"faces: the patch around face {int(one_sided[0])} ({len(one_sided)} faces) has only "
            "one side, like a Moebius strip; cut it open along an edge"
        )
    # A patch owns two labels; the one that more of its faces carry unturned wins.
    votes = np.bincount(kept, minlength=int(labels.max()) + 1)
    ahead = votes[kept] != votes[turned]
    return np.where(ahead, votes[kept] < votes[turned], kept > turned)
