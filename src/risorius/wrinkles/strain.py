"""How much, and in which direction, the skin is pressed together in a shape."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csc_matrix, diags

from risorius._check import FloatArray, IntArray
from risorius.mesh.core import TriMesh
from risorius.mesh.factorisation import factorise
from risorius.mesh.laplacian import cotangent_laplacian, mass
from risorius.mesh.normals import face_areas, face_normals

__all__ = ["principal", "surface_strain"]

# Strain of single triangles is noise of the mesh; over this length it is the skin's [mm].
_SMOOTH = 3.0
# Of a collapsed triangle nothing is known.
_SMALLEST_AREA = 1e-9


def surface_strain(mesh: TriMesh, displacement: FloatArray) -> FloatArray:
    """Return the strain of a skin in a shape around each vertex (n, 3, 3), frame of the mesh [1].

    The Green strain E = (F^T F - I) / 2 of every triangle, F being its deformation within the
    surface, is averaged by area and spread over 3 mm.

    Parameters
    ----------
    mesh : TriMesh
        Rest shape [mm].
    displacement : (n, 3) float64
        The shape [mm].
    """
    points, faces = mesh.positions, mesh.faces
    rest = _edges(points, faces)
    posed = _edges(points + displacement, faces)
    normals = face_normals(points, faces)
    areas = face_areas(points, faces)
    sound = areas > _SMALLEST_AREA
    frame = np.concatenate([rest, normals[:, :, None]], axis=2)
    frame[~sound] = np.eye(3)
    moved = np.concatenate([posed, np.zeros_like(normals)[:, :, None]], axis=2)
    change = moved @ np.linalg.inv(frame)
    flat = np.eye(3) - normals[:, :, None] * normals[:, None, :]
    strain = 0.5 * (np.swapaxes(change, 1, 2) @ change - flat)
    strain[~sound] = 0.0
    return _spread(mesh, strain, areas)


def principal(strain: FloatArray, normals: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return the principal strains within the surface.

    Parameters
    ----------
    strain : (n, 3, 3) float64
    normals : (n, 3) float64

    Returns
    -------
    pressed : (n,) float64
        The smaller one; below 0 where skin is pressed together [1].
    direction : (n, 3) float64
        Unit direction of `pressed`, of either sign.
    pulled : (n,) float64
        The larger one [1].
    """
    flat = np.eye(3) - normals[:, :, None] * normals[:, None, :]
    # A large value along the normal, so that it is never among the two of the surface.
    within = flat @ strain @ flat + 1e3 * normals[:, :, None] * normals[:, None, :]
    values, vectors = np.linalg.eigh(within)
    return values[:, 0], vectors[:, :, 0], values[:, 1]


def _edges(points: FloatArray, faces: IntArray) -> FloatArray:
    """Return two edges of each triangle as columns (m, 3, 2)."""
    first = points[faces[:, 0]]
    return np.stack([points[faces[:, 1]] - first, points[faces[:, 2]] - first], axis=2)


def _spread(mesh: TriMesh, strain: FloatArray, areas: FloatArray) -> FloatArray:
    count = mesh.vertex_count
    shares = (strain * (areas / 3.0)[:, None, None]).reshape(-1, 9)
    total = np.zeros((count, 9))
    for corner in range(3):
        np.add.at(total, mesh.faces[:, corner], shares)
    weight = mass(mesh.positions, mesh.faces)
    weight[weight == 0.0] = 1.0
    stiff = cotangent_laplacian(mesh.positions, mesh.faces)
    solve = factorise(csc_matrix(diags(weight) + _SMOOTH**2 * stiff))
    return solve(total).reshape(count, 3, 3)
