"""Streams at another rate or speed, eased between their frames, and looped."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import Literal

from risorius._check import as_number, one_of
from risorius.controls.stream import Stream, StreamFrame

__all__ = ["Easing", "resampled"]

Easing = Literal["linear", "smooth", "hold"]
_EASINGS = ("linear", "smooth", "hold")
_SLACK = 1e-9  # share of a step by which times may miss one another


def resampled(
    stream: Stream,
    *,
    rate: float | None = None,
    speed: float = 1.0,
    loops: int = 1,
    easing: Easing = "linear",
) -> Stream:
    """Return the stream evenly sampled.

    Parameters
    ----------
    stream : Stream
    rate : float, optional
        Frames per second, 0..1000; the stream's own if left out.
    speed : float
        How many times faster it plays, 0.001..1000.
    loops : int
        How often it is played, one after the other, 1..1000000.
    easing : {"linear", "smooth", "hold"}
        Between two frames: straight, slow at both, or the earlier one until the later.

    Raises
    ------
    ParameterError
        If a value is out of range.
    """
    rate = stream.rate if rate is None else rate
    as_number("rate", rate, low=1e-3, high=1000.0)
    as_number("speed", speed, low=1e-3, high=1000.0)
    as_number("loops", loops, low=1, high=1_000_000)
    one_of("easing", easing, _EASINGS)

    def frames() -> Iterator[StreamFrame]:
        start = 0
        for _ in range(loops):
            count = 0
            for count, values in enumerate(_once(stream, speed / rate, easing), start=1):
                yield StreamFrame((start + count - 1) / rate, values)
            start += count

    return replace(stream, rate=rate, open=frames)


def _once(stream: Stream, step: float, easing: Easing) -> Iterator[Mapping[str, float]]:
    """Return the values at 0, step, 2 step ... of the stream's own time."""
    count = 0
    before: StreamFrame | None = None
    begin = 0.0
    for frame in stream:
        if before is None:
            begin = frame.time
            before = frame
        while begin + count * step <= frame.time + _SLACK * step:
            yield _between(before, frame, begin + count * step, easing)
            count += 1
        before = frame


def _between(
    before: StreamFrame, after: StreamFrame, time: float, easing: Easing
) -> Mapping[str, float]:
    span = after.time - before.time
    share = min(max((time - before.time) / span, 0.0), 1.0) if span > 0.0 else 1.0
    if share >= 1.0 - _SLACK:
        return after.values
    if easing == "hold" or share <= _SLACK:
        return before.values
    if easing == "smooth":
        share = share * share * (3.0 - 2.0 * share)
    names = dict.fromkeys((*before.values, *after.values))
    old, new = before.values, after.values
    return {name: (1 - share) * old.get(name, 0.0) + share * new.get(name, 0.0) for name in names}
