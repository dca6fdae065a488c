"""Play a stream on a rig: weights frame by frame, and everything that can be made of them."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from risorius._check import FloatArray
from risorius.controls.presets import PresetBook
from risorius.controls.stream import Stream
from risorius.errors import FormatError
from risorius.io.gltf.track import WeightTrack
from risorius.playback.clamping import clamped
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

    def track(self, *, name: str = "stream") -> WeightTrack:
        """Return all frames as the animation of a GLB.

        Raises
        ------
        FormatError
            If the stream has no frames, or too many for one file.
        """
        rows: list[np.ndarray] = []
        times: list[float] = []
        for frame in self.stream:
            rows.append(self.weights.of(frame.values).astype(np.float32))
            times.append(frame.time)
            if len(rows) * max(len(self.rig.targets), 1) > _MOST_NUMBERS:
                raise FormatError(
                    f"{self.stream.source}: more than {len(rows) - 1} frames do not fit into one "
                    "animation; play a part of it, or at a lower rate"
                )
        if not rows:
            raise FormatError(f"{self.stream.source}: holds no frames")
        return WeightTrack(np.array(times), np.stack(rows), name)
