"""The regularised network of Bui et al., one per coordinate."""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from typing import Literal

import numpy as np
import numpy.typing as npt
from scipy.linalg import LinAlgError, cho_factor, cho_solve, lu_factor, lu_solve

from risorius._check import FloatArray, IntArray, as_number, as_points, one_of
from risorius.errors import ParameterError, RisoriusWarning, SolverError
from risorius.warp.centres import Centres, nearest_distances, prepare_centres
from risorius.warp.kernels import blocks, squared_distances
from risorius.warp.similarity import Affine, fit_affine, fit_similarity

__all__ = ["Base", "NetworkWarp"]

Base = Literal["affine", "similarity", "none"]


@dataclass(frozen=True, eq=False)
class NetworkWarp:
    """G(x) = base(x) + sum_j w_j sqrt(|x - mu_j|^2 + s_j^2); make one with `NetworkWarp.fit`.

    Parameters
    ----------
    centres : (n, 3) float64
        mu [mm].
    radii : (n,) float64
        s, the distance to the nearest other centre [mm].
    coefficients : (n, 3) float64
        w, one column per coordinate [1].
    base : Affine
        What the network is added to.
    residual : float
        Largest distance between the image of a centre and its target [mm].
    """

    centres: FloatArray
    radii: FloatArray
    coefficients: FloatArray
    base: Affine
    residual: float

    @staticmethod
    def fit(
        source: npt.ArrayLike,
        target: npt.ArrayLike,
        *,
        base: Base = "affine",
        regularisation: float = 1e-3,
        exact: npt.ArrayLike = (),
    ) -> NetworkWarp:
        """Return the network trained on `source` and `target`.

        Minimises sum_i |G(P_i) - Q_i|^2 + lambda sum_j |w_j|^2, that is
        w = (H^T H + lambda I)^-1 H^T (Q - base(P)) with H_ij = sqrt(|P_i - mu_j|^2 + s_j^2).

        Parameters
        ----------
        source, target : (n, 3) array_like
            Corresponding points P = mu and Q [mm].
        base : {"affine", "similarity", "none"}
            Best map subtracted first. As published there is none: then identity is not
            reproduced and regularisation pulls towards the origin (erratum E8).
        regularisation : float
            lambda as a share of trace(H^T H) / n, so that units do not matter (the publication
            leaves lambda open, E7); 0 interpolates.
        exact : (k,) int array_like
            Pairs that must be met although lambda > 0: muscles that are already fixed.

        Raises
        ------
        ParameterError
            If two equal source points have different targets, or `exact` names no pair.
        SolverError
            If the system is singular.

        Warns
        -----
        RisoriusWarning
            If equal pairs were merged, or if points in one plane reduce the base to a similarity.

        References
        ----------
        Bui, Heylen, Poel, Nijholt 2003, section 3.
        """
        one_of("base", base, ("affine", "similarity", "none"))
        share = as_number("regularisation", regularisation, low=0.0)
        centres = prepare_centres(source, target)
        fixed = _exact_rows(exact, len(np.asarray(source)), centres)
        start = _base_map(centres, base)
        radii = nearest_distances(centres.source)
        wanted = centres.target - start.apply(centres.source)
        matrix = _responses(centres.source, centres.source, radii)
        if len(centres.source) < 2:
            weights = np.zeros_like(wanted)
        else:
            weights = np.ascontiguousarray(_train(matrix, wanted, share, fixed))
        missed = np.linalg.norm(matrix @ weights - wanted, axis=1).max()
        return NetworkWarp(centres.source, radii, weights, start, float(missed))

    def __call__(self, points: npt.ArrayLike) -> FloatArray:
        """Return the images (q, 3) of `points` (q, 3) [mm]."""
        queries = as_points("points", points)
        result = self.base.apply(queries)
        for rows in blocks(len(queries), len(self.centres)):
            responses = _responses(queries[rows], self.centres, self.radii)
            result[rows] += responses @ self.coefficients
        return result


def _responses(points: FloatArray, centres: FloatArray, radii: FloatArray) -> FloatArray:
    return np.sqrt(squared_distances(points, centres) + radii * radii)


def _exact_rows(exact: npt.ArrayLike, count: int, centres: Centres) -> IntArray:
    rows = np.unique(np.asarray(exact, dtype=np.int64).ravel())
    if len(rows) and (rows[0] < 0 or rows[-1] >= count):
        raise ParameterError(f"exact: pairs must lie in 0..{count - 1}")
    return np.flatnonzero(np.isin(centres.kept, rows)).astype(np.int32)


def _base_map(centres: Centres, base: Base) -> Affine:
    if base == "none":
        return Affine(np.zeros((3, 3)), np.zeros(3))
    if base == "affine" and centres.rank == 3:
        return fit_affine(centres.source, centres.target)
    if base == "affine":
        warnings.warn(
            f"network: {len(centres.source)} source point(s) without depth leave an affine base "
            "open; the best similarity takes its place",
            RisoriusWarning,
            stacklevel=3,
        )
    best = fit_similarity(centres.source, centres.target)
    return Affine(best.linear, best.translation)


def _train(matrix: FloatArray, wanted: FloatArray, share: float, fixed: IntArray) -> FloatArray:
    n = len(matrix)
    normal = matrix.T @ matrix
    normal[np.diag_indices(n)] += share * np.trace(normal) / n
    try:
        if share == 0.0:
            # Squaring H would halve the digits for nothing.
            return lu_solve(lu_factor(matrix), wanted)
        if not len(fixed):
            return cho_solve(cho_factor(normal), matrix.T @ wanted)
        k = len(fixed)
        system = np.zeros((n + k, n + k))
        system[:n, :n] = normal
        system[:n, n:], system[n:, :n] = matrix[fixed].T, matrix[fixed]
        right = np.concatenate([matrix.T @ wanted, wanted[fixed]])
        return lu_solve(lu_factor(system), right)[:n]
    except (LinAlgError, ValueError) as error:
        raise SolverError(
            f"network: the system of {n} centres failed ({error}); raise the regularisation"
        ) from None
