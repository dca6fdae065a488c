"""Orbicularis oris by its halves and parts: narrow, purse, funnel, roll."""

from __future__ import annotations

import numpy as np

from risorius.anatomy.skin import Skin
from risorius.anatomy.smooth_step import smooth_step
from risorius.layered.muscle import MouthAction
from risorius.layered.pulls.pull import Pull

__all__ = ["mouth_pull"]

# A turn of a lip fades from here to there away from the lip line [mm].
_TURN = (8.0, 16.0)


def mouth_pull(action: MouthAction, skin: Skin) -> Pull:
    """Return the pull of a part of the orbicularis oris, left and right at once.

    In lip coordinates: narrowing draws every point to the middle along the dental arch, the
    middle comes forward, the height shrinks, and the lip turns about an axis inside it.
    """
    mouth = skin.mouth
    a = mouth.half_width
    first, last = action.window
    window = smooth_step(1.0 - (mouth.distance - first) / (last - first))
    x = np.clip(mouth.place, -1.0, 1.0)
    wide = np.clip(mouth.place, -1.3, 1.3)
    inwards = -action.narrow * wide * a
    shape = np.zeros_like(skin.positions)
    shape[:, 0] = inwards
    shape[:, 1] = -action.squeeze * (skin.positions[:, 1] - mouth.line[:, 1])
    # Along the arch: what narrows comes forward as the arch does.
    shape[:, 2] = -2.0 * mouth.depth / a * x * inwards + action.forward * a * (1.0 - 0.25 * x * x)
    weight = np.zeros(len(x))
    goal = np.zeros_like(shape)
    for lip in action.lips:
        side = 1.0 if lip == "upper" else -1.0
        share = window * mouth.share(side)
        own = shape
        if action.turn:
            near = 1.0 - (mouth.distance - _TURN[0]) / (_TURN[1] - _TURN[0])
            turned = mouth.turn(skin.positions, side, action.turn)
            own = shape + smooth_step(near)[:, None] * turned
        weight += share
        goal += share[:, None] * own
    goal /= np.maximum(weight, 1e-9)[:, None]
    return Pull(action.stiffness * skin.even(weight), skin.even_vectors(goal))
