"""Streams that tests of motion are made of."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from risorius.controls.stream import Stream, StreamFrame


def stream_of(frames: Sequence[Mapping[str, float]], *, rate: float = 25.0) -> Stream:
    """Return an evenly sampled stream of `frames`."""
    names = tuple(dict.fromkeys(name for frame in frames for name in frame))
    held = [StreamFrame(number / rate, values) for number, values in enumerate(frames)]
    return Stream("made up", rate, names, lambda: iter(held))
