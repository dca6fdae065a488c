"""A small rig that does nearly what a large one does: principal components of reachable poses.

With the weights w of many poses, S = mean of w w', and the inner products G of the targets, the
components a solve G S G a = s G a with a' G a = 1. The pose of w is then nearest to the sum of the
components with the coefficients a' G w, and the mean square error of k components is
trace(S G) - s_1 - ... - s_k. No pose is ever evaluated.

References
----------
Fratarcangeli 2008, future work: a basis of the reachable poses.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from risorius._check import FloatArray, as_number, as_points
from risorius.errors import ParameterError
from risorius.playback.inner_products import inner_products
from risorius.rig.rig import MorphTarget, Rig

__all__ = ["SmallBasis", "small_basis"]

_NEGLIGIBLE = 1e-10  # share of the largest variance that rounding makes


@dataclass(frozen=True, eq=False)
class SmallBasis:
    """Components and what they cost.

    Parameters
    ----------
    rig : Rig
        Neutral and the targets ``component_1`` .. ``component_k``.
    shares : (t, k) float64
        Each component as weights of the large rig's targets.
    error_curve : (k + 1,) float64
        Error with none, one .. all components, root mean square over poses and moving vertices
        [mm].
    projection : (k, t) float64
        From weights of the large rig to those of the small one.
    """

    rig: Rig
    shares: FloatArray
    error_curve: FloatArray
    projection: FloatArray

    def weights(self, weights: npt.ArrayLike) -> FloatArray:
        """Return the weights (b, k) of the small rig for weights (b, t) of the large one."""
        count = self.projection.shape[1]
        return as_points("weights", weights, dimension=count) @ self.projection.T


def small_basis(rig: Rig, weights: npt.ArrayLike, *, count: int) -> SmallBasis:
    """Compress a rig to the components that its poses need most.

    Parameters
    ----------
    rig : Rig
    weights : (p, t) array_like
        Poses that matter, as weights of all targets; of a stream or of the shapes themselves.
    count : int
        How many components, at least 1; fewer come back where the poses have fewer.

    Raises
    ------
    ParameterError
        If no pose moves anything, or `count` is out of range.
    ShapeError
        If the weights are not finite or not those of the rig.
    """
    count = int(as_number("count", count, low=1, high=max(len(rig.targets), 1)))
    rows = as_points("weights", weights, dimension=len(rig.targets))
    gram, moving = inner_products(rig)
    energy = rows.T @ rows / max(len(rows), 1)
    total = float(np.trace(energy @ gram))
    if not total > 0.0:
        raise ParameterError("weights: no pose moves anything, there is nothing to compress")
    # G = R R' turns the generalised problem into a symmetric one.
    values, vectors = np.linalg.eigh(gram)
    kept = values > _NEGLIGIBLE * values[-1]
    root, inverse = (
        vectors[:, kept] * np.sqrt(values[kept]),
        vectors[:, kept] / np.sqrt(values[kept]),
    )
    variance, turned = np.linalg.eigh(root.T @ energy @ root)
    order = np.argsort(-variance)[:count]
    order = order[variance[order] > _NEGLIGIBLE * variance.max()]
    shares = inverse @ turned[:, order]
    # The largest share of each component is positive, so that signs do not depend on a library.
    shares = shares * np.sign(shares[np.abs(shares).argmax(axis=0), np.arange(len(order))])
    # At weight 1 a component is as large as it is on average.
    size = np.sqrt(variance[order])
    projection = (gram @ shares).T / size[:, None]
    shares = shares * size
    left = np.maximum(total - np.concatenate([[0.0], np.cumsum(variance[order])]), 0.0)
    return SmallBasis(
        rig.with_targets(_targets(rig, shares)), shares, np.sqrt(left / moving), projection
    )


def _targets(rig: Rig, shares: FloatArray) -> list[MorphTarget]:
    result: list[MorphTarget] = []
    for number, column in enumerate(shares.T, start=1):
        dense = np.zeros((rig.mesh.vertex_count, 3))
        for share, target in zip(column, rig.targets):
            dense[target.vertices] += share * target.deltas
        result.append(MorphTarget.from_dense(f"component_{number}", dense))
    return result
