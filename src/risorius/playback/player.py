"""Play a stream on a rig: weights frame by frame, and everything that can be made of them."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator, Mapping
from functools import cached_property

import numpy as np
import numpy.typing as npt

from risorius._check import FloatArray
from risorius.controls.head_turn import HEAD_TURN_FAPS, head_turn_of
from risorius.controls.presets import PresetBook
from risorius.controls.stream import Stream
from risorius.errors import FormatError, LandmarkError
from risorius.io.track import WeightTrack
from risorius.playback.clamping import clamped
from risorius.playback.head_turn import HeadJoint
from risorius.playback.poser import Poser
from risorius.playback.weights import RigWeights
from risorius.rig.rig import Rig

__all__ = ["Player"]

_MOST_NUMBERS = 1 << 27  # weights that a track may hold, 4 bytes each


class Player:
    """A stream bound to a rig; can be gone through again and again, one frame at a time.

    Parameters
    ----------
    rig : Rig
    stream : Stream
        Evenly sampled (`resampled`); insane parameters are clamped here.
    presets : PresetBook, optional
        Poses of shapes that the rig lacks.
    """

    def __init__(self, rig: Rig, stream: Stream, *, presets: PresetBook | None = None) -> None:
        self.rig = rig
        self.stream = clamped(stream)
        self.weights = RigWeights(rig, presets=presets)

    def __iter__(self) -> Iterator[FloatArray]:
        """Go through the weights (t,) of all targets, frame by frame."""
        for frame in self.stream:
            yield self.weights.of(frame.values)

    @property
    def unmatched(self) -> Mapping[str, str]:
        """What moved nothing so far, with the reason."""
        return self.weights.unmatched

    @cached_property
    def joint(self) -> HeadJoint | None:
        """Where the head turns; None if the rig's landmarks do not say it."""
        try:
            return HeadJoint.of_rig(self.rig)
        except LandmarkError:
            return None

    def positions(self) -> Iterator[npt.NDArray[np.floating]]:
        """Go through the positions (n, 3) of all vertices, frame by frame [file frame].

        Holds one block of frames at a time.
        """
        turns: deque[Mapping[str, float]] = deque()

        def rows() -> Iterator[FloatArray]:
            for frame in self.stream:
                turns.append(self.turn_of(frame.values))
                yield self.weights.of(frame.values)

        for posed in Poser(self.rig).frames(rows()):
            turn = turns.popleft()
            yield posed if self.joint is None or not turn else self.joint.turned(posed, turn)

    def track(self, *, name: str = "stream") -> WeightTrack:
        """Return all frames as the animation of a file.

        Raises
        ------
        FormatError
            If the stream has no frames, or too many for one file.
        """
        rows: list[np.ndarray] = []
        times: list[float] = []
        turns: list[Mapping[str, float]] = []
        for frame in self.stream:
            rows.append(self.weights.of(frame.values).astype(np.float32))
            times.append(frame.time)
            turns.append(self.turn_of(frame.values))
            if len(rows) * max(len(self.rig.targets), 1) > _MOST_NUMBERS:
                raise FormatError(
                    f"{self.stream.source}: more than {len(rows) - 1} frames do not fit into one "
                    "animation; play a part of it, or at a lower rate"
                )
        if not rows:
            raise FormatError(f"{self.stream.source}: holds no frames")
        track = self.joint.track(turns) if self.joint and any(turns) else None
        return WeightTrack(np.array(times), np.stack(rows), name, track)

    def animated(self, *, name: str = "stream") -> tuple[Rig, WeightTrack]:
        """Return the rig and its animation, as files hold them; see `track`."""
        return self.rig, self.track(name=name)

    def turn_of(self, values: Mapping[str, float]) -> Mapping[str, float]:
        """Return pitch, yaw and roll of a frame [deg]; empty where the head does not turn."""
        turn = head_turn_of(values)
        if not any(turn):
            return {}
        if self.joint is None:
            reason = "the rig's landmarks do not say where the head turns"
            for name, (parameter, _) in HEAD_TURN_FAPS.items():
                if values.get(name) or values.get(parameter):
                    asked = name if values.get(name) else parameter
                    self.weights.unmatched.setdefault(asked, reason)
            return {}
        return dict(zip(HEAD_TURN_FAPS, turn, strict=True))
