"""Warps of space by radial basis functions."""

from __future__ import annotations

import warnings
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Literal

import numpy as np
import numpy.typing as npt
from scipy.linalg import LinAlgError, lu_factor, lu_solve

from risorius._check import FloatArray, as_points, one_of
from risorius.errors import ParameterError, RisoriusWarning, ShapeError, SolverError
from risorius.warp.centres import Centres, nearest_distances, prepare_centres
from risorius.warp.kernels import KERNELS, KernelName, blocks, squared_distances
from risorius.warp.similarity import fit_similarity

__all__ = ["Polynomial", "RbfWarp"]

Polynomial = Literal["affine", "in_plane", "similarity", "none"]
_POLYNOMIALS = ("affine", "in_plane", "similarity", "none")
# Largest share of the targets' spread by which an interpolating warp may miss a centre.
_MISS = 1e-6


@dataclass(frozen=True, eq=False)
class RbfWarp:
    """G(x) = A x + b + sum_i h_i phi(|x - P_i|); make one with `RbfWarp.fit`.

    Parameters
    ----------
    centres : (n, 3) float64
        P [mm].
    radii : (n,) float64
        Radii of the multiquadrics [mm].
    coefficients : (n, 3) float64
        h, for centres scaled to size 1.
    linear : (3, 3) float64
        A.
    offset : (3,) float64
        Image of the mean of the centres under A x + b [mm].
    kernel : str
        Name of phi.
    residual : float
        Largest distance between the image of a centre and its target [mm].
    """

    centres: FloatArray
    radii: FloatArray
    coefficients: FloatArray
    linear: FloatArray
    offset: FloatArray
    kernel: str
    residual: float

    @staticmethod
    def fit(
        source: npt.ArrayLike,
        target: npt.ArrayLike,
        *,
        kernel: KernelName = "multiquadric",
        radii: Literal["nearest"] | npt.ArrayLike = "nearest",
        polynomial: Polynomial = "affine",
        regularisation: npt.ArrayLike = 0.0,
    ) -> RbfWarp:
        """Return the warp that carries `source` onto `target`.

        Solves [[Phi + lambda, T], [T^T, 0]] [h; a] = [Q; 0] by LU, with T the polynomial at the
        centres.

        Parameters
        ----------
        source, target : (n, 3) array_like
            Corresponding points P and Q [mm].
        kernel : {"multiquadric", "biharmonic", "thin_plate", "triharmonic"}
            sqrt(d^2 + r_i^2), d, d^2 log d or d^3.
        radii : "nearest", float or (n,) array_like
            r of the multiquadrics: the distance to the nearest other centre, or given [mm].
        polynomial : {"affine", "in_plane", "similarity", "none"}
            ``"affine"`` reproduces affine maps exactly. ``"in_plane"`` does so within the best
            plane of the source and carries the direction across by the best similarity.
            ``"similarity"`` reproduces similarities and leaves the rest to the kernel.
        regularisation : float or (n,) array_like
            lambda: 0 interpolates, more smooths. In units of the source's size, so that it
            means the same for a head in metres. Per centre if an array.

        Raises
        ------
        ParameterError
            If two equal centres have different targets, or the kernel needs a polynomial that
            the arrangement of the centres or the choice of `polynomial` denies it.
        SolverError
            If an interpolating warp misses its targets.

        Warns
        -----
        RisoriusWarning
            If equal pairs were merged, if centres in one plane or on one line reduce the
            polynomial, or if fewer than four leave only a similarity.

        Notes
        -----
        O(n^3) once, O(n) per point. Solvability is proven for one common radius only; with
        individual radii it is generic (erratum E6). The matrix is then not symmetric: r belongs
        to the column.

        References
        ----------
        Fratarcangeli 2008, equations 3.28-3.31; Hardy 1971 (multiquadrics).
        """
        one_of("kernel", kernel, KERNELS)
        one_of("polynomial", polynomial, _POLYNOMIALS)
        centres = prepare_centres(source, target)
        count = len(np.asarray(source))
        radius = _as_radii(radii, count, centres)
        smoothing = _per_centre("regularisation", regularisation, count)[centres.kept]
        if len(centres.source) < 4:
            return _similarity_only(centres, radius, kernel)
        degree = _usable_rank(centres, polynomial, KERNELS[kernel].order, kernel)
        warp = _solve(centres, radius, smoothing, kernel, degree)
        spread = float(np.linalg.norm(np.ptp(centres.target, axis=0)))
        # A residual that is not a number misses as well.
        if not smoothing.any() and not warp.residual <= _MISS * max(spread, centres.scale):
            raise SolverError(
                f"warp: misses its targets by {warp.residual:g} of {spread:g}; the centres lie "
                "too close together or on a surface that the kernel cannot tell apart; add "
                "regularisation or remove centres"
            )
        return warp

    def __call__(self, points: npt.ArrayLike) -> FloatArray:
        """Return the images (q, 3) of `points` (q, 3) [mm]."""
        queries = as_points("points", points)
        centre, scale = self._frame
        result = (queries - centre) @ self.linear.T + self.offset
        kernel = KERNELS[self.kernel]
        for rows in blocks(len(queries), len(self.centres)):
            squared = squared_distances((queries[rows] - centre) / scale, self._scaled_centres)
            result[rows] += kernel.value(squared, self.radii / scale) @ self.coefficients
        return result

    def jacobian(self, points: npt.ArrayLike) -> FloatArray:
        """Return the derivatives (q, 3, 3) at `points` (q, 3): d image_i / d point_j [1].

        The biharmonic kernel has a kink at its centres; there the derivative leaves it out.
        """
        queries = as_points("points", points)
        centre, scale = self._frame
        result = np.empty((len(queries), 3, 3))
        kernel = KERNELS[self.kernel]
        for rows in blocks(len(queries), len(self.centres)):
            scaled = (queries[rows] - centre) / scale
            slope = kernel.slope(
                squared_distances(scaled, self._scaled_centres), self.radii / scale
            )
            # sum_i h_i slope_i (x - P_i)^T, split so that no (q, n, 3) array is needed.
            outer = np.einsum("ni,nj->nij", self.coefficients, self._scaled_centres)
            mixed = (slope @ outer.reshape(-1, 9)).reshape(-1, 3, 3)
            pulled = np.einsum("qi,qj->qij", slope @ self.coefficients, scaled)
            result[rows] = self.linear + (pulled - mixed) / scale
        return result

    @cached_property
    def _frame(self) -> tuple[FloatArray, float]:
        middle = self.centres.mean(axis=0)
        scale = float(np.sqrt(np.mean(np.sum((self.centres - middle) ** 2, axis=1))))
        return middle, scale if scale > 0.0 else 1.0

    @cached_property
    def _scaled_centres(self) -> FloatArray:
        middle, scale = self._frame
        return (self.centres - middle) / scale


def _per_centre(name: str, value: npt.ArrayLike, count: int) -> FloatArray:
    array = np.asarray(value, dtype=np.float64)
    if array.shape not in ((), (count,)):
        raise ShapeError(f"{name}: expected a number or shape ({count},), got {array.shape}")
    if not np.isfinite(array).all() or (array < 0.0).any():
        raise ParameterError(f"{name}: must be finite and at least 0")
    return np.broadcast_to(array, (count,)).astype(np.float64)


def _as_radii(value: npt.ArrayLike, count: int, centres: Centres) -> FloatArray:
    if isinstance(value, str):
        one_of("radii", value, ("nearest",))
        return nearest_distances(centres.source)
    return _per_centre("radii", value, count)[centres.kept]


def _similarity_only(centres: Centres, radii: FloatArray, kernel: str) -> RbfWarp:
    n = len(centres.source)
    best = fit_similarity(centres.source, centres.target)
    residual = np.linalg.norm(best.apply(centres.source) - centres.target, axis=1).max()
    warnings.warn(
        f"warp: {n} point(s) fix no more than a similarity, which misses them by up to "
        f"{residual:g}; give at least four",
        RisoriusWarning,
        stacklevel=3,
    )
    offset = best.apply(centres.middle[None])[0]
    none = np.zeros((n, 3))
    return RbfWarp(centres.source, radii, none, best.linear, offset, kernel, float(residual))


def _usable_rank(centres: Centres, polynomial: Polynomial, order: int, kernel: str) -> int:
    """Return how many axes of the centres the polynomial spans; -1 for no polynomial at all."""
    wanted = {"affine": 3, "in_plane": 2, "similarity": 0, "none": -1}[polynomial]
    if order == 2 and wanted < 2:
        raise ParameterError(
            f'polynomial: the {kernel} kernel needs "affine" or "in_plane", got "{polynomial}"'
        )
    if wanted <= centres.rank:
        return wanted
    shape = "in one plane" if centres.rank == 2 else "on one line"
    warnings.warn(
        f"warp: the {len(centres.source)} centres lie {shape}; the polynomial works within it "
        "and the best similarity carries the directions across",
        RisoriusWarning,
        stacklevel=3,
    )
    return centres.rank


def _solve(
    centres: Centres, radii: FloatArray, smoothing: FloatArray, kernel: str, degree: int
) -> RbfWarp:
    """Fit kernel and polynomial to what the similarity across the spanned axes leaves.

    With all three axes spanned nothing is left to the similarity.
    """
    n, scaled = len(centres.source), centres.scaled(centres.source)
    spanned = centres.axes[: max(degree, 0)]
    across = np.eye(3) - spanned.T @ spanned
    linear = np.zeros((3, 3))
    if 0 <= degree < 3:
        linear = fit_similarity(centres.source, centres.target).linear @ across
    middle = centres.target.mean(axis=0)
    wanted = centres.target - middle - (centres.source - centres.middle) @ linear.T
    basis = np.ones((n, 1)) if degree >= 0 else np.ones((n, 0))
    basis = np.concatenate([scaled @ spanned.T, basis], axis=1)
    k = basis.shape[1]
    phi = KERNELS[kernel].value(squared_distances(scaled, scaled), radii / centres.scale)
    system = np.zeros((n + k, n + k))
    system[:n, :n] = phi + np.diag(smoothing)
    system[:n, n:], system[n:, :n] = basis, basis.T
    solution = _lu(system, np.concatenate([wanted, np.zeros((k, 3))]))
    slopes, shift = solution[n : n + len(spanned)], solution[n + len(spanned) :].sum(axis=0)
    warp = RbfWarp(
        centres=centres.source,
        radii=radii,
        # In one order of memory, so that a copy of the warp gives the same bytes.
        coefficients=np.ascontiguousarray(solution[:n]),
        linear=np.ascontiguousarray(linear + slopes.T @ spanned / centres.scale),
        offset=middle + shift,
        kernel=kernel,
        residual=0.0,
    )
    missed = np.linalg.norm(warp(centres.source) - centres.target, axis=1).max()
    return replace(warp, residual=float(missed))


def _lu(system: FloatArray, right: FloatArray) -> FloatArray:
    try:
        with warnings.catch_warnings():
            # A singular matrix is reported by the miss of its solution.
            warnings.simplefilter("ignore")
            factors = lu_factor(system)
            solution = lu_solve(factors, right)
            # One step of refinement brings the interpolation to rounding.
            return solution + lu_solve(factors, right - system @ solution)
    except (LinAlgError, ValueError) as error:
        raise SolverError(f"warp: the system of {len(system)} unknowns failed ({error})") from None
