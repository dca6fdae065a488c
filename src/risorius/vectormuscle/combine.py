"""Several muscles at once, independent of their order."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from risorius._check import FloatArray
from risorius.vectormuscle.kernels.limit import limited_sum, scatter
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
    # Only what some muscle reaches is worked on.
    place = np.zeros(len(positions), np.int32)
    for muscle, _ in active:
        place[muscle.vertices] = 1
    zone = np.flatnonzero(place)
    place[zone] = np.arange(len(zone), dtype=np.int32)
    rows = [place[muscle.vertices] for muscle, _ in active]
    rest, moved = positions[zone], np.zeros((len(zone), 3))
    fields = np.zeros((len(active), len(zone), 3))
    for _ in range(steps):
        placed = rest + moved
        for field, here, (muscle, share) in zip(fields, rows, active, strict=True):
            scatter(muscle.displace(placed.take(here, axis=0), share), here, field)
        # Sorting by content makes floating point sums independent of the order of the muscles.
        order = sorted(range(len(fields)), key=lambda row: fields[row].tobytes())
        limited_sum(fields, np.array(order), moved)
    result[zone] = moved
    return result
