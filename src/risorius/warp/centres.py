"""Check and prepare the corresponding points of a warp."""

from __future__ import annotations

import warnings
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.spatial import cKDTree

from risorius._check import FloatArray, IntArray, as_points
from risorius.errors import ParameterError, RisoriusWarning, ShapeError

__all__ = ["Centres", "nearest_distances", "prepare_centres"]

# Centres closer than this share of their spread are one place.
_COINCIDENT = 1e-9
# Coincident centres may differ by this share of the targets' spread and still agree.
_SAME_TARGET = 1e-6
# Spreads below this share of the largest are none.
_FLAT = 1e-7


@dataclass(frozen=True, eq=False)
class Centres:
    """Distinct centres of a warp and what their arrangement allows.

    Parameters
    ----------
    source, target : (n, 3) float64
        Corresponding points without duplicates [mm].
    kept : (n,) int32
        Which of the given pairs they are.
    middle : (3,) float64
        Mean of the source [mm].
    scale : float
        Root mean square distance of the source from it, 1 if that is 0 [mm].
    axes : (3, 3) float64
        Directions of the source's spread as rows, widest first.
    rank : int
        3 for points in space, 2 in a plane, 1 on a line, 0 at one place.
    """

    source: FloatArray
    target: FloatArray
    kept: IntArray
    middle: FloatArray
    scale: float
    axes: FloatArray
    rank: int

    def scaled(self, points: FloatArray) -> FloatArray:
        """Return `points` (q, 3) centred and scaled to the source's spread."""
        return (points - self.middle) / self.scale


def prepare_centres(source: npt.ArrayLike, target: npt.ArrayLike) -> Centres:
    """Return the distinct centres of a warp.

    Parameters
    ----------
    source, target : (n, 3) array_like
        Corresponding points, at least one pair [mm].

    Raises
    ------
    ShapeError
        If the two do not correspond.
    ParameterError
        If there is no pair, or two equal source points have different targets (both are named).

    Warns
    -----
    RisoriusWarning
        If equal pairs were merged.
    """
    p, q = as_points("source", source), as_points("target", target)
    if len(p) != len(q):
        raise ShapeError(f"source, target: {len(p)} and {len(q)} points do not correspond")
    if not len(p):
        raise ParameterError("source: no points; give at least one pair")
    kept = _without_duplicates(p, q)
    p, q = p[kept], q[kept]
    middle = p.mean(axis=0)
    scale = float(np.sqrt(np.mean(np.sum((p - middle) ** 2, axis=1))))
    scale = scale if scale > 0.0 else 1.0
    _, singular, axes = np.linalg.svd((p - middle) / scale, full_matrices=True)
    rank = int((singular > _FLAT * max(float(singular[0]), 1e-300)).sum())
    return Centres(p, q, kept, middle, scale, axes, rank)


def nearest_distances(points: FloatArray) -> FloatArray:
    """Return the distance (n,) of each of `points` (n, 3) to its nearest other one.

    r_i = min over j != i of |P_i - P_j| (erratum E6: the printed formula also admits j = i).
    """
    if len(points) < 2:
        return np.zeros(len(points))
    return np.asarray(cKDTree(points).query(points, k=2)[0][:, 1], np.float64)


def _without_duplicates(p: FloatArray, q: FloatArray) -> IntArray:
    everyone = np.arange(len(p), dtype=np.int32)
    extent = float(np.linalg.norm(np.ptp(p, axis=0)))
    near = cKDTree(p).query_pairs(_COINCIDENT * extent, output_type="ndarray")
    if not len(near):
        return everyone
    near = near[np.lexsort((near[:, 1], near[:, 0]))]
    apart = np.linalg.norm(q[near[:, 0]] - q[near[:, 1]], axis=1)
    bad = apart > _SAME_TARGET * max(float(np.linalg.norm(np.ptp(q, axis=0))), 1e-300)
    if bad.any():
        first, second = near[int(np.argmax(bad))].tolist()
        raise ParameterError(
            f"source: points {first} and {second} lie at one place {p[first].tolist()} but their "
            f"targets {q[first].tolist()} and {q[second].tolist()} differ; correct or remove one"
        )
    dropped = np.unique(near[:, 1])
    warnings.warn(
        f"warp: {len(dropped)} source point(s) repeat an earlier one with the same target "
        f"(first: {int(near[0, 1])} repeats {int(near[0, 0])}); each pair counts once",
        RisoriusWarning,
        stacklevel=4,
    )
    return np.setdiff1d(everyone, dropped).astype(np.int32)
