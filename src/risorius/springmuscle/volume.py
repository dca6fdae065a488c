"""Tissue that springs push together swells out: cheeks rise, the fold beside them deepens."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from risorius._check import BoolArray, FloatArray, IntArray
from risorius.anatomy.mechanics import Mechanics
from risorius.anatomy.skin import Skin
from risorius.anatomy.smooth_step import smooth_step
from risorius.anatomy.swelling import Swelling

__all__ = ["Volume"]

# Lids are thin: tissue swells from the first distance from their margins on, and fully from the
# second on, in openings of the eye.
_NONE, _FULL = 0.5, 1.6


@dataclass(frozen=True, eq=False)
class Volume:
    """Swelling of the whole skin of n vertices.

    Parameters
    ----------
    active : (m,) int32
        Vertices that may swell.
    rest : (m, 3) float64
        Their places at rest [mm].
    share : (m,) float64
        How much of its volume the tissue under each keeps.
    swelling : Swelling
    """

    active: IntArray
    rest: FloatArray
    share: FloatArray
    swelling: Swelling

    @staticmethod
    def build(skin: Skin, mechanics: Mechanics, fixed: BoolArray, share: float) -> Volume:
        """Measure the tissue of a skin, `fixed` (n,) apart, that keeps a `share` of its volume."""
        active = np.flatnonzero(~fixed).astype(np.int32)
        kept = np.full(len(skin.positions), share)
        for margins in mechanics.margins.values():
            away = np.where(np.isfinite(margins.distance), margins.distance, np.inf)
            kept = kept * smooth_step((away / margins.height - _NONE) / (_FULL - _NONE))
        kept = skin.even(kept * ~skin.hidden)[active]
        rest = np.ascontiguousarray(skin.positions[active])
        return Volume(active, rest, kept, Swelling.build(skin, mechanics, active))

    def swollen(self, moved: FloatArray) -> FloatArray:
        """Return the displacement (n, 3) of the skin with swollen tissue [mm]."""
        if not moved.any():
            return moved
        result = moved.copy()
        out = self.swelling.out(self.rest + moved[self.active])
        result[self.active] += self.share[:, None] * out
        return result
