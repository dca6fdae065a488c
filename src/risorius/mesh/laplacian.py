"""Laplacians of a triangle mesh and the smooth fields that they define."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from scipy.sparse import coo_matrix, csc_matrix, csr_matrix, diags

from risorius._check import FloatArray, IntArray, as_number
from risorius.errors import MeshError, ParameterError, ShapeError
from risorius.mesh.connectivity import components, edges
from risorius.mesh.core import TriMesh
from risorius.mesh.factorisation import factorise
from risorius.mesh.normals import vertex_areas

__all__ = [
    "SmoothField",
    "cotangent_laplacian",
    "harmonic",
    "mass",
    "smooth",
    "uniform_laplacian",
]

# Twice the area is taken as at least this share of the longest side squared, so that no
# cotangent exceeds its inverse and a sliver cannot dominate its neighbours.
_THINNEST = 0.01
# Vertices of collapsed faces stand for at least this share of the mean vertex area.
_SMALLEST_AREA = 1e-6


def cotangent_laplacian(positions: FloatArray, faces: IntArray) -> csr_matrix:
    """Return the cotangent Laplacian (n, n), symmetric and positive semidefinite [1].

    L_ij = -(cot a_ij + cot b_ij) / 2 with the angles facing edge ij, L_ii = -sum_j L_ij, so that
    ``u @ L @ u`` is the integral of |grad u|^2.

    Notes
    -----
    With twice the area floored the matrix of each triangle stays positive semidefinite, because
    cot a cot b + cot b cot c + cot c cot a = (2 area / floor)^2 >= 0. Edges of obtuse triangles
    may weigh less than zero.
    """
    row, column, weight = _cotangent_edges(positions, faces)
    return _from_edges(row, column, weight, len(positions))


def uniform_laplacian(faces: IntArray, vertex_count: int) -> csr_matrix:
    """Return the graph Laplacian (n, n): degree on the diagonal, -1 for each neighbour."""
    pairs = edges(faces)
    return _from_edges(pairs[:, 0], pairs[:, 1], np.ones(len(pairs)), vertex_count)


def mass(positions: FloatArray, faces: IntArray) -> FloatArray:
    """Return the lumped masses (n,): vertex areas, positive wherever a face is [mm^2].

    Unused vertices have no mass.
    """
    areas = vertex_areas(positions, faces)
    used = np.zeros(len(positions), bool)
    used[faces] = True
    if used.any():
        mean = float(areas[used].mean())
        areas[used] = np.maximum(areas[used], _SMALLEST_AREA * mean if mean > 0.0 else 1.0)
    return areas


class SmoothField:
    """The smooth field that follows targets where it is told to; factored once.

    Minimises ``sum_i k_i m_i |u_i - t_i|^2 + length^2 |grad u|^2 + bend^4 |lap u|^2``, that is
    (M K + length^2 L + bend^4 L M^-1 L) u = M K t, with m the `mass` and L the cotangent
    Laplacian.

    Parameters
    ----------
    mesh : TriMesh
        Rest shape [mm].
    stiffness : (n,) array_like
        k, how strongly each vertex follows its target; 0 leaves it to its neighbours [1].
    length : float
        Distance over which a step in the targets spreads [mm].
    bend : float
        Distance over which a kink in the field is rounded [mm].

    Raises
    ------
    ParameterError
        If a stiffness is negative or not finite.

    Notes
    -----
    Pieces of the mesh without any positive stiffness know no target; the field is zero there.
    Unused vertices take their own target if their stiffness is positive.
    """

    def __init__(
        self, mesh: TriMesh, stiffness: npt.ArrayLike, *, length: float, bend: float = 0.0
    ) -> None:
        k = _as_stiffness(stiffness, mesh.vertex_count)
        length = as_number("length", length, low=0.0)
        bend = as_number("bend", bend, low=0.0)
        self._stiffness = k
        pieces = components(mesh.faces, mesh.vertex_count).of_vertex
        held = np.zeros(int(pieces.max(initial=-1)) + 1, bool)
        held[pieces[(k > 0.0) & (pieces >= 0)]] = True
        active = (pieces >= 0) & held[pieces] if len(held) else np.zeros(len(k), bool)
        if length == 0.0 and bend == 0.0:
            active &= k > 0.0
        self._active = np.flatnonzero(active)
        self._loose = np.flatnonzero((pieces < 0) & (k > 0.0))
        self._pull = (mass(mesh.positions, mesh.faces) * k)[self._active]
        if len(self._active):
            self._solve = factorise(self._system(mesh, length, bend))

    def _system(self, mesh: TriMesh, length: float, bend: float) -> csc_matrix:
        # Pieces are active or not as a whole, so their rows couple to no other.
        rows = self._active
        stiff = cotangent_laplacian(mesh.positions, mesh.faces)[rows][:, rows]
        system = diags(self._pull) + length**2 * stiff
        if bend > 0.0:
            inverse = diags(1.0 / mass(mesh.positions, mesh.faces)[rows])
            system = system + bend**4 * (stiff @ inverse @ stiff)
        return csc_matrix(system)

    def solve(self, targets: npt.ArrayLike) -> FloatArray:
        """Return the field for `targets`, (n,) or (n, d); linear in the targets."""
        t = np.asarray(targets, dtype=np.float64)
        if t.ndim not in (1, 2) or len(t) != len(self._stiffness):
            raise ShapeError(
                f"targets: expected shape ({len(self._stiffness)},) or "
                f"({len(self._stiffness)}, d), got {t.shape}"
            )
        field = np.zeros_like(t)
        if len(self._active):
            right = t[self._active] * (self._pull if t.ndim == 1 else self._pull[:, None])
            field[self._active] = self._solve(right)
        field[self._loose] = t[self._loose]
        return field


def harmonic(mesh: TriMesh, fixed_vertices: npt.ArrayLike, values: npt.ArrayLike) -> FloatArray:
    """Return the smoothest fill (n,) or (n, d) between fixed values (Dirichlet problem).

    Parameters
    ----------
    mesh : TriMesh
    fixed_vertices : (k,) int
        Vertices with a given value, each once.
    values : (k,) or (k, d) array_like
        Their values.

    Raises
    ------
    MeshError
        If a piece of the mesh holds no fixed vertex.

    Notes
    -----
    Edge weights are kept positive, so a filled value never leaves the range of the fixed ones.
    Unused vertices that are not fixed get 0.
    """
    fixed = np.asarray(fixed_vertices, dtype=np.int64).ravel()
    given = np.asarray(values, dtype=np.float64)
    if len(given) != len(fixed):
        raise ShapeError(f"values: expected {len(fixed)} rows, one per fixed vertex")
    if len(np.unique(fixed)) != len(fixed):
        raise ParameterError("fixed_vertices: a vertex is listed twice; give each once")
    n = mesh.vertex_count
    pieces = components(mesh.faces, n)
    held = np.zeros(pieces.piece_count, bool)
    held[pieces.of_vertex[fixed][pieces.of_vertex[fixed] >= 0]] = True
    if not held.all():
        vertex = int(np.flatnonzero(pieces.of_vertex == int(np.argmin(held)))[0])
        raise MeshError(
            f"harmonic: the piece of vertex {vertex} holds no fixed vertex; fix at least one"
        )
    free = pieces.of_vertex >= 0
    free[fixed] = False
    result = np.zeros((n, *given.shape[1:]))
    result[fixed] = given
    if free.any():
        row, column, weight = _cotangent_edges(mesh.positions, mesh.faces)
        least = 1e-6 * float(np.abs(weight).mean())
        stiff = _from_edges(row, column, np.maximum(weight, least), n)[free]
        right = -(stiff[:, fixed] @ given)
        result[free] = factorise(csc_matrix(stiff[:, free]))(right)
    return result


def smooth(values: npt.ArrayLike, faces: IntArray, passes: int) -> FloatArray:
    """Return `values`, (n,) or (n, d), averaged `passes` times with the one-ring.

    One pass replaces the value of a vertex by the mean of itself and its neighbours.
    """
    result = np.array(values, dtype=np.float64)
    average = averaging(faces, len(result))
    for _ in range(passes):
        result = average @ result
    return result


def averaging(faces: IntArray, vertex_count: int) -> csr_matrix:
    """Return one pass of `smooth` as a matrix (n, n), for whoever smooths many fields."""
    pairs = edges(faces)
    n = vertex_count
    rows = np.concatenate([pairs[:, 0], pairs[:, 1], np.arange(n)])
    columns = np.concatenate([pairs[:, 1], pairs[:, 0], np.arange(n)])
    average = csr_matrix((np.ones(len(rows)), (rows, columns)), shape=(n, n))
    return diags(1.0 / np.asarray(average.sum(axis=1)).ravel()) @ average


def _as_stiffness(value: npt.ArrayLike, vertex_count: int) -> FloatArray:
    stiffness = np.asarray(value, dtype=np.float64)
    if stiffness.shape != (vertex_count,):
        raise ShapeError(f"stiffness: expected shape ({vertex_count},), got {stiffness.shape}")
    bad = ~np.isfinite(stiffness) | (stiffness < 0.0)
    if bad.any():
        row = int(np.argmax(bad))
        raise ParameterError(
            f"stiffness: entry {row} is {stiffness[row]:g}; it must be finite and at least 0"
        )
    return stiffness


def _cotangent_edges(
    positions: FloatArray, faces: IntArray
) -> tuple[IntArray, IntArray, FloatArray]:
    """Return ends and half cotangents of every side of every face (3 m,)."""
    corners = positions[faces]
    sides = corners[:, [2, 0, 1]] - corners[:, [1, 2, 0]]
    longest = np.einsum("ijk,ijk->ij", sides, sides).max(axis=1, initial=0.0)
    doubled = np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1)
    floor = np.maximum(doubled, _THINNEST * longest)
    point = floor == 0.0
    weight = np.empty((len(faces), 3))
    for corner in range(3):
        dot = -np.einsum("ij,ij->i", sides[:, corner - 2], sides[:, corner - 1])
        # A face shrunk to a point couples its corners like an equilateral one.
        weight[:, corner] = np.where(point, np.sqrt(1.0 / 3.0), dot / np.where(point, 1.0, floor))
    return faces[:, [1, 2, 0]].ravel(), faces[:, [2, 0, 1]].ravel(), 0.5 * weight.ravel()


def _from_edges(
    row: IntArray, column: IntArray, weight: FloatArray, vertex_count: int
) -> csr_matrix:
    """Return the Laplacian whose edges carry `weight`; an edge given twice adds up."""
    rows = np.concatenate([row, column, row, column])
    columns = np.concatenate([column, row, row, column])
    entries = np.concatenate([-weight, -weight, weight, weight])
    shape = (vertex_count, vertex_count)
    return csr_matrix(coo_matrix((entries, (rows, columns)), shape=shape))
