"""Bind skin to the surface of muscles."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
import numpy.typing as npt

from risorius._check import FloatArray, IntArray
from risorius.springmuscle.kernels.ellipsoid import bind_vertices
from risorius.springmuscle.muscle_set import MuscleSet

__all__ = ["Binding", "bind_muscle"]

Weighting = Literal["divide", "product"]


@dataclass(frozen=True, eq=False)
class Binding:
    """Skin vertices of one muscle, each with the one best ellipsoid.

    Parameters
    ----------
    vertices : (k,) int32
    segments : (k,) int32
        Of all segments of the set.
    feet : (k, 3) float64
        Nearest point on the ellipsoid in the coordinates of its frame [mm].
    distances : (k,) float64
        From foot to vertex [mm].
    """

    vertices: IntArray
    segments: IntArray
    feet: FloatArray
    distances: FloatArray


def bind_muscle(
    muscles: MuscleSet,
    number: int,
    *,
    positions: FloatArray,
    normals: FloatArray,
    lips: npt.NDArray[np.int8],
    weighting: Weighting = "divide",
    guard: bool = True,
) -> Binding:
    """Find the skin that a muscle moves: all within its radius of influence and in front of it.

    Parameters
    ----------
    muscles : MuscleSet
    number : int
        Of the muscle.
    positions, normals : (n, 3) float64
        The skin at rest [mm].
    lips : (n,) int8
        1 for vertices of the upper lip, -1 of the lower one, 0 for all others.
    weighting : {"divide", "product"}
        How the angle between normal and spring enters; the product is what was printed, and
        prefers feet that lie sideways (erratum E5).
    guard : bool
        Keep vertices of one lip off ellipsoids that lie under the other.
    """
    own = np.flatnonzero(muscles.segment_muscle == number)
    centres, half_axes = muscles.centres[own], muscles.half_axes[own]
    radius = muscles.muscles[number].action.radius
    reach = radius + half_axes.max()
    near = (positions > centres.min(axis=0) - reach) & (positions < centres.max(axis=0) + reach)
    rows = np.flatnonzero(near.all(axis=1)).astype(np.int32)
    segments = np.full(len(rows), -1, np.int32)
    feet, distances = np.zeros((len(rows), 3)), np.zeros(len(rows))
    bind_vertices(
        positions[rows], normals[rows], lips[rows], centres,
        np.ascontiguousarray(muscles.frames[own]), half_axes, muscles.lips[own], radius,
        weighting == "divide", guard, segments, feet, distances,
    )  # fmt: skip
    found = segments >= 0
    return Binding(
        rows[found], own[segments[found]].astype(np.int32), feet[found], distances[found]
    )
