from __future__ import annotations

import json
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from risorius.controls import arkit_shapes
from risorius.errors import FormatError
from risorius.io.motion import read_stream, write_stream
from tests.io.motion.streams import stream_of

LIVE_LINK = ["Timecode", "BlendShapeCount"]
NAMES = [shape.name for shape in arkit_shapes()]


def _csv(folder: Path, *rows: str) -> Path:
    path = folder / "x.csv"
    path.write_text("\n".join(rows), "utf-8")
    return path


def _live_link(folder: Path, times: list[str]) -> Path:
    header = [*LIVE_LINK, *(name[0].upper() + name[1:] for name in NAMES), "HeadYaw"]
    rows = [[time, "53", *("0.25" for _ in NAMES), "0.1"] for time in times]
    return _csv(folder, *(",".join(row) for row in [header, *rows]))


def test_live_link_names_become_those_of_arkit(tmp_path: Path) -> None:
    path = _live_link(tmp_path, ["10:59:59:59.5", "11:00:00:00.5", "11:00:00:30.5"])
    stream = read_stream(path)
    assert stream.names == (*NAMES, "HeadYaw")
    frames = list(stream)
    assert [frame.time for frame in frames] == pytest.approx([0.0, 1 / 60, 31 / 60])
    assert frames[0].values["jawOpen"] == 0.25
    assert stream.rate == 60.0


def test_live_link_times_rise_over_midnight(tmp_path: Path) -> None:
    path = _live_link(tmp_path, ["23:59:59:59.000", "00:00:00:00.000"])
    times = [frame.time for frame in read_stream(path)]
    assert times == pytest.approx([0.0, 1 / 60])


@pytest.mark.parametrize(
    ("header", "rows", "times"),
    [
        ("time,a,b", ("0.5,1,0", "1.0,0,1"), [0.0, 0.5]),
        ("Frame,a,b", ("6,1,0", "12,0,1"), [0.0, 0.1]),
        ("a,b", ("1,0", "0,1"), [0.0, 1 / 60]),
    ],
)
def test_tables_are_timed_by_their_column_or_evenly(tmp_path, header, rows, times) -> None:
    stream = read_stream(_csv(tmp_path, header, *rows))
    frames = list(stream)
    assert [frame.time for frame in frames] == pytest.approx(times)
    assert [frame.values for frame in frames] == [{"a": 1.0, "b": 0.0}, {"a": 0.0, "b": 1.0}]
    assert stream.rate == pytest.approx(1 / times[1])


def test_an_empty_cell_leaves_its_shape_at_rest(tmp_path: Path) -> None:
    (frame,) = read_stream(_csv(tmp_path, "time,a,b", "0,,2"))
    assert frame.values == {"b": 2.0}


@pytest.mark.parametrize(
    ("rows", "message"),
    [
        ((), "is empty"),
        (("time",), "line 1: every column needs a name of its own"),
        (("time,a,a", "0,1,1"), "line 1: every column needs a name of its own"),
        (("time,a", "0,1,2"), "line 2: 3 cells, the header has 2"),
        (("time,a", "0,x"), "line 2: a: 'x' is no number"),
        (("time,a", "0,nan"), "line 2: a: 'nan' is no number"),
        (("time,a", "1,0", "1,0"), "line 3: time 1 does not rise after 1"),
        (("Timecode,BlendShapeCount,A", "1:2,1,0"), "line 2: '1:2' is no time code"),
        (('time,"a',), "x.csv: line 1"),
    ],
)
def test_bad_tables_are_refused_with_their_line(tmp_path, rows, message: str) -> None:
    with pytest.raises(FormatError, match=message):
        list(read_stream(_csv(tmp_path, *rows)))


@pytest.mark.parametrize("ending", [".csv", ".json"])
def test_what_is_written_is_read_again(tmp_path: Path, ending: str) -> None:
    frames = [{"jawOpen": 0.1 * n, "fap_3": -250.0, 'ünsal, "b"': n} for n in range(5)]
    path = tmp_path / f"x{ending}"
    assert write_stream(stream_of(frames), path) == 5
    stream = read_stream(path)
    assert stream.rate == pytest.approx(25.0)
    for read, wanted in zip(stream, frames, strict=True):
        assert dict(read.values) == pytest.approx(wanted)


def test_writing_twice_gives_the_same_bytes(tmp_path: Path) -> None:
    for name in ("a", "b"):
        for ending in (".fap", ".csv", ".json"):
            write_stream(stream_of([{"fap_3": 0.1}, {"fap_3": 2.0}]), tmp_path / (name + ending))
    for ending in (".fap", ".csv", ".json"):
        assert (tmp_path / f"a{ending}").read_bytes() == (tmp_path / f"b{ending}").read_bytes()


@pytest.mark.parametrize(
    ("document", "message"),
    [
        ({"frames": []}, "holds no frames"),
        ({"schema": "risorius/rig", "version": 1}, 'expected "schema": "risorius/stream"'),
        ({"rate": -1, "frames": [{}]}, "rate: -1 must lie in 0..1000"),
        ({"frames": [{"values": {"a": "1"}}]}, r"frames\[0\].values.a: expected a number"),
        ({"frames": [{"time": 1}, {"time": 0}]}, r"frames\[1\]: time 0 does not rise after 1"),
        ({"frames": [3]}, r"frames\[0\]: expected a JSON object"),
    ],
)
def test_bad_json_is_refused_with_its_place(tmp_path: Path, document, message: str) -> None:
    path = tmp_path / "x.json"
    path.write_text(json.dumps(document))
    with pytest.raises(FormatError, match=message):
        read_stream(path)


@given(st.binary(max_size=200), st.integers(0, 500), st.sampled_from([".csv", ".json"]))
def test_broken_files_are_read_or_refused(tmp_path_factory, junk, place, ending) -> None:
    path = tmp_path_factory.mktemp("stream") / f"x{ending}"
    write_stream(stream_of([{"a": 1.0, "b": 2.5}] * 4), path)
    good = path.read_bytes()
    path.write_bytes(good[: place % len(good)] + junk + good[place % len(good) :])
    try:
        list(read_stream(path))
    except FormatError as error:
        assert str(path) in str(error)
