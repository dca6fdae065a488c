"""The jaw: pitch, yaw and protrusion about the condyles."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from risorius._check import FloatArray
from risorius.errors import LandmarkError
from risorius.landmarks.landmark_set import LandmarkSet

__all__ = ["JawAxes", "JawPose", "jaw_axes", "rotate"]


def rotate(
    points: npt.ArrayLike, *, about: FloatArray, axis: FloatArray, angle: npt.ArrayLike
) -> FloatArray:
    """Rotate points about a line by an angle each (Rodrigues).

    ``R v = v cos + (u x v) sin + u (u.v) (1 - cos)`` (thesis eq. 5.1, corrected: erratum E18).

    Parameters
    ----------
    points : (n, 3) array_like
        Points [mm].
    about : (3,) float64
        A point of the line [mm].
    axis : (3,) float64
        Unit vector of the line.
    angle : float or (n,) array_like
        Angle of each point [rad].
    """
    v = np.asarray(points, dtype=np.float64) - about
    theta = np.broadcast_to(np.asarray(angle, dtype=np.float64), (len(v),))[:, None]
    along = (v @ axis)[:, None] * axis
    # Written as v + ... so that angle 0 returns the point itself to the last bit.
    turned = np.sin(theta) * np.cross(axis, v) - (1.0 - np.cos(theta)) * (v - along)
    return np.asarray(points, dtype=np.float64) + turned


@dataclass(frozen=True)
class JawPose:
    """Where the jaw stands: pitch and yaw [deg], protrusion [mm]."""

    pitch: float = 0.0
    yaw: float = 0.0
    protrusion: float = 0.0

    @property
    def at_rest(self) -> bool:
        """Whether nothing moves."""
        return self.pitch == 0.0 and self.yaw == 0.0 and self.protrusion == 0.0


@dataclass(frozen=True, eq=False)
class JawAxes:
    """Axes of the jaw, fixed to the skull.

    Parameters
    ----------
    hinge : (3,) float64
        Middle between the condyles [mm].
    pitch_axis : (3,) float64
        Unit vector; a positive turn opens.
    yaw_axis : (3,) float64
        Unit vector; a positive turn moves the chin to the character's left.
    forward : (3,) float64
        Unit vector of protrusion.
    """

    hinge: FloatArray
    pitch_axis: FloatArray
    yaw_axis: FloatArray
    forward: FloatArray

    def move(
        self, points: npt.ArrayLike, pose: JawPose, *, share: npt.ArrayLike = 1.0
    ) -> FloatArray:
        """Move points with the jaw.

        Pitch first, then yaw, then protrusion (``M = T(protrusion) Yaw Pitch``); a `share` below
        1 turns by that share of the angles, so that skin swings on an arc.

        Parameters
        ----------
        points : (n, 3) array_like
            Points [mm].
        pose : JawPose
        share : float or (n,) array_like
            How far each point follows, 0 to 1.
        """
        weights = np.broadcast_to(np.asarray(share, dtype=np.float64), (len(np.asarray(points)),))
        pitch, yaw = np.radians([pose.pitch, pose.yaw])
        moved = rotate(points, about=self.hinge, axis=self.pitch_axis, angle=weights * pitch)
        moved = rotate(moved, about=self.hinge, axis=self.yaw_axis, angle=weights * yaw)
        return moved + weights[:, None] * (pose.protrusion * self.forward)


def jaw_axes(
    *, condyle_left: FloatArray, condyle_right: FloatArray, landmarks: LandmarkSet
) -> JawAxes:
    """Set up the axes from `condyle_left` (3,), `condyle_right` (3,) [mm] and the chin.

    The hinge runs through the condyles, not through MPEG-4's jaw corners 2.13 and 2.14, which
    the thesis names (erratum E20). Yaw turns about the upright through the middle of the
    condyles, towards 11.4 where it is known; protrusion goes from 7.1 to 2.10 as published where
    7.1 is known, else forwards and slightly down.

    Raises
    ------
    LandmarkError
        If the condyles coincide.
    """
    span = condyle_left - condyle_right
    length = float(np.linalg.norm(span))
    if length == 0.0:
        raise LandmarkError("landmarks: the condyles coincide; the jaw has no axis")
    hinge = 0.5 * (condyle_left + condyle_right)
    pitch_axis = span / length
    top = landmarks.position("11.4") if "11.4" in landmarks else hinge + [0.0, 100.0, 0.0]
    upright = top - hinge
    upright = upright - (upright @ pitch_axis) * pitch_axis
    yaw_axis = upright / np.linalg.norm(upright)
    forward = np.array([0.0, -0.17, 1.0])
    if "7.1" in landmarks and "2.10" in landmarks:
        published = landmarks.position("2.10") - landmarks.position("7.1")
        # A guessed 7.1 must not send the jaw steeply down: 30 degrees is the limit.
        slope = published[1] / max(float(published[2]), 1e-9)
        if published[2] > 0.0 and -0.58 <= slope <= 0.27:
            forward = published
    forward = forward - (forward @ pitch_axis) * pitch_axis
    # +x is left: a turn about +x takes +z towards -y, which opens; about +y it takes +z to +x.
    return JawAxes(hinge, pitch_axis, yaw_axis, forward / np.linalg.norm(forward))
