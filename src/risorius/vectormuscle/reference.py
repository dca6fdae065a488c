"""Linear muscles in plain loops: what the fast path is tested against.

The same formulas, one vertex and one number at a time in float64, without zones: every vertex is
tested against every muscle in every step.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from risorius._check import FloatArray
from risorius.vectormuscle.kinds.linear import MOST_STRETCH, LinearMuscle
from risorius.vectormuscle.muscle import FaceContext

__all__ = ["combine_reference", "effect_reference"]

Vector = tuple[float, float, float]


def effect_reference(muscle: LinearMuscle, point: Sequence[float], *, smooth: bool = True) -> float:
    """Return the effect ``r a`` of a muscle at one point (3,) [mm], 0 outside its zone.

    Bui et al. 2003 eq. 1-3, corrected: errata E1 and E3 of the specification.
    """
    offset = _minus(point, muscle.origin)
    fibre = _minus(muscle.insertion, muscle.origin)
    distance = _length(offset)
    if distance == 0.0 or distance >= muscle.finish_radius:
        return 0.0
    cosine = _dot(offset, fibre) / (distance * _length(fibre))
    angle = math.acos(min(max(cosine, -1.0), 1.0))
    half_angle = math.radians(muscle.half_angle)
    if angle >= half_angle:
        return 0.0
    start, finish = muscle.start_radius, muscle.finish_radius
    if distance <= start:
        radial = math.cos((1.0 - distance / start) * math.pi / 2.0)
    else:
        radial = math.cos((distance - start) / (finish - start) * math.pi / 2.0)
    return radial * (math.cos(angle / half_angle * math.pi / 2.0) if smooth else math.cos(angle))


def combine_reference(
    muscles: Sequence[tuple[LinearMuscle, float]], context: FaceContext, *, steps: int = 8
) -> FloatArray:
    """Return the joint displacement (n, 3) [mm], as `risorius.vectormuscle.combine.combine`.

    Parameters
    ----------
    muscles : sequence of (LinearMuscle, float)
        Muscles with their contraction; without hold of the mouth corner.
    context : FaceContext
        The skin.
    steps : int
        Number of small steps.
    """
    result = np.zeros_like(context.positions)
    smooth = context.angular == "smooth"
    everywhere = np.ones(len(result))
    permissions = [
        context.regions.permission(muscle.regions) if muscle.regions else everywhere
        for muscle, _ in muscles
    ]
    for vertex in range(len(result)):
        rest = context.positions[vertex].tolist()
        mobility = float(context.regions.mobility[vertex])
        effects = [
            effect_reference(muscle, rest, smooth=smooth) * float(allowed[vertex]) * mobility
            for (muscle, _), allowed in zip(muscles, permissions)
        ]
        moved = (0.0, 0.0, 0.0)
        for _ in range(steps):
            here = _plus(rest, moved)
            single = [
                _pull(muscle, here, contraction / steps * muscle.pull * effect, context, vertex)
                for (muscle, contraction), effect in zip(muscles, effects)
            ]
            moved = _plus(moved, _limited_sum(single))
        result[vertex] = moved
    return result


def _pull(
    muscle: LinearMuscle, point: Vector, strength: float, context: FaceContext, vertex: int
) -> Vector:
    """Return the displacement of a vertex that stands at `point`, towards the origin (E2)."""
    offset = _minus(point, muscle.origin)
    distance = _length(offset)
    if distance == 0.0 or strength == 0.0:
        return (0.0, 0.0, 0.0)
    pull = _times(offset, -strength / distance)
    if context.support:
        outward = context.outward[vertex].tolist()
        inward = min(_dot(pull, outward), 0.0)
        along = _minus(pull, _times(outward, context.support * inward))
        after = _length(along)
        stretch = min(_length(pull) / after, MOST_STRETCH) if after > 0.0 else 1.0
        pull = _times(along, stretch)
    normal = context.normals[vertex].tolist()
    return _plus(pull, _times(normal, muscle.out * strength))


def _limited_sum(single: Sequence[Vector]) -> Vector:
    """Return the sum, with no more along any of the vectors than the largest one has there."""
    total = (0.0, 0.0, 0.0)
    for vector in single:
        total = _plus(total, vector)
    scale = 1.0
    for vector in single:
        length = _length(vector)
        if length == 0.0:
            continue
        unit = _times(vector, 1.0 / length)
        wanted = _dot(total, unit)
        if wanted > 0.0:
            largest = max(0.0, *(_dot(other, unit) for other in single))
            scale = min(scale, largest / wanted)
    return _times(total, scale)


def _minus(a: Sequence[float] | FloatArray, b: Sequence[float] | FloatArray) -> Vector:
    return (float(a[0] - b[0]), float(a[1] - b[1]), float(a[2] - b[2]))


def _plus(a: Sequence[float], b: Sequence[float]) -> Vector:
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


def _times(a: Sequence[float], factor: float) -> Vector:
    return (factor * a[0], factor * a[1], factor * a[2])


def _dot(a: Sequence[float], b: Sequence[float]) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def _length(a: Sequence[float]) -> float:
    return math.sqrt(_dot(a, a))
