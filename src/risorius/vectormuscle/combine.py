"""Several muscles at once, independent of their order."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from risorius._check import FloatArray, IntArray
from risorius.vectormuscle.muscle import BoundMuscle

__all__ = ["combine"]

Field = tuple[IntArray, FloatArray]


def combine(
    muscles: Sequence[tuple[BoundMuscle, float]], positions: FloatArray, *, steps: int = 8
) -> FloatArray:
    """Return the joint displacement (n, 3) of several contracted muscles.

    The contraction is split into equal small steps. In each step every muscle is evaluated at
    the current positions; the sum at a vertex is then scaled so that its component along each
    muscle's own direction does not exceed the largest single one (spec vector-muscles 2.2;
    Bui et al. only name "parallel contraction"). One muscle: its own displacement in the limit
    of small steps. The order of `muscles` does not matter.

    Parameters
    ----------
    muscles : sequence of (BoundMuscle, float)
        Muscles with their contraction.
    positions : (n, 3) float64
        Skin at rest [mm].
    steps : int
        Number of small steps.
    """
    active = [(muscle, share / steps) for muscle, share in muscles if share != 0.0]
    result = np.zeros_like(positions)
    if not active:
        return result
    for _ in range(steps):
        single: list[Field] = []
        for muscle, share in active:
            here = positions[muscle.vertices] + result[muscle.vertices]
            single.append((muscle.vertices, muscle.displace(here, share)))
        result += _limited_sum(single, len(positions))
    return result


def _limited_sum(single: list[Field], vertex_count: int) -> FloatArray:
    total = np.zeros((vertex_count, 3))
    # Sorting by content makes floating point sums independent of the order of the muscles.
    for vertices, field in sorted(single, key=_key):
        total[vertices] += field
    if len(single) == 1:
        return total
    scale = np.ones(vertex_count)
    for vertices, field in single:
        length = np.linalg.norm(field, axis=1)
        moved = vertices[length > 0.0]
        direction = np.zeros((vertex_count, 3))
        direction[moved] = field[length > 0.0] / length[length > 0.0, None]
        largest = np.zeros(vertex_count)
        for others, other in single:
            along = np.einsum("kd,kd->k", other, direction[others])
            largest[others] = np.maximum(largest[others], along)
        wanted = np.einsum("kd,kd->k", total[moved], direction[moved])
        ratio = largest[moved] / np.maximum(wanted, 1e-300)
        scale[moved] = np.where(wanted > 0.0, np.minimum(scale[moved], ratio), scale[moved])
    return total * scale[:, None]


def _key(item: Field) -> tuple[int, bytes]:
    vertices, field = item
    return len(vertices), field.tobytes()
