"""Best similarity and best affine map between corresponding points."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from risorius._check import FloatArray, as_points
from risorius.errors import ParameterError, ShapeError

__all__ = ["Affine", "Similarity", "fit_affine", "fit_similarity"]

# Singular values below this share of the largest are zero.
_RANK = 1e-9


@dataclass(frozen=True, eq=False)
class Similarity:
    """x -> scale * rotation @ x + translation.

    Parameters
    ----------
    scale : float
    rotation : (3, 3) float64
        Orthogonal; its determinant is -1 only where a reflection was allowed and fits better.
    translation : (3,) float64
        [mm].
    reflected : bool
        Whether a reflection fits the points better than any rotation: left and right are
        swapped, or the frame is left-handed. Never set by points in one plane.
    """

    scale: float
    rotation: FloatArray
    translation: FloatArray
    reflected: bool = False

    @property
    def linear(self) -> FloatArray:
        """(3, 3) scale times rotation."""
        return self.scale * self.rotation

    def apply(self, points: npt.ArrayLike) -> FloatArray:
        """Return the images (q, 3) of `points` (q, 3)."""
        return as_points("points", points) @ self.linear.T + self.translation

    def inverse(self) -> Similarity:
        """Return the way back.

        Raises
        ------
        ParameterError
            If the scale is 0.
        """
        if self.scale == 0.0:
            raise ParameterError("similarity: its scale is 0; it has no inverse")
        back = self.rotation.T
        shift = -(back @ self.translation) / self.scale
        return Similarity(1.0 / self.scale, back, shift, self.reflected)


@dataclass(frozen=True, eq=False)
class Affine:
    """x -> linear @ x + translation.

    Parameters
    ----------
    linear : (3, 3) float64
    translation : (3,) float64
        [mm].
    """

    linear: FloatArray
    translation: FloatArray

    def apply(self, points: npt.ArrayLike) -> FloatArray:
        """Return the images (q, 3) of `points` (q, 3)."""
        return as_points("points", points) @ self.linear.T + self.translation


def fit_similarity(
    source: npt.ArrayLike,
    target: npt.ArrayLike,
    *,
    weights: npt.ArrayLike | None = None,
    allow_scale: bool = True,
    allow_reflection: bool = False,
) -> Similarity:
    """Return the similarity that minimises sum_i w_i |s R p_i + t - q_i|^2.

    Parameters
    ----------
    source, target : (n, 3) array_like
        Corresponding points p and q, at least one pair [mm].
    weights : (n,) array_like, optional
        w, at least 0.
    allow_scale : bool
        False keeps lengths (s = 1).
    allow_reflection : bool
        Let R mirror if that fits better.

    Raises
    ------
    ParameterError
        If no pair has weight.

    Notes
    -----
    Where the points leave R open it turns as little as possible: points on a line fix it up to
    a turn about the line, a single point gives the identity.

    References
    ----------
    Umeyama 1991, "Least-squares estimation of transformation parameters".
    """
    p, q = _pairs(source, target)
    w = _as_weights(weights, len(p))
    p_mean, q_mean = w @ p, w @ q
    p_centred, q_centred = p - p_mean, q - q_mean
    covariance = (q_centred * w[:, None]).T @ p_centred
    rotation, reflected, trace = _best_rotation(covariance, allow_reflection=allow_reflection)
    spread = float(w @ np.einsum("ij,ij->i", p_centred, p_centred))
    scale = trace / spread if allow_scale and spread > 0.0 else 1.0
    return Similarity(scale, rotation, q_mean - scale * rotation @ p_mean, reflected)


def fit_affine(
    source: npt.ArrayLike, target: npt.ArrayLike, *, weights: npt.ArrayLike | None = None
) -> Affine:
    """Return the affine map that minimises sum_i w_i |A p_i + b - q_i|^2.

    Parameters
    ----------
    source, target : (n, 3) array_like
        Corresponding points, at least four that are not coplanar [mm].
    weights : (n,) array_like, optional
        w, at least 0.

    Raises
    ------
    ParameterError
        If the source points lie in one plane; fit a similarity then.
    """
    p, q = _pairs(source, target)
    w = _as_weights(weights, len(p))
    root = np.sqrt(w)[:, None]
    p_mean, q_mean = w @ p, w @ q
    centred = (p - p_mean) * root
    singular = np.linalg.svd(centred, compute_uv=False)
    if len(singular) < 3 or singular[2] <= _RANK * singular[0]:
        raise ParameterError(
            f"source: the {len(p)} points lie in one plane, which leaves an affine map open; "
            "give points with depth or fit a similarity"
        )
    solution = np.linalg.lstsq(centred, (q - q_mean) * root, rcond=None)[0]
    linear = np.asarray(solution.T, np.float64)
    return Affine(linear, q_mean - linear @ p_mean)


def _pairs(source: npt.ArrayLike, target: npt.ArrayLike) -> tuple[FloatArray, FloatArray]:
    p, q = as_points("source", source), as_points("target", target)
    if len(p) != len(q):
        raise ShapeError(f"source, target: {len(p)} and {len(q)} points do not correspond")
    if not len(p):
        raise ParameterError("source: no points; give at least one pair")
    return p, q


def _as_weights(value: npt.ArrayLike | None, count: int) -> FloatArray:
    weights = np.ones(count) if value is None else np.asarray(value, dtype=np.float64)
    if weights.shape != (count,):
        raise ShapeError(f"weights: expected shape ({count},), got {weights.shape}")
    if not np.isfinite(weights).all() or weights.min() < 0.0 or weights.sum() <= 0.0:
        raise ParameterError("weights: they must be finite, at least 0 and not all 0")
    return weights / weights.sum()


def _best_rotation(
    covariance: FloatArray, *, allow_reflection: bool
) -> tuple[FloatArray, bool, float]:
    """Return R that maximises tr(R^T C), whether a reflection would do better, and the trace."""
    left, singular, right = np.linalg.svd(covariance)
    rank = int((singular > _RANK * singular[0]).sum()) if singular[0] > 0.0 else 0
    if rank == 0:
        return np.eye(3), False, 0.0
    if rank == 1:
        return _least_turn(right[0], left[:, 0]), False, float(singular[0])
    sign = float(np.sign(np.linalg.det(left) * np.linalg.det(right)))
    reflected = sign < 0.0 and rank == 3
    signs = np.array([1.0, 1.0, 1.0 if reflected and allow_reflection else sign])
    return (left * signs) @ right, reflected, float((singular * signs).sum())


def _least_turn(start: FloatArray, goal: FloatArray) -> FloatArray:
    """Return the rotation about the shortest arc from one unit vector to another."""
    axis, cosine = np.cross(start, goal), float(start @ goal)
    if cosine < -1.0 + 1e-12:
        # Half a turn about any perpendicular axis; the one nearest to a coordinate axis.
        helper = np.zeros(3)
        helper[int(np.argmin(np.abs(start)))] = 1.0
        axis = helper - (helper @ start) * start
        axis /= np.linalg.norm(axis)
        return 2.0 * np.outer(axis, axis) - np.eye(3)
    skew = np.array([[0.0, -axis[2], axis[1]], [axis[2], 0.0, -axis[0]], [-axis[1], axis[0], 0.0]])
    return np.eye(3) + skew + skew @ skew / (1.0 + cosine)
