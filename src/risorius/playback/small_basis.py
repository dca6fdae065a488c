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

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from risorius._check import FloatArray, as_number, as_points
from risorius.controls.head_turn import HEAD_TURN_FAPS, HEAD_TURNS, head_turn_of
from risorius.controls.stream import Stream, StreamFrame
from risorius.errors import ParameterError
from risorius.playback.inner_products import inner_products
from risorius.rig.rig import MorphTarget, Rig

__all__ = ["SmallBasis", "small_basis"]

_BLOCK = 256
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

    def reduced(self, stream: Stream, weights: Iterable[npt.ArrayLike]) -> Stream:
        """Return a stream of the small rig's weights; a frame for each row of the large one's.

        Parameters
        ----------
        stream : Stream
            Times, rate and source; its turns of the head are kept [deg].
        weights : iterable of (t,) array_like
            Can be gone through again and again, as a `Player`.
        """
        names = self.rig.names
        turning = {*stream.names} & {*HEAD_TURNS, *(name for name, _ in HEAD_TURN_FAPS.values())}
        turns = HEAD_TURNS if turning else ()

        def frames() -> Iterator[StreamFrame]:
            for frame, row in zip(stream, weights):
                values = dict(zip(names, self.weights(np.asarray(row)[None])[0].tolist()))
                values |= dict(zip(turns, head_turn_of(frame.values)))
                yield StreamFrame(frame.time, values)

        return Stream(stream.source, stream.rate, (*names, *turns), frames)

    def weights(self, weights: npt.ArrayLike) -> FloatArray:
        """Return the weights (b, k) of the small rig for weights (b, t) of the large one."""
        count = self.projection.shape[1]
        return as_points("weights", weights, dimension=count) @ self.projection.T


def small_basis(
    rig: Rig,
    weights: Iterable[npt.ArrayLike],
    *,
    count: int | None = None,
    error: float | None = None,
) -> SmallBasis:
    """Compress a rig to the components that its poses need most.

    Parameters
    ----------
    rig : Rig
    weights : iterable of (t,) array_like
        Poses that matter, as weights of all targets: the rows of a table, or of a stream, which is
        gone through once and not held.
    count : int, optional
        How many components, at least 1; fewer come back where the poses have fewer.
    error : float, optional
        Largest error instead, root mean square over poses and moving vertices [mm]: the fewest
        components that keep it.

    Raises
    ------
    ParameterError
        If no pose moves anything, `count` is out of range, or neither or both are given.
    ShapeError
        If the weights are not finite or not those of the rig.
    """
    if (count is None) == (error is None):
        raise ParameterError("small basis: give either count or error")
    gram, moving = inner_products(rig)
    energy = _energy(weights, len(rig.targets))
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
    order = np.argsort(-variance)
    order = order[variance[order] > _NEGLIGIBLE * variance.max()]
    left = np.maximum(total - np.concatenate([[0.0], np.cumsum(variance[order])]), 0.0)
    curve = np.sqrt(left / moving)
    order = order[: _count(count, error, curve)]
    shares = inverse @ turned[:, order]
    # The largest share of each component is positive, so that signs do not depend on a library.
    shares = shares * np.sign(shares[np.abs(shares).argmax(axis=0), np.arange(len(order))])
    # At weight 1 a component is as large as it is on average.
    size = np.sqrt(variance[order])
    projection = (gram @ shares).T / size[:, None]
    shares = shares * size
    small = rig.with_targets(_targets(rig, shares))
    return SmallBasis(small, shares, curve[: len(order) + 1], projection)


def _energy(weights: Iterable[npt.ArrayLike], count: int) -> FloatArray:
    """Return the mean (t, t) of w w' over all rows w."""
    energy = np.zeros((count, count))
    rows = 0
    block: list[npt.ArrayLike] = []
    for row in weights:
        block.append(row)
        if len(block) == _BLOCK:
            energy += _square(block, count)
            rows, block = rows + len(block), []
    if block:
        energy += _square(block, count)
        rows += len(block)
    return energy / max(rows, 1)


def _square(block: list[npt.ArrayLike], count: int) -> FloatArray:
    table = as_points("weights", np.array(block), dimension=count)
    return table.T @ table


def _count(count: int | None, error: float | None, curve: FloatArray) -> int:
    most = len(curve) - 1
    if count is not None:
        return min(int(as_number("count", count, low=1, high=100_000)), most)
    bar = as_number("error", error, low=0.0)
    enough = np.flatnonzero(curve <= bar)
    return max(int(enough[0]), 1) if len(enough) else most


def _targets(rig: Rig, shares: FloatArray) -> list[MorphTarget]:
    result: list[MorphTarget] = []
    for number, column in enumerate(shares.T, start=1):
        dense = np.zeros((rig.mesh.vertex_count, 3))
        for share, target in zip(column, rig.targets):
            dense[target.vertices] += share * target.deltas
        result.append(MorphTarget.from_dense(f"component_{number}", dense))
    return result
