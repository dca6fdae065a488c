"""Orbicularis oculi by its parts: the cheek rises, the brow comes down towards the eye."""

from __future__ import annotations

import numpy as np

from risorius._check import FloatArray
from risorius.anatomy.skin import Skin
from risorius.anatomy.smooth_step import smooth_step
from risorius.layered.muscle import EyeAction
from risorius.layered.pulls.pull import Pull

__all__ = ["eye_pull"]

# Skin farther behind the eye corners than this many half eye widths is left alone.
_BEHIND = 1.6


def eye_pull(action: EyeAction, skin: Skin, corners: FloatArray, *, shortening: float) -> Pull:
    """Return the pull of a part of one orbicularis oculi.

    Parameters
    ----------
    action : EyeAction
    skin : Skin
    corners : (2, 3) float64
        Outer and inner corner of the eye [mm].
    shortening : float
        Contraction at control 1.
    """
    middle = corners.mean(axis=0)
    half = 0.5 * float(np.linalg.norm(corners[0] - corners[1]))
    outwards = np.sign(corners[0, 0] - corners[1, 0])
    offset = (skin.positions - middle) / half
    offset[:, 0] *= outwards
    radius = np.hypot(offset[:, 0] / action.axes[0], offset[:, 1] / action.axes[1])
    direction = np.arctan2(offset[:, 1], offset[:, 0]) - np.radians(action.sector[0])
    turned = np.abs((direction + np.pi) % (2.0 * np.pi) - np.pi) / np.radians(action.sector[1])
    a, b, c, d = action.window
    weight = smooth_step((radius - a) / (b - a)) * smooth_step(1.0 - (radius - c) / (d - c))
    weight *= smooth_step(2.0 * (1.0 - turned))
    weight *= (offset[:, 2] > -_BEHIND) & (skin.positions[:, 0] * outwards > 0.0) & ~skin.hidden
    goal = np.zeros_like(offset)
    for axis in (0, 1):
        goal[:, axis] = (
            -shortening * action.pull[axis] * half * (offset[:, axis] - action.centre[axis])
        )
    goal[:, 0] *= outwards
    normal = np.einsum("nd,nd->n", goal, skin.broad_normals)[:, None] * skin.broad_normals
    return Pull(action.stiffness * weight, goal - normal)
