from __future__ import annotations

import tracemalloc
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from risorius.controls.fap import fap_name, faps
from risorius.errors import FormatError, RisoriusWarning
from risorius.io.motion import read_stream
from risorius.io.motion.fap import read_fap, write_fap
from tests.io.motion.streams import stream_of

MASK = ["0"] * 68


def _mask(*numbers: int, size: int = 68) -> str:
    return " ".join("1" if n in numbers else "0" for n in range(1, size + 1))


def _write(folder: Path, *lines: str, end: str = "\n") -> Path:
    path = folder / "x.fap"
    path.write_bytes(end.join((*lines, "")).encode())
    return path


def _values(path: Path) -> list[dict[str, float]]:
    return [dict(frame.values) for frame in read_fap(path)]


def test_a_frame_gives_the_values_that_its_mask_names(tmp_path: Path) -> None:
    path = _write(tmp_path, "2.1 take 25 2", _mask(3, 12), "0 100 -7", _mask(3), "1 50")
    stream = read_fap(path)
    assert stream.rate == 25.0
    assert [frame.time for frame in stream] == [0.0, 0.04]
    # A parameter that the mask leaves out keeps its value.
    assert _values(path) == [{"fap_3": 100.0, "fap_12": -7.0}, {"fap_3": 50.0, "fap_12": -7.0}]


@pytest.mark.parametrize(
    "header",
    [
        r"2.1 C:\Users\somebody\exml2fap\files\TempFile 25 1",
        "2.1 AU Interpolation 12 of 5.fap 25 1",
        "2.1   name   25   1   ",
        "2.1 25 1",
    ],
)
def test_names_may_hold_blanks_and_backslashes_or_be_absent(tmp_path: Path, header: str) -> None:
    path = _write(tmp_path, header, _mask(5) + " ", "0 -3 ", end="\r\n")
    assert read_fap(path).rate == 25.0
    assert _values(path) == [{"fap_5": -3.0}]


def test_masks_of_69_entries_have_a_spare_one_at_the_end(tmp_path: Path) -> None:
    path = _write(tmp_path, "2.1 x 25 1", _mask(68, 69, size=69), "0 8 99")
    assert _values(path) == [{"fap_68": 8.0}]


def test_groups_become_weights_of_visemes_and_expressions(tmp_path: Path) -> None:
    path = _write(tmp_path, "2.1 x 25 1", _mask(1, 2, 3), "0 1 10 21 0 1 63 6 21 0 0 5")
    (values,) = _values(path)
    assert values == {
        "viseme_mpeg4_PP": pytest.approx(1 / 3),
        "viseme_mpeg4_aa": pytest.approx(2 / 3),
        "joy": 1.0,
        "surprise": pytest.approx(1 / 3),
        "fap_3": 5.0,
    }


def test_groups_written_as_single_integers_are_left_out_with_a_warning(tmp_path: Path) -> None:
    path = _write(tmp_path, "2.1 x 25 1", _mask(1, 2, 3), "0 9 9 5")
    with pytest.warns(RisoriusWarning, match="single integers, not groups"):
        assert _values(path) == [{"fap_3": 5.0}]


def test_a_wrong_number_of_frames_is_said_and_all_are_taken(tmp_path: Path) -> None:
    path = _write(tmp_path, "2.1 x 25 7", _mask(3), "0 1")
    with pytest.warns(RisoriusWarning, match="counts 7 frames, there are 1"):
        assert len(_values(path)) == 1


def test_a_mask_without_values_at_the_end_is_said(tmp_path: Path) -> None:
    path = _write(tmp_path, "2.1 x 25 1", _mask(3), "0 1", _mask(3))
    with pytest.warns(RisoriusWarning, match="no values"):
        assert len(_values(path)) == 1


@pytest.mark.parametrize(
    ("lines", "message"),
    [
        (("3.0 x 25 1",), r"line 1: expected '2.1 NAME FPS FRAMES'"),
        (("2.1 25",), r"line 1: expected '2.1 NAME FPS FRAMES'"),
        (("2.1 x 0 1",), "line 1: 0 frames per second"),
        (("2.1 x nan 1",), "'nan' is no number"),
        ((), "is empty"),
        (("2.1 x 25 1", "0 1 0"), "line 2: expected a mask of 68 zeros and ones, found 3"),
        (("2.1 x 25 1", _mask(3, 4), "0 1"), r"line 3: the mask asks for 2 values .* found 1"),
        (("2.1 x 25 1", _mask(3), "0 1e11"), "beyond any parameter"),
        (("2.1 x 25 1", _mask(3), "0 ?"), "line 3: '\\?' is no number"),
        (("2.1 x 25 1", "0 " * 40000), "line 2 is longer than"),
    ],
)
def test_what_is_no_stream_is_refused_with_its_line(
    tmp_path: Path, lines: tuple[str, ...], message: str
) -> None:
    with pytest.raises(FormatError, match=message):
        _values(_write(tmp_path, *lines))


@pytest.mark.parametrize("name", ["x.fap", "x.fba", "stream"])
def test_a_binary_stream_is_recognised_and_refused_in_one_sentence(
    tmp_path: Path, name: str
) -> None:
    path = tmp_path / name
    path.write_bytes(b"\x00\x00\x01\xba" + bytes(range(256)))
    with pytest.raises(FormatError, match=r"binary stream \(MPEG-4 FBA\)"):
        read_stream(path)


def test_a_missing_file_and_an_unknown_ending_are_refused(tmp_path: Path) -> None:
    with pytest.raises(FormatError, match="no such file"):
        read_stream(tmp_path / "none.fap")
    with pytest.raises(FormatError, match=r"no ending of a stream; known: \.fap \.csv"):
        read_stream(tmp_path / "x.bvh")
    (tmp_path / "x.fbx").write_bytes(b"Kaydara FBX Binary  \0\x1a\0")
    with pytest.raises(FormatError, match="no ending of a stream"):
        read_stream(tmp_path / "x.fbx")


@given(
    st.lists(
        st.dictionaries(st.sampled_from(sorted(faps())), st.integers(-5000, 5000), min_size=1),
        min_size=1,
        max_size=5,
    )
)
def test_what_is_written_is_read_again(tmp_path_factory, frames) -> None:
    path = tmp_path_factory.mktemp("fap") / "x.fap"
    named = [{fap_name(n): float(v) for n, v in frame.items()} for frame in frames]
    assert write_fap(stream_of(named), path) == len(frames)
    held: dict[str, float] = {}
    for read, wanted in zip(read_fap(path), named, strict=True):
        held |= wanted
        assert dict(read.values) == held


def test_groups_are_written_and_read_again(tmp_path: Path) -> None:
    values = {"viseme_mpeg4_O": 1.0, "fear": 0.5, "joy": 20 / 63, "fap_20": 3.0}
    write_fap(stream_of([values]), tmp_path / "x.fap")
    (read,) = _values(tmp_path / "x.fap")
    assert read == {**values, "fear": pytest.approx(0.5, abs=1 / 63), "joy": pytest.approx(20 / 63)}


def test_a_long_stream_is_not_held_in_memory(tmp_path: Path) -> None:
    path = tmp_path / "x.fap"
    frames = [_mask(*range(3, 69)), " ".join(map(str, range(67)))] * 2000
    path.write_text("\n".join(["2.1 x 25 2000", *frames]))
    size = path.stat().st_size
    stream = read_fap(path)
    tracemalloc.start()
    assert sum(1 for _ in stream) == 2000
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 0.3 * size


@given(st.binary(max_size=400), st.integers(0, 2000))
@pytest.mark.filterwarnings("ignore::risorius.errors.RisoriusWarning")
def test_broken_files_are_read_or_refused(tmp_path_factory, junk: bytes, place: int) -> None:
    path = tmp_path_factory.mktemp("fap") / "x.fap"
    good = ("2.1 x 25 2\n" + f"{_mask(1, 2, 3)}\n0 1 2 3 0 1 2 3 4 0 0 5\n" * 4).encode()
    path.write_bytes(good[: place % len(good)] + junk + good[place % len(good) :])
    try:
        assert all(frame.values is not None for frame in read_fap(path))
    except FormatError as error:
        assert str(path) in str(error)


@pytest.mark.real
@pytest.mark.parametrize(
    ("name", "count", "fewest"),
    [("joy", 108, 42), ("anger", 108, 48), ("fear", 107, 50), ("pride", 107, 36)],
)
def test_real_streams_are_read_whole(real_data: Path, name: str, count: int, fewest: int) -> None:
    stream = read_fap(real_data / "xface_fap" / f"{name}.fap")
    frames = list(stream)
    assert len(frames) == count
    assert stream.rate == 25.0
    assert all(len(frame.values) >= fewest for frame in frames)
