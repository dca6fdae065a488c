"""Named views of a head: where the camera stands and what it frames."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from risorius._check import FloatArray, one_of
from risorius.landmarks.landmark_set import LandmarkSet
from risorius.landmarks.sides import require
from risorius.render.camera import Camera

__all__ = ["VIEWS", "View", "camera_for"]

_EYES = ("3.7", "3.11", "3.8", "3.12")


@dataclass(frozen=True)
class View:
    """A way to look at a head.

    Parameters
    ----------
    region : str
        What is framed: ``"head"``, ``"face"``, ``"mouth"`` or ``"eyes"``.
    yaw, pitch : float
        Turn of the camera [deg]; yaw > 0 shows the character's left side.
    """

    region: str
    yaw: float = 0.0
    pitch: float = 0.0


VIEWS = MappingProxyType(
    {
        "front": View("head"),
        "three-quarter": View("head", yaw=35.0, pitch=6.0),
        "profile": View("head", yaw=90.0),
        "face": View("face"),
        "mouth": View("mouth"),
        "eyes": View("eyes"),
    }
)
"""The views by name."""


def camera_for(
    view: str,
    landmarks: LandmarkSet,
    positions: FloatArray,
    *,
    yaw: float | None = None,
    pitch: float | None = None,
    aspect: float = 1.0,
) -> Camera:
    """Return the camera of a view, the same for every pose of a head.

    Parameters
    ----------
    view : str
        One of `VIEWS`.
    landmarks : LandmarkSet
        Of the neutral head, canonical frame [mm]. Without eyes and chin, `positions` are framed.
    positions : (n, 3) float64
        All vertices of the neutral head [mm].
    yaw, pitch : float, optional
        Turn instead of the view's own [deg].
    aspect : float
        Width over height of the picture.

    Raises
    ------
    ParameterError
        If there is no such view.
    LandmarkError
        If a close-up lacks its landmarks.
    """
    chosen = VIEWS[one_of("view", view, tuple(VIEWS))]
    if chosen.region in ("head", "face") and landmarks.missing((*_EYES, "2.1")):
        focus, margin = positions, 1.08
    else:
        focus, margin = _REGIONS[chosen.region](landmarks), 1.0
    return Camera.framing(
        focus,
        yaw=chosen.yaw if yaw is None else yaw,
        pitch=chosen.pitch if pitch is None else pitch,
        margin=margin,
        fov_degrees=15.0,
        aspect=aspect,
    )


def _measure(landmarks: LandmarkSet) -> tuple[FloatArray, FloatArray, float]:
    """Return the middle of the eyes, the chin and their distance [mm]."""
    eyes = landmarks.positions(_EYES).mean(axis=0)
    chin = landmarks.position("2.1")
    return eyes, chin, float(np.linalg.norm(eyes - chin))


def _diamond(middle: FloatArray, half: FloatArray) -> FloatArray:
    """Return the six points at `middle` plus or minus each of the half axes."""
    axes = np.diag(half)
    return np.concatenate([middle + axes, middle - axes])


def _head(landmarks: LandmarkSet) -> FloatArray:
    eyes, chin, height = _measure(landmarks)
    nose = landmarks.position("9.3")[2] if "9.3" in landmarks else eyes[2] + 0.3 * height
    top, bottom = eyes[1] + 1.12 * height, chin[1] - 0.30 * height
    front, back = nose + 0.12 * height, eyes[2] - 1.6 * height
    middle = np.array([eyes[0], 0.5 * (top + bottom), 0.5 * (front + back)])
    half = np.array([0.85 * height, 0.5 * (top - bottom), 0.5 * (front - back)])
    return _diamond(middle, half)


def _face(landmarks: LandmarkSet) -> FloatArray:
    eyes, chin, height = _measure(landmarks)
    top, bottom = eyes[1] + 0.52 * height, chin[1] - 0.26 * height
    middle = np.array([eyes[0], 0.5 * (top + bottom), eyes[2]])
    return _diamond(middle, np.array([0.66 * height, 0.5 * (top - bottom), 0.0]))


def _mouth(landmarks: LandmarkSet) -> FloatArray:
    require(landmarks, ("2.4", "2.5", "2.2"), purpose="the view of the mouth")
    left, right = landmarks.positions(("2.4", "2.5"))
    width = float(np.linalg.norm(left - right))
    middle = 0.5 * (left + right)
    middle[2] = landmarks.position("2.2")[2]
    middle[1] -= 0.17 * width
    return _diamond(middle, np.array([1.05, 0.9, 0.0]) * width)


def _eyes(landmarks: LandmarkSet) -> FloatArray:
    require(landmarks, _EYES, purpose="the view of the eyes")
    left, right = landmarks.positions(("3.7", "3.12"))
    width = float(np.linalg.norm(left - right))
    middle = landmarks.positions(_EYES).mean(axis=0)
    middle[1] += 0.05 * width
    return _diamond(middle, np.array([0.62, 0.34, 0.0]) * width)


_REGIONS: dict[str, Callable[[LandmarkSet], FloatArray]] = {
    "head": _head,
    "face": _face,
    "mouth": _mouth,
    "eyes": _eyes,
}
