"""Regions of the face and which muscles may move them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from risorius._check import FloatArray
from risorius.anatomy.smooth_step import smooth_step
from risorius.errors import ParameterError
from risorius.head.head import Head
from risorius.mesh.lids import LidMargins
from risorius.mesh.lips import LipSides

__all__ = ["REGIONS", "Regions", "find_regions"]

REGIONS = ("upper", "middle", "lower", "nose", "static")
"""Brow and forehead; cheeks and upper lip; lower lip and chin; nose; what never moves.

The paper names the first three and the last; the nose is ours: it must not follow a smile.
"""


@dataclass(frozen=True, eq=False)
class Regions:
    """Regions of a skin of n vertices.

    Parameters
    ----------
    weights : (n, 4) float64
        Share of upper, middle and lower face and nose; soft between them on the cheeks and at the
        eyes, and exactly 0 or 1 on the two lips.
    mobility : (n,) float64
        1 where muscles may act, 0 on static skin: back of the head, ears, lids (which have
        their own device), skin behind the lips fades.
    """

    weights: FloatArray
    mobility: FloatArray

    def permission(self, names: Sequence[str]) -> FloatArray:
        """Return the weight (n,) of a muscle that may move the regions `names`.

        Raises
        ------
        ParameterError
            If a region is unknown.
        """
        unknown = [name for name in names if name not in REGIONS]
        if unknown:
            raise ParameterError(
                f"regions: {', '.join(unknown)} is not one of {', '.join(REGIONS)}"
            )
        columns = [REGIONS.index(name) for name in names if name != "static"]
        return self.weights[:, columns].sum(axis=1)

    @property
    def labels(self) -> np.ndarray:
        """Region name (n,) of each vertex: the one with the largest share."""
        largest = np.argmax(self.weights, axis=1)
        return np.where(self.mobility > 0.0, np.asarray(REGIONS)[largest], "static")


def find_regions(head: Head, lips: LipSides, margins: dict[str, LidMargins]) -> Regions:
    """Label the skin of `head`.

    Parameters
    ----------
    head : Head
    lips : LipSides
    margins : mapping of side to LidMargins
        Lids keep still under muscles, and fade into the skin around them.
    """
    points = head.skin.mesh.positions
    marks = head.landmarks
    eyes = float(marks.positions(("3.7", "3.11", "3.8", "3.12"))[:, 1].mean())
    chin = float(marks.position("2.1")[1])
    height = eyes - chin
    width = lips.width
    upper = smooth_step((points[:, 1] - (eyes - 0.02 * height)) / (0.1 * height))
    lower = _lower(lips)
    middle = 1.0 - np.maximum(upper, lower)
    nose = _nose(head, points, height) * (1.0 - lower) * ~lips.inside
    others = np.stack([upper * (1.0 - lower), np.maximum(middle, 0.0), lower], axis=1)
    weights = np.column_stack([others * (1.0 - nose)[:, None], nose])
    weights /= np.maximum(weights.sum(axis=1, keepdims=True), 1e-12)
    mobility = _ahead(head, points, height)
    for margin in margins.values():
        band = 1.2 * margin.height
        mobility = mobility * smooth_step((margin.distance - 0.1 * margin.height) / band)
        mobility[margin.slit.inside] = 0.0
    deep = lips.inside & (lips.distance > 0.35 * width)
    fade = smooth_step(1.0 - (lips.distance - 0.12 * width) / (0.3 * width))
    mobility = np.where(lips.inside, mobility * fade, mobility)
    mobility[deep & (fade <= 0.0)] = 0.0
    return Regions(weights, mobility)


def _lower(lips: LipSides) -> FloatArray:
    """Return the lower face: 0 on the whole upper side, 1 a little way into the lower one."""
    share = lips.share()
    return smooth_step((share - 0.5) / 0.3)


def _nose(head: Head, points: FloatArray, height: float) -> FloatArray:
    """Return how far (n,) a vertex belongs to the nose below its root."""
    marks = head.landmarks
    base = (
        marks.position("9.15")
        if "9.15" in marks
        else marks.position("9.3") - [0.0, 0.09 * height, 0.0]
    )
    wings = (
        marks.positions(("9.1", "9.2"))[:, 0]
        if "9.1" in marks and "9.2" in marks
        else base[0] + 0.16 * height * np.array([1.0, -1.0])
    )
    half = 0.5 * float(np.ptp(wings))
    eyes = float(marks.positions(("3.11", "3.8"))[:, 1].mean())
    beside = smooth_step(1.0 - (np.abs(points[:, 0] - wings.mean()) - 0.85 * half) / (0.5 * half))
    above = smooth_step((points[:, 1] - base[1] + 0.04 * height) / (0.07 * height))
    below = smooth_step((eyes - points[:, 1]) / (0.15 * height))
    return beside * above * below


def _ahead(head: Head, points: FloatArray, height: float) -> FloatArray:
    """Return 1 on the face and 0 behind the ears' front and down the neck, soft between."""
    marks = head.landmarks
    corner = marks.positions(("3.7", "3.12"))
    behind = float(corner[:, 2].mean()) - 0.55 * height
    chin = float(marks.position("2.1")[1])
    side = smooth_step((points[:, 2] - behind) / (0.25 * height))
    neck = smooth_step((points[:, 1] - (chin - 0.45 * height)) / (0.3 * height))
    return side * neck
