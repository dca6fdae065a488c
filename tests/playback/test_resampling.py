from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from risorius.errors import ParameterError
from risorius.playback.resampling import resampled
from tests.io.motion.streams import stream_of

RAMP = stream_of([{"a": float(n)} for n in range(5)], rate=10.0)


def _values(stream, name: str = "a") -> list[float]:
    return [frame.values.get(name, 0.0) for frame in stream]


def test_the_own_rate_gives_the_own_frames() -> None:
    assert _values(resampled(RAMP)) == [0.0, 1.0, 2.0, 3.0, 4.0]


def test_twice_the_rate_has_the_frames_between() -> None:
    stream = resampled(RAMP, rate=20.0)
    assert _values(stream) == pytest.approx([0.5 * n for n in range(9)])
    assert [frame.time for frame in stream] == pytest.approx([0.05 * n for n in range(9)])


def test_twice_the_speed_takes_half_the_time() -> None:
    assert _values(resampled(RAMP, speed=2.0)) == pytest.approx([0.0, 2.0, 4.0])


def test_loops_follow_one_another_without_a_pause() -> None:
    stream = resampled(RAMP, loops=2)
    assert _values(stream) == [0.0, 1.0, 2.0, 3.0, 4.0] * 2
    assert [frame.time for frame in stream] == pytest.approx([0.1 * n for n in range(10)])


@pytest.mark.parametrize(
    ("easing", "quarter"), [("linear", 0.25), ("smooth", 0.15625), ("hold", 0.0)]
)
def test_easing_shapes_the_way_between_frames(easing, quarter: float) -> None:
    stream = resampled(stream_of([{"a": 0.0}, {"a": 1.0}], rate=1.0), rate=4.0, easing=easing)
    values = _values(stream)
    assert values[1] == pytest.approx(quarter)
    assert (values[0], values[4]) == (0.0, 1.0)


def test_absent_names_rest() -> None:
    stream = resampled(stream_of([{"a": 1.0}, {"b": 1.0}], rate=1.0), rate=2.0)
    assert _values(stream) == pytest.approx([1.0, 0.5, 0.0])
    assert _values(stream, "b") == pytest.approx([0.0, 0.5, 1.0])


def test_a_single_frame_and_no_frame_stay_as_they_are() -> None:
    assert _values(resampled(stream_of([{"a": 3.0}]), rate=100.0)) == [3.0]
    assert _values(resampled(stream_of([]), rate=100.0)) == []


@given(st.integers(1, 30), st.floats(1.0, 240.0), st.floats(1.0, 240.0))
def test_sampling_covers_the_stream_and_no_more(count: int, rate: float, wanted: float) -> None:
    stream = stream_of([{"a": float(n)} for n in range(count)], rate=rate)
    values = _values(resampled(stream, rate=wanted))
    assert len(values) == int((count - 1) / rate * wanted + 1e-6) + 1
    assert values == pytest.approx([n * rate / wanted for n in range(len(values))], abs=1e-6)


@pytest.mark.parametrize(
    "options", [{"rate": 0.0}, {"speed": -1.0}, {"loops": 0}, {"easing": "bouncy"}]
)
def test_senseless_options_are_refused(options) -> None:
    with pytest.raises(ParameterError, match=next(iter(options))):
        resampled(RAMP, **options)
