"""Enclosed volume, also of meshes with holes."""

from __future__ import annotations

import numpy as np

from risorius._check import FloatArray, IntArray
from risorius.mesh.boundary import boundary_loops
from risorius.mesh.connectivity import Components, components

__all__ = ["capped_volume", "capped_volumes"]


def capped_volume(positions: FloatArray, faces: IntArray) -> float:
    """Return the volume [mm^3] that the mesh encloses once its holes are closed.

    V = 1/6 sum (p_a x p_b) . p_c over the faces and over a fan that joins each boundary loop to
    its centroid. Positive if the faces look outwards.

    Notes
    -----
    Without the caps the sum of an open mesh depends on the origin (erratum E5 of the layered
    anatomy). Faces must agree in orientation.
    """
    pieces = components(faces, len(positions))
    return float(capped_volumes(positions, faces, pieces).sum())


def capped_volumes(positions: FloatArray, faces: IntArray, pieces: Components) -> FloatArray:
    """Return the capped volume of every loose piece (k,) [mm^3]."""
    result = np.zeros(pieces.piece_count)
    if not len(faces):
        return result
    # The sum does not depend on the origin; the middle of the mesh loses the fewest digits.
    centred = positions - positions[np.unique(faces)].mean(axis=0)
    result += np.bincount(pieces.of_face, _six_volumes(centred[faces]), pieces.piece_count)
    for loop in boundary_loops(faces):
        ring = centred[loop]
        # The loop runs along the faces, so its caps run the other way.
        fan = np.stack(
            [np.roll(ring, -1, axis=0), ring, np.broadcast_to(ring.mean(axis=0), ring.shape)],
            axis=1,
        )
        result[pieces.of_vertex[loop[0]]] += _six_volumes(fan).sum()
    return result / 6.0


def _six_volumes(corners: FloatArray) -> FloatArray:
    return np.einsum("ij,ij->i", np.cross(corners[:, 0], corners[:, 1]), corners[:, 2])
