"""Shapes of one side that engines add to those of the other.

A face is not a sum: lips that are drawn from both sides lie on the teeth as one lip does not.
Every take plays both sides together, so their sum has to be right: what both make beyond each
alone is shared out between them.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from risorius._check import FloatArray
from risorius.controls.control import Control, Pose
from risorius.controls.presets import mirrored

__all__ = ["added", "fair_share", "other_side"]


def added(first: Pose, second: Pose) -> dict[str, float]:
    """Return the pose of both together: values of one control add up."""
    return {name: first.get(name, 0.0) + second.get(name, 0.0) for name in {**first, **second}}


def other_side(pose: Pose, controls: Sequence[Control]) -> Pose | None:
    """Return the mirror image of a pose if both are played together.

    None where the pose is its own mirror image, where both contradict one another (the jaw to
    the left and to the right), or where their sum goes beyond what a control may do.

    Parameters
    ----------
    pose : Pose
    controls : sequence of Control
        Of the face.
    """
    known: Mapping[str, Control] = {control.name: control for control in controls}
    other = mirrored(pose, known)
    if other == pose or any(value * other.get(name, 0.0) < 0.0 for name, value in pose.items()):
        return None
    for name, value in added(pose, other).items():
        control = known.get(name)
        if control is not None and not control.low <= value <= control.high:
            return None
    return other


def fair_share(own: FloatArray, other: FloatArray, both: FloatArray) -> FloatArray:
    """Return a displacement of one side (n, 3) with its share of what both sides make together.

    The shares of the two sides add up to one, and are as the squares of their motions, so that
    the sum of both is `both` and what one side does not move it hardly touches.

    Parameters
    ----------
    own, other : (n, 3) float64
        Displacements of the sides alone [mm].
    both : (n, 3) float64
        Displacement of both together [mm].
    """
    mine = (own * own).sum(axis=1, keepdims=True)
    theirs = (other * other).sum(axis=1, keepdims=True)
    total = mine + theirs
    share = np.divide(mine, total, out=np.full_like(mine, 0.5), where=total > 0.0)
    return own + share * (both - own - other)
