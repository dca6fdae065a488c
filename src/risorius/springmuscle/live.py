"""A face that is moved while it is looked at: as many steps as fit into a frame."""

from __future__ import annotations

import time
from collections.abc import Mapping
from typing import TYPE_CHECKING

from risorius._check import FloatArray, as_number
from risorius.controls.control import Pose, resolve_pose
from risorius.errors import ParameterError
from risorius.solvers.leapfrog import PackedRun
from risorius.solvers.springs import SpringState
from risorius.springmuscle.driving import Drive
from risorius.springmuscle.relax import start_of

if TYPE_CHECKING:
    from risorius.springmuscle.face import SpringFace

__all__ = ["LiveFace", "steps_that_fit"]

# Steps per frame at the most, a quick machine would only come to rest earlier.
_MOST_STEPS = 400
# How much a new measurement of a step's duration counts.
_FRESH = 0.3
# Before anything has been measured.
_FIRST_STEPS = 5


def steps_that_fit(slot: float, seconds_per_step: float) -> int:
    """Return how many equal steps fit into `slot` seconds, at least one (section 5).

    Parameters
    ----------
    slot : float
        Time for one frame [s].
    seconds_per_step : float
        As measured; 0 if nothing has been measured yet, for a first handful of steps.
    """
    if seconds_per_step <= 0.0:
        return _FIRST_STEPS
    return int(min(max(slot / seconds_per_step, 1.0), _MOST_STEPS))


class LiveFace:
    """The state of a face in motion.

    Each frame the muscles take their new place at once, the skin starts from where it was moved
    by the over-relaxation, and the springs take as many steps as fit.

    Parameters
    ----------
    face : SpringFace
    """

    def __init__(self, face: SpringFace) -> None:
        self._face = face
        self._values: Mapping[str, float] = resolve_pose(face.controls, {}).values
        self._drive: Drive = face.driver.drive(self._values)
        self._guess = self._drive.reference
        self._run = PackedRun(
            face.springs.network, SpringState.still(self._guess), self._drive.control,
            face.parameters.motion,
        )  # fmt: skip
        self._changed = False
        self._seconds = 0.0
        self.steps = 0
        """Steps taken in the last frame."""

    def set(self, pose: Pose) -> None:
        """Ask for a pose, which the face moves to over the next frames.

        Raises
        ------
        ParameterError
            If a control is unknown or not finite.
        """
        values = resolve_pose(self._face.controls, pose).values
        self._changed = self._changed or values != self._values
        self._values = values

    def step(self, slot: float = 0.02, *, steps: int | None = None) -> FloatArray:
        """Return the positions (n, 3) of every input vertex after one frame [mm].

        Parameters
        ----------
        slot : float
            Time that the springs may take [s].
        steps : int, optional
            Exactly so many steps instead: the same calls then give the same bytes.

        Raises
        ------
        ParameterError
            If `slot` is negative or `steps` below 1.
        """
        as_number("slot", slot, low=0.0)
        if steps is not None and steps < 1:
            raise ParameterError(f"steps: {steps} must be 1 or more")
        face = self._face
        if self._changed:
            self._follow()
        count = steps_that_fit(slot, self._seconds) if steps is None else steps
        began = time.perf_counter()
        self.steps = self._run.advance(count)
        if self.steps:
            took = (time.perf_counter() - began) / self.steps
            self._seconds += (_FRESH if self._seconds else 1.0) * (took - self._seconds)
        skin = face.driver.uncarried(self._positions(), self._values)
        displaced = skin - face.springs.skin.positions
        displaced[face.springs.network.fixed] = 0.0
        return face.head.positions + face.spread(displaced, self._values)

    @property
    def residual(self) -> float:
        """Largest force over mass that was left [mm, where masses are sums of stiffness]."""
        return self._run.residual

    def _follow(self) -> None:
        """Take the muscles to the new pose, and the skin along as far as can be guessed."""
        face = self._face
        self._drive = face.driver.drive(self._values)
        guess = start_of(face.springs, self._drive, passes=face.parameters.relaxation)
        self._run.ask(self._drive.control)
        self._run.shift(guess - self._guess)
        self._guess, self._changed = guess, False

    def _positions(self) -> FloatArray:
        """Return the skin (n, 3), exactly at rest once nothing pulls and nothing moves [mm]."""
        face = self._face
        resting = self.residual <= face.parameters.motion.tolerance
        if face.parameters.carried and resting and not face.driver.active(self._values).any():
            return self._drive.reference
        return self._run.positions
