"""The measures of a face that outlines are relative to."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from risorius._check import FloatArray
from risorius.errors import LandmarkError
from risorius.landmarks.landmark_set import LandmarkSet
from risorius.landmarks.sides import require

__all__ = ["REFERENCE_WIDTH", "FaceMeasure"]

REFERENCE_WIDTH = 91.0
"""Distance of the outer eye corners that lengths of recipes are given for [mm]."""

_NEEDED = ("2.2", "2.3", "3.7", "3.12")


@dataclass(frozen=True, eq=False)
class FaceMeasure:
    """Size of a face, and where its landmarks are.

    Parameters
    ----------
    landmarks : mapping of str to (3,) float64
        [mm, canonical frame].
    width : float
        Distance of the outer eye corners 3.7 and 3.12 [mm].
    height : float
        Height of the middle of the outer eye corners above the middle of the lips [mm].
    """

    landmarks: Mapping[str, FloatArray]
    width: float
    height: float

    @staticmethod
    def of(landmarks: LandmarkSet) -> FaceMeasure:
        """Measure a face.

        Raises
        ------
        LandmarkError
            If outer eye corners or inner lips are missing, or the mouth is not below the eyes.
        """
        require(landmarks, _NEEDED, purpose="the size of the face")
        places = {name: landmarks.position(name) for name in landmarks}
        upper, lower, left, right = (places[name] for name in _NEEDED)
        width = float(np.linalg.norm(left - right))
        height = float(0.5 * (left + right - upper - lower)[1])
        if not (width > 0.0 and height > 0.1 * width):
            raise LandmarkError(
                f"landmarks: the mouth (2.2, 2.3) lies {height:.1f} mm below the outer eye corners "
                f"(3.7, 3.12), which are {width:.1f} mm apart; one of the four is wrong"
            )
        return FaceMeasure(places, width, height)

    @property
    def scale(self) -> float:
        """Millimetres of this head per millimetre of a recipe."""
        return self.width / REFERENCE_WIDTH

    @property
    def unit(self) -> FloatArray:
        """(3,) lengths that offsets of outlines count in: width, height, width [mm]."""
        return np.array([self.width, self.height, self.width])
