"""Emotions that come, stay and go: blends by intensity as a stream."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from risorius._check import as_number
from risorius.controls.control import Control, Pose
from risorius.controls.presets import EMOTIONS, PresetBook
from risorius.controls.stream import Stream, StreamFrame
from risorius.errors import ParameterError

__all__ = ["Timing", "blended_pose", "emotion_stream"]

_LONGEST = 3600.0


@dataclass(frozen=True)
class Timing:
    """How an emotion runs: `onset` until it is there, `apex` while it stays, `offset` to go [s]."""

    onset: float = 0.4
    apex: float = 1.0
    offset: float = 0.8

    def __post_init__(self) -> None:
        for name in ("onset", "apex", "offset"):
            as_number(name, getattr(self, name), low=0.0, high=_LONGEST)

    @property
    def duration(self) -> float:
        """All of it [s]."""
        return self.onset + self.apex + self.offset

    def level(self, time: float) -> float:
        """Return how much of the emotion is there at `time` [s]: 0..1, with a smooth way."""
        if time <= 0.0 or time >= self.duration:
            return 1.0 if time == 0.0 and self.onset == 0.0 and self.duration > 0.0 else 0.0
        if time < self.onset:
            return _smooth(time / self.onset)
        rest = self.duration - time
        return _smooth(rest / self.offset) if rest < self.offset else 1.0


def _smooth(share: float) -> float:
    return share * share * (3.0 - 2.0 * share)


def blended_pose(
    book: PresetBook, intensities: Mapping[str, float], controls: tuple[Control, ...]
) -> Pose:
    """Return the pose of several emotions at once, every muscle within its range.

    Contractions add up by intensity; a muscle that two emotions ask for stops at its limit.

    Parameters
    ----------
    book : PresetBook
    intensities : mapping of str to float
        Emotion -> 0..1.
    controls : tuple of Control
        Of the face that shall make it.

    Raises
    ------
    ParameterError
        If an emotion is unknown or an intensity lies outside 0..1.
    """
    ranges = {control.name: control for control in controls}
    pose: dict[str, float] = {}
    for name, share in _checked(intensities).items():
        for control, value in book.fit(book.emotions[name], controls).pose.items():
            pose[control] = pose.get(control, 0.0) + share * value
    return {
        name: min(max(value, ranges[name].low), ranges[name].high) for name, value in pose.items()
    }


def emotion_stream(
    intensities: Mapping[str, float], *, timing: Timing | None = None, rate: float = 25.0
) -> Stream:
    """Return the stream of emotions that come to their intensities, stay and go together.

    Parameters
    ----------
    intensities : mapping of str to float
        Emotion -> 0..1.
    timing : Timing, optional
    rate : float
        Frames per second, 0.001..1000.

    Raises
    ------
    ParameterError
        If an emotion is unknown, or a number is out of range.
    """
    held = _checked(intensities)
    curve = timing or Timing()
    as_number("rate", rate, low=1e-3, high=1000.0)
    count = math.floor(curve.duration * rate + 1e-9) + 1

    def frames() -> Iterator[StreamFrame]:
        for number in range(count):
            level = curve.level(number / rate)
            yield StreamFrame(number / rate, {name: level * share for name, share in held.items()})

    return Stream("+".join(held), rate, tuple(held), frames)


def _checked(intensities: Mapping[str, float]) -> dict[str, float]:
    if not intensities:
        raise ParameterError(f"emotions: name at least one of {', '.join(EMOTIONS)}")
    for name in intensities:
        if name not in EMOTIONS:
            raise ParameterError(f"emotions: {name!r} is not one of {', '.join(EMOTIONS)}")
    return {n: as_number(f"emotions: {n}", v, low=0.0, high=1.0) for n, v in intensities.items()}
