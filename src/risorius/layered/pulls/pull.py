"""The pull of one muscle on the skin."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from risorius._check import FloatArray
from risorius.anatomy.skin import Skin

__all__ = ["Pull"]


@dataclass(frozen=True, eq=False)
class Pull:
    """Full contraction of one muscle, as the skin of n vertices feels it.

    Parameters
    ----------
    weight : (n,) float64
        How strongly each vertex is held, 0 where the muscle does not reach.
    goal : (n, 3) float64
        Displacement that it is held at [mm].
    seal : bool
        Whether the lips stay together.
    """

    weight: FloatArray
    goal: FloatArray
    seal: bool = False

    def mirrored(self, skin: Skin) -> Pull:
        """Return the pull of the other side on a symmetric skin."""
        weight = self.weight if skin.partner is None else self.weight[skin.partner]
        return Pull(weight, skin.mirrored(self.goal), self.seal)

    def joined(self, other: Pull) -> Pull:
        """Return the pull of two muscles that contract together."""
        weight = self.weight + other.weight
        goal = self.weight[:, None] * self.goal + other.weight[:, None] * other.goal
        return Pull(weight, goal / np.maximum(weight, 1e-12)[:, None], self.seal)
