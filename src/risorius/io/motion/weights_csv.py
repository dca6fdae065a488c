"""Tables of weights over time: Live Link Face takes, and any CSV with a header and a time."""

from __future__ import annotations

import csv
from collections.abc import Callable, Iterator
from pathlib import Path

from risorius.controls.arkit import arkit_shapes
from risorius.controls.stream import Stream, StreamFrame
from risorius.errors import FormatError
from risorius.io.atomic import atomic_write
from risorius.io.motion.text_lines import bounded_lines, parse_number

__all__ = ["read_weights_csv", "write_weights_csv"]

_TIMES = ("time", "t", "seconds", "timestamp")
_FRAMES = ("frame", "index")
_LIVE_LINK = ("Timecode", "BlendShapeCount")
_LIVE_LINK_RATE = 60.0
_RATE = 60.0
_MOST_COLUMNS = 4096

Clock = Callable[[str, str], float]


def read_weights_csv(path: str | Path) -> Stream:
    """Open a CSV of weights; rows are read while they are gone through.

    The first row names the columns. One of them is the time [s] (`time`), the number of the frame
    at 60 per second (`frame`), or a time code at 60 per second (Live Link Face, whose names become
    those of ARKit); without one, rows are 1/60 s apart. An empty cell leaves its shape at
    rest.

    Raises
    ------
    FormatError
        If the file or its header is malformed; rows are refused when they are reached, with their
        line. Times must rise.
    """
    path = Path(path)
    header, start = _header(path)
    live_link = all(name in header for name in _LIVE_LINK)
    clock_column, clock = _clock(header, live_link)
    columns = {
        place: _arkit_name(name) if live_link else name
        for place, name in enumerate(header)
        if place != clock_column and not (live_link and name in _LIVE_LINK)
    }
    names = tuple(columns.values())
    if not names or not all(names) or len(set(names)) < len(names):
        raise FormatError(f"{path}: line {start}: every column needs a name of its own")

    def frames() -> Iterator[StreamFrame]:
        return _frames(path, columns, clock_column, clock)

    rate = _LIVE_LINK_RATE if live_link else _measured_rate(frames())
    return Stream(str(path), rate, names, frames)


def _rows(path: Path) -> Iterator[tuple[int, list[str]]]:
    last = [0]

    def text() -> Iterator[str]:
        for number, line in bounded_lines(path):
            last[0] = number
            yield line + "\n"

    reader = csv.reader(text(), strict=True)
    while True:
        try:
            row = next(reader, None)
        except csv.Error as error:
            raise FormatError(f"{path}: line {last[0]}: {error}") from None
        if row is None:
            return
        if any(cell.strip() for cell in row):
            yield last[0], [cell.strip() for cell in row]


def _header(path: Path) -> tuple[list[str], int]:
    number, header = next(_rows(path), (0, []))
    if not header:
        raise FormatError(f"{path}: is empty; expected a header of column names")
    if len(header) > _MOST_COLUMNS:
        raise FormatError(f"{path}: line {number}: more than {_MOST_COLUMNS} columns")
    return header, number


def _arkit_name(name: str) -> str:
    by_lower = {shape.name.lower(): shape.name for shape in arkit_shapes()}
    return by_lower.get(name.lower(), name)


def _clock(header: list[str], live_link: bool) -> tuple[int, Clock | None]:
    """Return the column of the time (-1 without one) and how it is read."""
    lowered = [name.lower() for name in header]
    if live_link:
        return header.index(_LIVE_LINK[0]), _time_code
    for names, clock in ((_TIMES, parse_number), (_FRAMES, _frame_number)):
        for name in names:
            if name in lowered:
                return lowered.index(name), clock
    return -1, None


def _frame_number(text: str, where: str) -> float:
    return parse_number(text, where) / _RATE


def _time_code(text: str, where: str) -> float:
    pieces = text.split(":")
    if len(pieces) != 4:
        raise FormatError(f"{where}: {text[:40]!r} is no time code HH:MM:SS:FF")
    hours, minutes, seconds, frames = (parse_number(piece, where) for piece in pieces)
    return 3600.0 * hours + 60.0 * minutes + seconds + frames / _LIVE_LINK_RATE


def _frames(
    path: Path, columns: dict[int, str], clock_column: int, clock: Clock | None
) -> Iterator[StreamFrame]:
    rows = _rows(path)
    width = len(next(rows, (0, []))[1])
    first: float | None = None
    before = -float("inf")
    for count, (number, row) in enumerate(rows):
        where = f"{path}: line {number}"
        if len(row) != width:
            raise FormatError(f"{where}: {len(row)} cells, the header has {width}")
        time = count / _RATE if clock is None else clock(row[clock_column], where)
        first = time if first is None else first
        if clock is _time_code and time <= before:  # counts beyond 60 per second, or midnight
            time = before + 1.0 / _LIVE_LINK_RATE
        if time <= before:
            raise FormatError(f"{where}: time {time:g} does not rise after {before:g}")
        before = time
        values = {
            name: parse_number(row[place], f"{where}: {name[:40]}")
            for place, name in columns.items()
            if row[place]
        }
        yield StreamFrame(time - first, values)


def _measured_rate(frames: Iterator[StreamFrame]) -> float:
    """Return the rate by the first two frames."""
    times = [frame.time for frame, _ in zip(frames, range(2))]
    if len(times) < 2:
        return _RATE
    return min(max(1.0 / (times[1] - times[0]), 1e-3), 1e3)


def write_weights_csv(stream: Stream, path: str | Path) -> int:
    """Write a stream as CSV with a column ``time`` [s]; return the number of frames.

    Names without a value in a frame are 0.

    Raises
    ------
    FormatError
        If the file cannot be written.
    """
    count = 0
    with atomic_write(path) as temporary, temporary.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["time", *stream.names])
        for frame in stream:
            row = [_text(frame.values.get(name, 0.0)) for name in stream.names]
            writer.writerow([_text(frame.time), *row])
            count += 1
    return count


def _text(value: float) -> str:
    return f"{value:.6f}".rstrip("0").rstrip(".")
