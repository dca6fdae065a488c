"""The frame and unit of an input head, and the way back to them."""

from __future__ import annotations

import warnings
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from risorius._check import FloatArray
from risorius.errors import LandmarkError, ParameterError, RisoriusWarning
from risorius.landmarks.landmark_set import LandmarkSet
from risorius.landmarks.sides import require, sagittal_axis

__all__ = ["MILLIMETRES", "Frame", "detect_frame"]

MILLIMETRES = {"mm": 1.0, "cm": 10.0, "dm": 100.0, "m": 1000.0, "in": 25.4, "ft": 304.8}
"""Length of each unit that an input may have [mm]."""

# Distance of the eye centres of an adult and the share of it that still counts as adult [mm].
_EYE_DISTANCE = 63.0
_EYE_TOLERANCE = 1.45
# Rotations closer than this to a signed axis permutation are taken as one: a head may be tilted.
_SNAP_DEGREES = 30.0
# Axes that are given and further than this from the landmarks are probably a mistake.
_DOUBTFUL_DEGREES = 60.0


@dataclass(frozen=True, eq=False)
class Frame:
    """Similarity between the input's frame and the canonical one.

    ``canonical = scale * (input - origin) @ rotation.T``

    Parameters
    ----------
    rotation : (3, 3) float64
        Its rows are the character's left, up and forward, in input axes.
    scale : float
        Length of one input unit [mm].
    origin : (3,) float64
        Input point that becomes the canonical origin [input unit].
    unit : str
        One of `MILLIMETRES`, or ``"custom"`` where none fits.
    """

    rotation: FloatArray
    scale: float
    origin: FloatArray
    unit: str

    @staticmethod
    def canonical() -> Frame:
        """Return the frame of a head that is canonical already."""
        return Frame(np.eye(3), 1.0, np.zeros(3), "mm")

    def to_canonical(self, points: npt.ArrayLike) -> FloatArray:
        """Map input points (n, 3) to the canonical frame [mm]."""
        return self.scale * (np.asarray(points, dtype=np.float64) - self.origin) @ self.rotation.T

    def to_input(self, points: npt.ArrayLike) -> FloatArray:
        """Map canonical points (n, 3) [mm] back to the input's frame and unit."""
        return np.asarray(points) @ self.rotation / self.scale + self.origin

    def vectors_to_input(self, vectors: npt.ArrayLike) -> FloatArray:
        """Map canonical displacements (..., 3) [mm] to the input's frame and unit."""
        return np.asarray(vectors) @ self.rotation / self.scale

    def vectors_to_canonical(self, vectors: npt.ArrayLike) -> FloatArray:
        """Map input displacements (..., 3) to the canonical frame [mm]."""
        return self.scale * np.asarray(vectors, dtype=np.float64) @ self.rotation.T

    def describe(self) -> str:
        """Return one line for people: unit, and where up and forward point in the input."""
        up, forward = (_axis_name(self.rotation[row]) for row in (1, 2))
        return f"unit {self.unit} ({self.scale:g} mm), up {up}, forward {forward}"


def _axis_name(direction: FloatArray) -> str:
    axis = int(np.argmax(np.abs(direction)))
    sign = "+" if direction[axis] > 0 else "-"
    exact = abs(direction[axis]) > 1.0 - 1e-9
    return f"{sign}{'XYZ'[axis]}" if exact else f"near {sign}{'XYZ'[axis]}"


def detect_frame(
    landmarks: LandmarkSet, *, unit: str | None = None, axes: str | None = None
) -> Frame:
    """Find unit and axes of a head from its landmarks.

    Parameters
    ----------
    landmarks : LandmarkSet
        In the input's frame; needs the eye corners, and the chin or the lower lip.
    unit : str, optional
        One of `MILLIMETRES`, if known.
    axes : str, optional
        Up and forward axis of the input, for example ``"+Y+Z"``, if known.

    Raises
    ------
    LandmarkError
        If the landmarks needed are missing or degenerate.
    ParameterError
        If `unit` or `axes` is not understood.
    """
    require(landmarks, ("3.7", "3.11", "3.8", "3.12"), purpose="the frame of the head")
    left_eye = landmarks.positions(("3.7", "3.11")).mean(axis=0)
    right_eye = landmarks.positions(("3.8", "3.12")).mean(axis=0)
    rotation = _rotation_from_axes(axes, landmarks) if axes else _rotation(landmarks)
    distance = float(np.linalg.norm(left_eye - right_eye))
    if distance == 0.0:
        raise LandmarkError("landmarks: left and right eye corners (3.7 3.11 3.8 3.12) coincide")
    scale, name = _scale(distance, unit)
    return Frame(rotation, scale, 0.5 * (left_eye + right_eye), name)


def _rotation(landmarks: LandmarkSet) -> FloatArray:
    rotation = _measured_rotation(landmarks)
    snapped = _nearest_permutation(rotation)
    angle = _degrees_between(rotation, snapped)
    if angle <= _SNAP_DEGREES:
        return snapped
    warnings.warn(
        f"frame: the head is turned {angle:.0f} degrees off the axes; it is rotated inside and "
        "turned back on output (give --axes to override)",
        RisoriusWarning,
        stacklevel=3,
    )
    return rotation


def _degrees_between(first: FloatArray, second: FloatArray) -> float:
    cosine = 0.5 * (float(np.trace(first @ second.T)) - 1.0)
    return float(np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0))))


def _measured_rotation(landmarks: LandmarkSet) -> FloatArray:
    low = next((name for name in ("2.1", "2.10", "8.2", "2.3") if name in landmarks), None)
    if low is None:
        raise LandmarkError("landmarks: the frame of the head needs 2.1 (lowest point of the chin)")
    across = sagittal_axis(landmarks)
    eyes = landmarks.positions(("3.7", "3.11", "3.8", "3.12")).mean(axis=0)
    up = eyes - landmarks.position(low)
    up = up - (up @ across) * across
    length = float(np.linalg.norm(up))
    if length == 0.0:
        raise LandmarkError(f"landmarks: {low!r} lies on the line through the eyes")
    up /= length
    return np.array([across, up, np.cross(across, up)], dtype=np.float64)


def _nearest_permutation(rotation: FloatArray) -> FloatArray:
    """Return the right-handed signed axis permutation closest to `rotation`."""
    result = np.zeros((3, 3))
    left = rotation.copy()
    for _ in range(2):
        row, column = np.unravel_index(np.argmax(np.abs(left)), (3, 3))
        result[row, column] = np.sign(left[row, column])
        left[row, :] = 0.0
        left[:, column] = 0.0
    row = int(np.flatnonzero(~result.any(axis=1))[0])
    result[row] = np.cross(result[(row + 1) % 3], result[(row + 2) % 3])
    return result


def _rotation_from_axes(axes: str, landmarks: LandmarkSet) -> FloatArray:
    text = axes.strip().upper().replace(" ", "").replace(",", "")
    rows: list[FloatArray] = []
    while text:
        sign = -1.0 if text[0] == "-" else 1.0
        text = text.lstrip("+-")
        if not text or text[0] not in "XYZ":
            break
        direction = np.zeros(3)
        direction["XYZ".index(text[0])] = sign
        rows.append(direction)
        text = text[1:]
    if text or len(rows) != 2 or abs(rows[0] @ rows[1]) > 0:
        raise ParameterError(
            f"axes: {axes!r} is not understood; give up and forward, for example '+Y+Z' or '+Z-Y'"
        )
    up, forward = rows
    rotation = np.array([np.cross(up, forward), up, forward], dtype=np.float64)
    angle = _degrees_between(rotation, _measured_rotation(landmarks))
    if angle > _DOUBTFUL_DEGREES:
        warnings.warn(
            f"axes: {axes!r} is {angle:.0f} degrees off what the landmarks say; the face will not "
            "move well if that is a mistake (leave out --axes to trust the landmarks)",
            RisoriusWarning,
            stacklevel=4,
        )
    return rotation


def _scale(distance: float, unit: str | None) -> tuple[float, str]:
    if unit is not None:
        if unit not in MILLIMETRES:
            raise ParameterError(f"unit: {unit!r} is not one of {', '.join(MILLIMETRES)}")
        length = distance * MILLIMETRES[unit]
        if not 1 / 3 < length / _EYE_DISTANCE < 3:
            warnings.warn(
                f"unit: in {unit} the eyes are {length:.4g} mm apart (an adult's {_EYE_DISTANCE:g})"
                "; the head is scaled to adult size inside and back on output",
                RisoriusWarning,
                stacklevel=4,
            )
            return _EYE_DISTANCE / distance, unit
        return MILLIMETRES[unit], unit
    best = min(MILLIMETRES, key=lambda u: abs(np.log(distance * MILLIMETRES[u] / _EYE_DISTANCE)))
    ratio = distance * MILLIMETRES[best] / _EYE_DISTANCE
    if max(ratio, 1 / ratio) <= _EYE_TOLERANCE:
        return MILLIMETRES[best], best
    warnings.warn(
        f"unit: eyes {distance:.4g} apart fit no unit (an adult's are {_EYE_DISTANCE:g} mm); the "
        "head is scaled to adult size inside and back on output (give --unit to override)",
        RisoriusWarning,
        stacklevel=4,
    )
    return _EYE_DISTANCE / distance, "custom"
