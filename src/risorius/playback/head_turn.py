"""Turn the whole head of a rig, as streams ask for it.

The head turns as one rigid body about the atlanto-occipital joint, where skull and spine meet: no
sum of morph targets can do that without shrinking the head. Yaw follows pitch follows roll.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.spatial.transform import Rotation

from risorius._check import FloatArray
from risorius.controls.head_turn import head_turn_of
from risorius.errors import LandmarkError
from risorius.head.frame import Frame
from risorius.io.track import TurnTrack
from risorius.landmarks.landmark_set import LandmarkSet, resolve
from risorius.rig.rig import Rig

__all__ = ["HeadJoint"]

_EYES = (("3.7", "3.11"), ("3.8", "3.12"))
_LOBES = ("10.7", "10.8")
# Joint under and behind the eyes' middle, in distances of the eyes; of the built-in skull.
_BELOW, _BEHIND = 0.65, 1.25


@dataclass(frozen=True, eq=False)
class HeadJoint:
    """Where a rig's head turns.

    Parameters
    ----------
    pivot : (3,) float64
        The joint [canonical frame, mm].
    frame : Frame
        Of the rig's file.
    """

    pivot: FloatArray
    frame: Frame

    @staticmethod
    def of_rig(rig: Rig) -> HeadJoint:
        """Find the joint: between the lobes of the ears, or by the eyes without ears.

        Raises
        ------
        LandmarkError
            If the rig carries neither.

        Notes
        -----
        Feature point 7.1, which MPEG-4 turns the head about, lies inside the neck; marked on a
        mesh it sits on the nape and is no joint, so it is not used.
        """
        positions = rig.frame.to_canonical(rig.mesh.positions)
        marks = LandmarkSet((), positions)
        if rig.landmarks:
            marks = resolve(rig.landmarks, rig.mesh).at(positions)
        if all(name in marks for name in _LOBES):
            return HeadJoint(marks.positions(_LOBES).mean(axis=0), rig.frame)
        if not all(name in marks for pair in _EYES for name in pair):
            raise LandmarkError(
                "landmarks: the head turns about a point that is found by the lobes of the ears "
                "(10.7, 10.8) or the corners of the eyes (3.7, 3.8, 3.11, 3.12); give --landmarks"
            )
        left, right = (marks.positions(pair).mean(axis=0) for pair in _EYES)
        apart = float(np.linalg.norm(left - right))
        place = 0.5 * (left + right) - apart * np.array([0.0, _BELOW, _BEHIND])
        return HeadJoint(place, rig.frame)

    def rotation(self, values: Mapping[str, float]) -> FloatArray | None:
        """Return the rotation (3, 3) of a frame [canonical frame], None where there is no turn."""
        pitch, yaw, roll = head_turn_of(values)
        if not (pitch or yaw or roll):
            return None
        return Rotation.from_euler("YXZ", [yaw, -pitch, -roll], degrees=True).as_matrix()

    def turned(self, positions: npt.ArrayLike, values: Mapping[str, float]) -> FloatArray:
        """Return positions (n, 3) [file frame] turned as a frame's values ask."""
        points = np.asarray(positions, np.float64)
        rotation = self.rotation(values)
        if rotation is None:
            return points
        pivot, turn = self._in_file(rotation)
        return (points - pivot) @ turn.T + pivot

    def track(self, frames: Iterable[Mapping[str, float]]) -> TurnTrack | None:
        """Return the turns of all frames as a track; None if the head never turns."""
        rotations: list[FloatArray] = []
        turns = False
        before = np.array([0.0, 0.0, 0.0, 1.0])
        for values in frames:
            rotation = self.rotation(values)
            quaternion = np.array([0.0, 0.0, 0.0, 1.0])
            if rotation is not None:
                turns = True
                quaternion = Rotation.from_matrix(self._in_file(rotation)[1]).as_quat()
            # Of q and -q the one that is nearer to the last: players go the short way.
            before = -quaternion if float(quaternion @ before) < 0.0 else quaternion
            rotations.append(before)
        if not turns:
            return None
        return TurnTrack(self.frame.to_input(self.pivot[None])[0], np.stack(rotations))

    def _in_file(self, rotation: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the joint [file unit] and a canonical rotation in the axes of the file."""
        axes = self.frame.rotation
        return self.frame.to_input(self.pivot[None])[0], axes.T @ rotation @ axes
