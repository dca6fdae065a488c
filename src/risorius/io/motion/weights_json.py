"""Streams of weights as JSON, our own schema.

``{"schema": "risorius/stream", "version": 1, "rate": 60, "names": [...], "frames": [{"time": 0,
"values": {name: weight}}]}``. A file is read as a whole, at most 64 MB; long takes are better kept
as CSV.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path

from risorius.controls.stream import Stream, StreamFrame
from risorius.errors import FormatError
from risorius.io.atomic import atomic_write
from risorius.io.bounded import check_schema, read_json
from risorius.io.json_fields import Fields

__all__ = ["read_weights_json", "write_weights_json"]

SCHEMA = "risorius/stream"
VERSION = 1
_RATE = 60.0


def read_weights_json(path: str | Path) -> Stream:
    """Read a stream; also one without schema whose frames hold ``"weights"``.

    Raises
    ------
    FormatError
        If the file is malformed, a value is no number, or times do not rise.
    """
    where = str(path)
    document = read_json(path)
    if "schema" in document:
        check_schema(document, where, schema=SCHEMA, version=VERSION)
    fields = Fields(document, where)
    rate = fields.number("rate", default=_RATE)
    if not 0.0 < rate <= 1000.0:
        raise FormatError(f"{where}: rate: {rate:g} must lie in 0..1000")
    frames: list[StreamFrame] = []
    names = dict.fromkeys(fields.texts("names"))
    before = -float("inf")
    for count, item in enumerate(fields.items("frames")):
        entry = Fields(item, f"{where}: frames[{count}]")
        time = entry.number("time", default=count / rate)
        if time <= before:
            raise FormatError(f"{entry.where}: time {time:g} does not rise after {before:g}")
        before = time
        held = entry.fields("weights" if "weights" in entry else "values")
        values = {name: held.number(name) for name in held}
        names |= dict.fromkeys(values)
        frames.append(StreamFrame(time, values))
    if not frames:
        raise FormatError(f"{where}: holds no frames")

    def again() -> Iterator[StreamFrame]:
        return iter(frames)

    return Stream(where, rate, tuple(names), again)


def write_weights_json(stream: Stream, path: str | Path) -> int:
    """Write a stream, one frame per line; return the number of frames.

    Raises
    ------
    FormatError
        If the file cannot be written.
    """
    head = {"schema": SCHEMA, "version": VERSION, "rate": stream.rate, "names": stream.names}
    count = 0
    with atomic_write(path) as temporary, temporary.open("w", encoding="utf-8") as file:
        file.write(json.dumps(head, ensure_ascii=False)[:-1] + ', "frames": [')
        for count, frame in enumerate(stream, start=1):
            values = {name: round(value, 6) for name, value in frame.values.items()}
            row = json.dumps({"time": round(frame.time, 6), "values": values}, ensure_ascii=False)
            file.write(("\n" if count == 1 else ",\n") + row)
        file.write("\n]}\n")
    return count
