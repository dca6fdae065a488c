"""Several muscles at once, independent of their order."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from risorius._check import FloatArray
from risorius.vectormuscle.muscle import BoundMuscle

__all__ = ["combine"]


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
        single = [
            (muscle.vertices, muscle.displace(positions[muscle.vertices] + result[muscle.vertices], share))
            for muscle, share in active
        ]
        result += _limited_sum(single, len(positions))
    return result


def _limited_sum(single: list[tuple[np.ndarray, FloatArray]], vertex_count: int) -> FloatArray:
    total = np.zeros((vertex_count, 3))
    # Sorting by content makes floating point sums independent of the order of the muscles.
    for vertices, field in sorted(single, key=_key):
        total[vertices] += field
    if len(single) == 1:
        return total
    scale = np.ones(vertex_count)
    units: list[tuple[np.ndarray, FloatArray]] = []
    for vertices, field in single:
        length = np.linalg.norm(field, axis=1)
        moved = length > 0.0
        units.append((vertices[moved], field[moved] / length[moved, None]))
    for vertices, unit in units:
        wanted = np.einsum("kd,kd->k", total[vertices], unit)
        largest = np.zeros(vertex_count)
        direction = np.zeros((vertex_count, 3))
        direction[vertices] = unit
        for others, field in single:
            along = np.einsum("kd,kd->k", field, direction[others])
            np.maximum.at(largest, others, along)
        ratio = largest[vertices] / np.maximum(wanted, 1e-300)
        scale[vertices] = np.where(wanted > 0.0, np.minimum(scale[vertices], ratio), scale[vertices])
    return total * np.minimum(scale, 1.0)[:, None]


def _key(item: tuple[np.ndarray, FloatArray]) -> tuple[int, bytes]:
    vertices, field = item
    return len(vertices), field[: min(8, len(field))].tobytes()
