"""The lining of the mouth stays behind the skin in front of it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from risorius._check import BoolArray, FloatArray, IntArray
from risorius.anatomy.outwards import unit
from risorius.anatomy.skin import Skin
from risorius.mesh.lips import LipSides
from risorius.spatial.raycast import Scene

__all__ = ["LiningContact"]

# Lining this near to the margin of its lip goes with it and has no thickness to keep [mm].
_MARGIN = 1.0
# Up to here it lies on the teeth, and the lip in front of it gives way instead [mm].
_ON_TEETH = 5.0
# Skin farther in front than this is not met [mm].
_FARTHEST = 45.0
# The tissue in front keeps this share of its thickness, up to so thick [mm].
_LEFT, _THICKEST = 0.8, 9.0
# A push is spread over the lining beside it: rounds, passes a round, and what makes up for both.
_ROUNDS, _PASSES, _GAIN = 6, 3, 1.5
# Passes over which a lip that gives way takes the skin around along.
_EASE = 14


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
    firm : (k,) bool
        Lining that lies on teeth: the skin in front of it moves instead.
    """

    skin: Skin
    vertices: IntArray
    corners: IntArray
    shares: FloatArray
    directions: FloatArray
    slack: FloatArray
    firm: BoolArray

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
        firm = lips.distance[lining[kept]] < _ON_TEETH * skin.scale
        # A lip is thinnest at its margin, where nothing but the order of its sides counts.
        slack = gap - np.where(firm, 0.5 * least, least)
        return LiningContact(
            skin, lining[kept], corners[kept], hits.bary[kept], ahead[kept], slack, firm
        )

    def hold_back(self, moved: FloatArray) -> FloatArray:
        """Return the displacement (n, 3) [mm] with the lining behind the skin in front of it.

        Parameters
        ----------
        moved : (n, 3) float64
            Displacement of the posed skin [mm].
        """
        result = moved
        for number in range(_ROUNDS):
            front = np.einsum("kc,kcd->kd", self.shares, result[self.corners])
            nearer = np.einsum("kd,kd->k", result[self.vertices] - front, self.directions)
            excess = np.maximum(nearer - self.slack, 0.0)
            if not excess.any():
                break
            push = np.zeros_like(moved)
            push[self.vertices] = -np.where(self.firm, 0.0, excess)[:, None] * self.directions
            forward = self._forward(excess)
            last = number == _ROUNDS - 1
            if not last:
                push = _GAIN * self._spread(push, self.vertices)
            result = result + push + self._eased(forward)
        return result

    def _forward(self, excess: FloatArray) -> FloatArray:
        """Return how the skin in front of the firm lining (n, 3) gives way."""
        rows = np.flatnonzero(self.firm & (excess > 0.0))
        result = np.zeros_like(self.skin.positions)
        weight = np.zeros(len(result))
        for corner in range(3):
            place, share = self.corners[rows, corner], self.shares[rows, corner]
            np.add.at(result, place, (share * excess[rows])[:, None] * self.directions[rows])
            np.add.at(weight, place, share)
        hit = weight > 0.0
        result[hit] /= weight[hit, None]
        return result

    def _eased(self, forward: FloatArray) -> FloatArray:
        """Return a push of the front (n, 3) that carries the lip around along, without a beak."""
        most = np.abs(forward).max(initial=0.0)
        if most == 0.0:
            return forward
        for _ in range(_EASE):
            forward = self.skin.average @ forward
        forward[self.vertices] = 0.0
        # Averages lose height; the whole hill is raised so that its top is as high as before.
        return forward * (most / max(np.abs(forward).max(), 1e-12))

    def _spread(self, push: FloatArray, among: IntArray) -> FloatArray:
        for _ in range(_PASSES):
            push = self.skin.average @ push
        only = np.zeros_like(push)
        only[among] = push[among]
        return only
