"""Lips do not pass through each other."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from risorius._check import FloatArray, IntArray
from risorius.anatomy.skin import Skin
from risorius.anatomy.smooth_step import smooth_step
from risorius.mesh.lips import LipSides

__all__ = ["LipContact"]

# Lip tissue within this distance of the contact line gives way [mm].
_SOFT = 9.0
# Stations along the mouth, and how far apart in depth lips may be and still meet [mm].
_STATIONS = 41
_PASSING = 5.0
_BLUR = np.array([0.25, 0.5, 0.25])


@dataclass(frozen=True, eq=False)
class LipContact:
    """The two contact lines and the tissue that parts with them.

    Parameters
    ----------
    upper, lower : (k,) int32
        Vertices of the lines.
    rest : (n, 3) float64
        Skin at rest [mm].
    places : (s,) float64
        Stations along the mouth, from its right corner to its left [mm].
    gap : (s,) float64
        Height of the upper over the lower line at rest, at most 0 [mm].
    station : (n,) float64
        Place of each vertex along the mouth, in stations.
    share : (n,) float64
        How far a vertex gives way: positive above the line, negative below.
    """

    upper: IntArray
    lower: IntArray
    rest: FloatArray
    places: FloatArray
    gap: FloatArray
    share: FloatArray
    station: FloatArray

    @staticmethod
    def build(skin: Skin, lips: LipSides) -> LipContact:
        """Bind the lips of a skin."""
        soft = smooth_step(1.0 - lips.distance / (_SOFT * skin.scale))
        soft = np.where(np.isfinite(lips.distance), soft, 0.0)
        apart = lips.to_lower - lips.to_upper
        sign = np.sign(np.where(np.isfinite(apart), apart, 0.0))
        ends = 1.0 - smooth_step((np.abs(skin.mouth.place) - 0.8) / 0.2)
        share = skin.even(soft * sign * ends)
        upper, lower = lips.slit.upper, lips.slit.lower
        if skin.partner is not None:
            upper, lower = (
                np.unique(np.concatenate([line, skin.partner[line]])) for line in (upper, lower)
            )
        half = skin.mouth.half_width
        places = half * np.linspace(-1.0, 1.0, _STATIONS)
        blank = np.zeros(_STATIONS)
        station = np.clip(skin.positions[:, 0], -half, half)
        lip = LipContact(upper, lower, skin.positions, places, blank, share, station)
        height, _ = lip._gap(np.zeros_like(skin.positions))
        return LipContact(
            lip.upper, lip.lower, lip.rest, places, np.minimum(height, 0.0), share, station
        )

    def part(self, moved: FloatArray) -> FloatArray:
        """Return the displacement (n, 3) with crossing lips pushed apart by equal shares."""
        height, apart = self._gap(moved)
        missing = np.maximum(self.gap - height, 0.0) * (np.abs(apart) < _PASSING)
        if missing.max() <= 1e-3:
            return moved
        for _ in range(2):
            missing = np.maximum(missing, np.convolve(missing, _BLUR, mode="same"))
        lift = 0.5 * self.share * np.interp(self.station, self.places, missing)
        result = moved.copy()
        result[:, 1] += lift
        return result

    def _gap(self, moved: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return height and depth (stations,) of the upper line over the lower one."""
        rows: list[FloatArray] = []
        for line in (self.upper, self.lower):
            points = self.rest[line] + moved[line]
            x, inverse, counts = np.unique(
                self.rest[line, 0].round(3), return_inverse=True, return_counts=True
            )
            # Vertices one above another, as mirrored lines may have, count as their mean.
            points = np.stack(
                [np.bincount(inverse, points[:, axis]) / counts for axis in range(3)], axis=1
            )
            rows.append(np.stack([np.interp(self.places, x, points[:, axis]) for axis in (1, 2)]))
        apart = rows[0] - rows[1]
        return apart[0], apart[1]
