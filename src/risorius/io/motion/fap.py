"""Text streams of MPEG-4 facial animation parameters: ``.fap``, version 2.1.

A header ``2.1 NAME FPS FRAMES``, then two lines per frame: a mask of 68 zeros and ones, and the
frame's number followed by one integer for each parameter that the mask holds. Parameter 1 is a
group of four integers, parameter 2 of six. Met in the wild and read: CRLF, trailing blanks, names
with spaces and backslashes, masks of 69 (the last entry is spare), groups written as one integer,
headers that count other frames than there are. A parameter that a mask leaves out keeps its value.
"""

from __future__ import annotations

import shutil
import tempfile
import warnings
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import IO

from risorius.controls.fap import FAP_COUNT, FIRST_LOW_LEVEL, fap_name, faps
from risorius.controls.stream import Stream, StreamFrame
from risorius.errors import FormatError, RisoriusWarning
from risorius.io.atomic import atomic_write
from risorius.io.motion.fap_groups import (
    EXPRESSION_FIELDS,
    GROUP_NAMES,
    VISEME_FIELDS,
    expression_fields,
    expression_weights,
    viseme_fields,
    viseme_weights,
)
from risorius.io.motion.text_lines import bounded_lines, parse_number, refuse_binary_stream

__all__ = ["read_fap", "write_fap"]

_VERSION = "2.1"
_MASKS = (FAP_COUNT, FAP_COUNT + 1)
_FASTEST = 1000.0
_LARGEST = 2**31


@dataclass(frozen=True)
class _Header:
    name: str
    rate: float
    count: int


@dataclass
class _State:
    """What stands in force, and what was complained of."""

    low: dict[int, float] = field(default_factory=dict[int, float])
    visemes: dict[str, float] = field(default_factory=dict[str, float])
    expressions: dict[str, float] = field(default_factory=dict[str, float])
    said: set[str] = field(default_factory=set[str])

    def say(self, text: str) -> None:
        if text not in self.said:
            self.said.add(text)
            warnings.warn(text, RisoriusWarning, stacklevel=3)


def read_fap(path: str | Path) -> Stream:
    """Open a ``.fap`` stream; frames are read while they are gone through.

    Raises
    ------
    FormatError
        If the file is missing, binary, or its header is malformed; frames are refused when they
        are reached, with their line.

    Warns
    -----
    RisoriusWarning
        Where the file leaves its format and can be read all the same.
    """
    path = Path(path)
    refuse_binary_stream(path, text_expected=True)
    header = _header(path)
    names = (*(fap_name(number) for number in faps()), *GROUP_NAMES)
    return Stream(str(path), header.rate, names, lambda: _frames(path, header))


def _header(path: Path) -> _Header:
    for number, line in bounded_lines(path):
        if not line.strip():
            continue
        where = f"{path}: line {number}"
        version, _, rest = line.strip().partition(" ")
        pieces = rest.rsplit(None, 2)
        if version != _VERSION or len(pieces) < 2:
            raise FormatError(
                f"{where}: expected '{_VERSION} NAME FPS FRAMES', found {line[:60]!r}"
            )
        name = pieces[0].strip() if len(pieces) == 3 else ""
        rate = parse_number(pieces[-2], f"{where}: frames per second")
        if not 0.0 < rate <= _FASTEST:
            raise FormatError(f"{where}: {rate:g} frames per second, it must lie in 0..1000")
        count = parse_number(pieces[-1], f"{where}: number of frames")
        return _Header(name, rate, int(count))
    raise FormatError(f"{path}: is empty; expected '{_VERSION} NAME FPS FRAMES'")


def _frames(path: Path, header: _Header) -> Iterator[StreamFrame]:
    lines = ((number, line) for number, line in bounded_lines(path) if line.strip())
    next(lines, None)
    state = _State()
    count = 0
    for number, line in lines:
        mask = _mask(line, f"{path}: line {number}")
        following = next(lines, None)
        if following is None:
            state.say(f"{path}: the last frame has a mask and no values; left out")
            break
        number, line = following
        _take(mask, line, f"{path}: line {number}", state)
        values = {fap_name(key): value for key, value in state.low.items()}
        yield StreamFrame(count / header.rate, {**values, **state.visemes, **state.expressions})
        count += 1
    if count != header.count:
        state.say(f"{path}: the header counts {header.count} frames, there are {count}; all taken")


def _mask(line: str, where: str) -> list[bool]:
    pieces = line.split()
    if len(pieces) not in _MASKS or not set(pieces) <= {"0", "1"}:
        raise FormatError(
            f"{where}: expected a mask of {FAP_COUNT} zeros and ones, found {len(pieces)} entries "
            f"{line[:40]!r}"
        )
    return [piece == "1" for piece in pieces]


def _take(mask: Sequence[bool], line: str, where: str, state: _State) -> None:
    """Put the values of a frame into force."""
    values = _integers(line, where)[1:]
    low = [n for n in range(FIRST_LOW_LEVEL, FAP_COUNT + 1) if mask[n - 1]]
    spare = len(mask) > FAP_COUNT and mask[FAP_COUNT]
    extra = len(values) - len(low) - spare
    groups = VISEME_FIELDS * mask[0] + EXPRESSION_FIELDS * mask[1]
    if extra == groups:
        if mask[0]:
            state.visemes = viseme_weights(values[:VISEME_FIELDS])
        if mask[1]:
            start = VISEME_FIELDS * mask[0]
            state.expressions = expression_weights(values[start : start + EXPRESSION_FIELDS])
    elif extra == mask[0] + mask[1]:
        place = where.rpartition(": line")[0]
        state.say(f"{place}: parameters 1 and 2 are single integers, not groups; left out")
    else:
        raise FormatError(
            f"{where}: the mask asks for {groups + len(low) + spare} values after the frame's "
            f"number, found {len(values)}"
        )
    state.low.update(zip(low, map(float, values[extra : extra + len(low)])))


def _integers(line: str, where: str) -> list[int]:
    result: list[int] = []
    for piece in line.split():
        number = parse_number(piece, where)
        if not abs(number) < _LARGEST:
            raise FormatError(f"{where}: {piece[:40]!r} is beyond any parameter")
        result.append(round(number))
    return result


def write_fap(stream: Stream, path: str | Path, *, name: str = "risorius") -> int:
    """Write a stream as ``.fap`` 2.1; return the number of frames.

    Parameters
    ----------
    stream : Stream
        Evenly sampled at its rate. Of its names, ``fap_*``, ``viseme_mpeg4_*`` and the six
        expressions are written; of visemes and expressions the strongest two of a frame.
    path : path
    name : str
        For the header.

    Raises
    ------
    FormatError
        If the file cannot be written.
    """
    with atomic_write(path) as temporary, tempfile.TemporaryFile("w+", newline="") as body:
        count = 0
        for count, frame in enumerate(stream, start=1):
            _write_frame(frame, count - 1, body)
        body.seek(0)
        with temporary.open("w", newline="") as file:
            file.write(f"{_VERSION} {name} {stream.rate:g} {count}\n")
            shutil.copyfileobj(body, file)
    return count


def _write_frame(frame: StreamFrame, number: int, file: IO[str]) -> None:
    groups = (viseme_fields(frame.values), expression_fields(frame.values))
    mask = ["0" if group is None else "1" for group in groups]
    values = [number, *(entry for group in groups for entry in group or ())]
    for fap in faps().values():
        value = frame.values.get(fap.target)
        mask.append("0" if value is None else "1")
        if value is not None:
            values.append(round(value))
    file.write(" ".join(mask) + "\n" + " ".join(map(str, values)) + "\n")
