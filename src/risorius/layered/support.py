"""Bone and teeth beneath the skin: what sheet muscles draw slides over them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from risorius._check import FloatArray
from risorius.anatomy.mechanics import Mechanics
from risorius.anatomy.skin import Skin
from risorius.anatomy.support import support_directions

__all__ = ["Support"]

# Skin itself gives nothing; of the tissue beneath it this share gives way, and no more than so
# much counts [mm].
_SKIN, _SHARE, _LEAST, _MOST = 3.0, 0.6, 0.5, 6.0


@dataclass(frozen=True, eq=False)
class Support:
    """What lies beneath a skin of n vertices.

    Parameters
    ----------
    out : (n, 3) float64
        Unit direction out of the skull.
    give : (n,) float64
        How far the skin may come nearer to it [mm].
    """

    out: FloatArray
    give: FloatArray

    @staticmethod
    def of(skin: Skin, mechanics: Mechanics) -> Support:
        """Measure the support of a skin; the lining of the mouth has that of the lip before it."""
        marks = mechanics.head.landmarks
        height = float(
            marks.positions(("3.7", "3.11", "3.8", "3.12"))[:, 1].mean() - marks.position("2.1")[1]
        )
        out = support_directions(skin.positions, hinge=mechanics.jaw.hinge, face_height=height)
        give = np.clip(_SHARE * (skin.depth - _SKIN), _LEAST, _MOST)
        shown = np.flatnonzero(~skin.hidden)
        hidden = np.flatnonzero(skin.hidden)
        near = cKDTree(skin.positions[shown]).query(skin.positions[hidden])[1]
        give[hidden] = give[shown[near]]
        give = skin.even(skin.smoothed(give, 8)) * skin.scale
        return Support(out, give)

    def settle(self, field: FloatArray) -> FloatArray:
        """Return a displacement (n, 3) [mm] that goes no farther inwards than tissue gives.

        The part s along the support becomes ``-g tanh(-s / g)`` where it goes inwards.
        """
        along = np.einsum("nd,nd->n", field, self.out)
        soft = -self.give * np.tanh(np.maximum(-along, 0.0) / self.give)
        return field + (np.where(along < 0.0, soft - along, 0.0))[:, None] * self.out
