"""Keep parameters of a stream within what a face can do."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from dataclasses import replace

from risorius.controls.fap import fap_number, faps
from risorius.controls.stream import Stream, StreamFrame
from risorius.errors import RisoriusWarning

__all__ = ["clamped"]


def clamped(stream: Stream) -> Stream:
    """Return the stream with every ``fap_*`` held within its sane bounds.

    Parameters of one direction are held at 0 where they point backwards.

    Warns
    -----
    RisoriusWarning
        Once for each parameter and passage, at the first frame that goes beyond.
    """

    def frames() -> Iterator[StreamFrame]:
        said: set[int] = set()
        for count, frame in enumerate(stream):
            values = dict(frame.values)
            for name, value in frame.values.items():
                number = fap_number(name)
                if number is None:
                    continue
                fap = faps()[number]
                values[name] = min(max(value, fap.low), fap.high)
                if values[name] != value and number not in said:
                    said.add(number)
                    warnings.warn(
                        f"{stream.source}: {name} ({fap.name}) is {value:g} in frame {count}, held "
                        f"within {fap.low:g}..{fap.high:g} from there on",
                        RisoriusWarning,
                        stacklevel=2,
                    )
            yield StreamFrame(frame.time, values)

    return replace(stream, open=frames)
