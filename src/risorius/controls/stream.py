"""Streams: values of named shapes over time, of any standard."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass

__all__ = ["Stream", "StreamFrame"]


@dataclass(frozen=True)
class StreamFrame:
    """Values in force at a moment [s]; names that are absent rest.

    Names are those of shapes; a value is a weight, of ``fap_*`` it counts units of the face.
    """

    time: float
    values: Mapping[str, float]


@dataclass(frozen=True, eq=False)
class Stream:
    """A stream that can be gone through again and again without being held in memory.

    Parameters
    ----------
    source : str
        Where it comes from, for messages.
    rate : float
        Frames per second that it claims.
    names : tuple of str
        All names that may occur.
    open : callable
        Starts over and returns the frames; times rise strictly.
    """

    source: str
    rate: float
    names: tuple[str, ...]
    open: Callable[[], Iterator[StreamFrame]]

    def __iter__(self) -> Iterator[StreamFrame]:
        """Go through the frames from the first one on."""
        return self.open()
