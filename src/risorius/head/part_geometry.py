"""Tell the kind of a loose piece of a head from its shape and place."""

from __future__ import annotations

import numpy as np

from risorius._check import FloatArray
from risorius.landmarks.landmark_set import LandmarkSet

__all__ = ["fit_sphere", "kind_of_component", "side_of_component", "upper_or_lower"]

_EYES = {"left": ("3.7", "3.11"), "right": ("3.12", "3.8")}


def fit_sphere(points: FloatArray) -> tuple[FloatArray, float, float]:
    """Return centre (3,), radius and root mean square residual of the best sphere [mm].

    Linear least squares on ``|p|^2 = 2 c.p + r^2 - |c|^2``, shifted to the mean first.
    """
    mean = points.mean(axis=0)
    shifted = points - mean
    system = np.column_stack([2.0 * shifted, np.ones(len(points))])
    right = (shifted * shifted).sum(axis=1)
    solution = np.linalg.lstsq(system, right, rcond=None)[0]
    radius = float(np.sqrt(max(solution[3] + solution[:3] @ solution[:3], 0.0)))
    distance = np.linalg.norm(shifted - solution[:3], axis=1)
    residual = float(np.sqrt(np.mean((distance - radius) ** 2)))
    return solution[:3] + mean, radius, residual


def _eye_width(landmarks: LandmarkSet) -> float:
    corners = landmarks.positions(("3.7", "3.11"))
    return float(np.linalg.norm(corners[0] - corners[1]))


def side_of_component(points: FloatArray, landmarks: LandmarkSet) -> str:
    """Return ``"left"`` or ``"right"``: the eye that the piece is nearer to."""
    middle = points.mean(axis=0)
    distance = {
        side: np.linalg.norm(landmarks.positions(names).mean(axis=0) - middle)
        for side, names in _EYES.items()
    }
    return "left" if distance["left"] <= distance["right"] else "right"


def upper_or_lower(points: FloatArray, landmarks: LandmarkSet) -> str:
    """Return ``"upper"`` or ``"lower"``: on which side of the mouth line the piece lies."""
    names = [name for name in ("2.2", "2.3", "2.4", "2.5") if name in landmarks]
    line = landmarks.positions(names)[:, 1].mean() if names else points[:, 1].mean()
    return "upper" if 0.5 * (points[:, 1].max() + points[:, 1].min()) >= line else "lower"


def kind_of_component(points: FloatArray, landmarks: LandmarkSet) -> str:
    """Return the part kind of a piece that is not the skin.

    Spheres at the eyes are eyes, thin pieces along the lids are attached to the skin, pieces
    behind the lips are teeth or tongue; everything else moves with the skull (``"other"``).
    """
    width = _eye_width(landmarks)
    side = side_of_component(points, landmarks)
    eye = landmarks.positions(_EYES[side]).mean(axis=0)
    extent = np.ptp(points, axis=0)
    if len(points) >= 12 and extent.max() < 1.6 * width:
        centre, radius, residual = fit_sphere(points)
        if np.linalg.norm(centre - eye) < width and radius < width and residual < 0.12 * radius:
            return f"eye_{side}"
    if np.linalg.norm(points - eye, axis=1).max() < 1.2 * width:
        return f"lashes_{side}"
    return _inside_mouth(points, landmarks, width) or "other"


def _inside_mouth(points: FloatArray, landmarks: LandmarkSet, width: float) -> str | None:
    if landmarks.missing(("2.2", "2.3", "2.4", "2.5")):
        return None
    lips = landmarks.positions(("2.2", "2.3", "2.4", "2.5"))
    middle = 0.5 * (points.max(axis=0) + points.min(axis=0))
    behind = lips[:2].mean(axis=0)[2] - middle[2]
    inside = (
        abs(middle[0] - lips[:, 0].mean()) < 1.3 * width
        and abs(middle[1] - lips[:, 1].mean()) < 1.2 * width
        and 0.0 < behind < 3.0 * width
        and np.ptp(points, axis=0).max() < 3.2 * width
    )
    if not inside:
        return None
    central = np.abs(points[:, 0] - lips[:, 0].mean()) < 0.3 * width
    back = points[:, 2] < points[:, 2].max() - 0.5 * width
    if np.ptp(points, axis=0).max() > 0.9 * width and (central & back).mean() > 0.08:
        return "tongue"
    return f"teeth_{upper_or_lower(points, landmarks)}"
