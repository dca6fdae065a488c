"""The lining of the mouth stays behind the skin in front of it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from risorius._check import FloatArray, IntArray
from risorius.anatomy.outwards import unit
from risorius.anatomy.skin import Skin
from risorius.mesh.lips import LipSides
from risorius.spatial.raycast import Scene

__all__ = ["LiningContact"]

# Lining this near to the margin of its lip goes with it and has no thickness to keep [mm].
_MARGIN = 5.0
# Skin farther in front than this is not met [mm].
_FARTHEST = 45.0
# The tissue in front keeps this share of its thickness, up to so thick [mm].
_LEFT, _THICKEST = 0.8, 9.0
# A push is spread over the lining beside it: rounds, passes a round, and what makes up for both.
_ROUNDS, _PASSES, _GAIN = 6, 3, 1.5


@dataclass(frozen=True, eq=False)
class LiningContact:
    """Lining of the mouth and the skin that it may not come out of.

    Parameters
    ----------
    skin : Skin
    vertices : (k,) int32
        Vertices of the lining with skin in front.
    corners : (k, 3) int32
        Vertices of the triangle in front of each.
    shares : (k, 3) float64
        Barycentric coordinates there.
    directions : (k, 3) float64
        From the lining to that skin, unit.
    slack : (k,) float64
        How far the lining may come nearer to it [mm].
    """

    skin: Skin
    vertices: IntArray
    corners: IntArray
    shares: FloatArray
    directions: FloatArray
    slack: FloatArray

    @staticmethod
    def build(skin: Skin, lips: LipSides) -> LiningContact:
        """Find the skin in front of the lining of a mouth."""
        deep = lips.inside & (lips.distance > _MARGIN * skin.scale) & (skin.mass > 1e-9)
        lining = np.flatnonzero(deep).astype(np.int32)
        # Rays straight ahead and turned to the side, as cheeks curve; the nearest skin counts.
        ahead = unit(np.stack([np.tanh(skin.positions[lining, 0] / (40.0 * skin.scale)),
                               np.zeros(len(lining)), np.ones(len(lining))], axis=1))  # fmt: skip
        faces = skin.mesh.faces
        shown = ~skin.hidden[faces].any(axis=1)
        limit = _FARTHEST * skin.scale
        hits = Scene([skin.mesh]).cast(
            skin.positions[lining], ahead, face_mask=shown, cull="front", max_distance=limit
        )
        corners = faces[np.maximum(hits.face, 0)]
        side = skin.mouth.side
        kept = hits.hit & (side[corners] * side[lining][:, None] >= 0.0).all(axis=1)
        gap = hits.distance[kept]
        least = np.minimum(_LEFT * gap, _THICKEST * skin.scale)
        return LiningContact(
            skin, lining[kept], corners[kept], hits.bary[kept], ahead[kept], gap - least
        )

    def hold_back(self, moved: FloatArray) -> FloatArray:
        """Return the displacement (n, 3) [mm] with the lining behind the skin in front of it.

        Parameters
        ----------
        moved : (n, 3) float64
            Displacement of the posed skin [mm].
        """
        front = np.einsum("kc,kcd->kd", self.shares, moved[self.corners])
        result = moved
        for number in range(_ROUNDS):
            nearer = np.einsum("kd,kd->k", result[self.vertices] - front, self.directions)
            excess = np.maximum(nearer - self.slack, 0.0)
            if not excess.any():
                break
            push = np.zeros_like(moved)
            push[self.vertices] = -excess[:, None] * self.directions
            last = number == _ROUNDS - 1
            if not last:
                push = _GAIN * self._spread(push)
            result = result + push
        return result

    def _spread(self, push: FloatArray) -> FloatArray:
        for _ in range(_PASSES):
            push = self.skin.average @ push
        only = np.zeros_like(push)
        only[self.vertices] = push[self.vertices]
        return only
