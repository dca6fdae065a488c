"""Play a stream on the face itself: live physics where the method has any, poses otherwise."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from inspect import signature
from typing import Protocol, cast, runtime_checkable

import numpy as np
import numpy.typing as npt

from risorius._check import FloatArray
from risorius.controls.control import Pose
from risorius.controls.presets import PresetBook
from risorius.controls.shape_sets import list_shapes
from risorius.controls.stream import Stream
from risorius.io.track import WeightTrack
from risorius.playback.motion_basis import motion_basis
from risorius.playback.player import Player
from risorius.rig.bake import Progress, bake
from risorius.rig.face import Face
from risorius.rig.rig import Rig

__all__ = ["LivePlayer", "rig_of_singles"]

_SETTLING = 0.5  # time that a face in motion gets to reach the first frame [s]
_STEPS_PER_SECOND = 1000.0  # of springs, whose steps have no duration of their own


@runtime_checkable
class _Lively(Protocol):
    """A face that can be moved while it is looked at."""

    def live(self) -> _Session: ...


class _Session(Protocol):
    """A face in motion: a pose is asked for, and time passes."""

    def set(self, pose: Pose) -> None: ...

    def step(self, dt: float, /) -> FloatArray: ...


def rig_of_singles(face: Face, presets: PresetBook, *, progress: Progress | None = None) -> Rig:
    """Return the rig of a face's single controls, which tells a stream apart into them."""
    shapes = list_shapes(face.controls, presets, sets=("singles",))
    return bake(face, shapes.poses, upon=shapes.upon, progress=progress)


class LivePlayer(Player):
    """A stream bound to a face; every frame is simulated, no sum of targets.

    Parameters
    ----------
    face : Face
    rig : Rig
        Of its singles (`rig_of_singles`).
    stream : Stream
        Evenly sampled.
    presets : PresetBook, optional

    Notes
    -----
    Weights of the stream's shapes become values of controls, within their ranges. A face that has
    a live session starts at rest, has half a second to reach the first frame, and then moves on by
    the time between frames; another face takes every frame's pose.
    """

    def __init__(
        self, face: Face, rig: Rig, stream: Stream, *, presets: PresetBook | None = None
    ) -> None:
        super().__init__(rig, stream, presets=presets)
        self.face = face

    @property
    def has_physics(self) -> bool:
        """Whether the face has a life of its own between poses."""
        return isinstance(self.face, _Lively)

    def pose_of(self, values: Mapping[str, float]) -> dict[str, float]:
        """Return the controls that a frame's values ask for."""
        ranges = {control.name: control for control in self.face.controls}
        pose: dict[str, float] = {}
        for weight, target in zip(self.weights.of(values).tolist(), self.rig.targets):
            if weight:
                for name, value in target.pose.items():
                    pose[name] = pose.get(name, 0.0) + weight * value
        return {
            name: min(max(value, ranges[name].low), ranges[name].high)
            for name, value in pose.items()
        }

    def positions(self) -> Iterator[npt.NDArray[np.floating]]:
        """Go through the simulated positions (n, 3) of all vertices [file frame]."""
        for posed, turn in self._simulated():
            yield posed if self.joint is None or not turn else self.joint.turned(posed, turn)

    def animated(self, *, name: str = "stream") -> tuple[Rig, WeightTrack]:
        """Return the principal components of the simulated motion as a rig, and its track.

        Raises
        ------
        FormatError
            If the stream has no frames, or too many to be held at once.
        """
        turns: list[Mapping[str, float]] = []

        def still() -> Iterator[npt.NDArray[np.floating]]:
            for posed, turn in self._simulated():
                turns.append(turn)
                yield posed

        found = motion_basis(self.rig, still(), source=self.stream.source)
        times = np.arange(len(found.weights)) / self.stream.rate
        track = self.joint.track(turns) if self.joint and any(turns) else None
        return found.rig, WeightTrack(times, found.weights, name, track)

    def _simulated(self) -> Iterator[tuple[FloatArray, Mapping[str, float]]]:
        frame_of = self.rig.frame
        step = self._stepper()
        for frame in self.stream:
            posed = step(self.pose_of(frame.values))
            yield frame_of.to_input(posed), self.turn_of(frame.values)

    def _stepper(self) -> Callable[[Pose], FloatArray]:
        """Return what takes a frame's pose and gives its positions [canonical frame]."""
        if not isinstance(self.face, _Lively):
            return self.face.pose
        session = self.face.live()
        advance = _advancing(session)
        interval = 1.0 / self.stream.rate
        started = False

        def step(pose: Pose) -> FloatArray:
            nonlocal started
            session.set(pose)
            if not started:
                started = True
                for _ in range(int(np.ceil(_SETTLING / interval)) - 1):
                    advance(interval)
            return advance(interval)

        return step


def _advancing(session: _Session) -> Callable[[float], FloatArray]:
    """Return what moves a session on by a duration [s], always in the same number of steps."""
    if "steps" not in signature(session.step).parameters:
        return session.step
    stepping = cast(Callable[..., FloatArray], session.step)
    return lambda dt: stepping(dt, steps=max(1, round(dt * _STEPS_PER_SECOND)))
