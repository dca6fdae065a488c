"""Stripes on a surface: evenly spaced, square to a direction, as unbroken as can be.

References
----------
F. Knöppel, K. Crane, U. Pinkall, P. Schröder, "Stripe patterns on surfaces", 2015: the wave is
the smallest eigenvector of an energy that asks for a given turn of its phase along every edge.
"""

from __future__ import annotations

import numpy as np
from scipy.sparse import coo_matrix, csc_matrix, diags

from risorius._check import FloatArray, IntArray
from risorius.mesh.core import TriMesh
from risorius.mesh.factorisation import factorise
from risorius.mesh.laplacian import cotangent_laplacian, mass

__all__ = ["stripe_wave"]

# Inverse iterations: the smallest eigenvector needs few, its phase fewer.
_STEPS = 12
_LEAST_WEIGHT = 1e-3
_SHIFT = 1e-6


def stripe_wave(
    mesh: TriMesh,
    direction: FloatArray,
    spacing: FloatArray,
    *,
    strength: FloatArray,
    seed: int = 0,
) -> FloatArray:
    """Return a wave in -1..1 at every vertex (n,), whose crests are the stripes.

    Parameters
    ----------
    mesh : TriMesh
        Edges should be at most a quarter of the spacing [mm].
    direction : (n, 3) float64
        Unit tangents across the stripes; their sign does not matter.
    spacing : (n,) float64
        Distance from crest to crest [mm].
    strength : (n,) float64
        How much each place counts; where two stripes must meet, they do where it is small [1].
    seed : int
        Of the start of the iteration.

    Notes
    -----
    A direction without sign makes the wave a pair (x, y) whose y changes sign from one vertex to
    the next where their directions do; x, which is returned over its length, does not care.
    """
    laplacian = cotangent_laplacian(mesh.positions, mesh.faces).tocoo()
    upper = laplacian.row < laplacian.col
    i, j = laplacian.row[upper], laplacian.col[upper]
    weight = np.maximum(-laplacian.data[upper], _LEAST_WEIGHT) * np.sqrt(strength[i] * strength[j])
    sign = np.where((direction[i] * direction[j]).sum(axis=1) < 0.0, -1.0, 1.0)
    across = direction[i] + sign[:, None] * direction[j]
    across /= np.maximum(np.linalg.norm(across, axis=1, keepdims=True), 1e-12)
    step = mesh.positions[j] - mesh.positions[i]
    turn = 4.0 * np.pi * (across * step).sum(axis=1) / (spacing[i] + spacing[j])
    energy = _energy((i, j), weight, turn, sign, mesh.vertex_count)
    vertex_mass = np.tile(mass(mesh.positions, mesh.faces), 2)
    vertex_mass[vertex_mass == 0.0] = 1.0
    scale = float(energy.diagonal().mean() / vertex_mass.mean())
    solve = factorise(csc_matrix(energy + _SHIFT * scale * diags(vertex_mass)))
    wave = np.random.default_rng(seed).normal(size=2 * mesh.vertex_count)
    for _ in range(_STEPS):
        wave = solve(vertex_mass * wave)
        wave /= np.sqrt((vertex_mass * wave * wave).sum())
    x, y = wave.reshape(2, -1)
    return x / np.maximum(np.hypot(x, y), 1e-300)


def _energy(
    pairs: tuple[IntArray, IntArray],
    weight: FloatArray,
    turn: FloatArray,
    sign: FloatArray,
    count: int,
) -> csc_matrix:
    """Return the matrix (2n, 2n) of sum w |p_j - T p_i|^2 over all edges, p = (x, y)."""
    i, j = pairs
    cosine, sine = np.cos(turn), np.sin(turn)
    turned = ((cosine, -sine), (sign * sine, sign * cosine))
    rows: list[IntArray] = []
    columns: list[IntArray] = []
    values: list[FloatArray] = []
    for a in range(2):
        for vertex in (i, j):
            rows.append(a * count + vertex)
            columns.append(a * count + vertex)
            values.append(weight)
        for b in range(2):
            entry = -weight * turned[a][b]
            rows.extend([a * count + j, b * count + i])
            columns.extend([b * count + i, a * count + j])
            values.extend([entry, entry])
    entries = (np.concatenate(values), (np.concatenate(rows), np.concatenate(columns)))
    return csc_matrix(coo_matrix(entries, shape=(2 * count, 2 * count)))
