from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from risorius.controls import EMOTIONS, default_presets, resolve_pose
from risorius.errors import ParameterError
from risorius.io.motion import read_stream, write_stream
from risorius.playback.emotion_timing import Timing, blended_pose, emotion_stream
from tests.face_fixtures import builtin_face

BOOK = default_presets()


def test_an_emotion_comes_stays_and_goes() -> None:
    timing = Timing(onset=0.4, apex=1.0, offset=0.8)
    assert [timing.level(t) for t in (0.0, 0.2, 0.4, 1.0, 1.4, 1.8, 2.2, 9.0)] == pytest.approx(
        [0.0, 0.5, 1.0, 1.0, 1.0, 0.5, 0.0, 0.0]
    )


def test_an_emotion_may_be_there_at_once() -> None:
    assert Timing(onset=0.0).level(0.0) == 1.0
    assert Timing(0.0, 0.0, 0.0).level(0.0) == 0.0


def test_a_stream_starts_and_ends_at_rest_and_reaches_the_intensities() -> None:
    frames = list(emotion_stream({"joy": 0.6, "surprise": 0.3}, rate=50.0))
    assert frames[0].values == {"joy": 0.0, "surprise": 0.0}
    assert max(frame.values["joy"] for frame in frames) == 0.6
    assert frames[-1].time == pytest.approx(2.2)
    assert frames[-1].values["surprise"] == pytest.approx(0.0, abs=1e-9)


def test_a_timed_emotion_can_be_kept_in_a_file(tmp_path: Path) -> None:
    stream = emotion_stream({"fear": 1.0})
    write_stream(stream, tmp_path / "fear.json")
    for read, made in zip(read_stream(tmp_path / "fear.json"), stream, strict=True):
        assert dict(read.values) == pytest.approx(made.values, abs=1e-6)


@given(st.dictionaries(st.sampled_from(EMOTIONS), st.floats(0.0, 1.0), min_size=1))
def test_blends_keep_every_muscle_within_its_range(intensities: dict[str, float]) -> None:
    controls = builtin_face().controls
    assert resolve_pose(controls, blended_pose(BOOK, intensities, controls)).clamped == ()


def test_one_whole_emotion_is_its_preset() -> None:
    controls = builtin_face().controls
    fitted = BOOK.fit(BOOK.emotions["joy"], controls).pose
    assert blended_pose(BOOK, {"joy": 1.0}, controls) == pytest.approx(fitted)


@pytest.mark.parametrize(
    ("intensities", "message"),
    [
        ({}, "name at least one of joy"),
        ({"bliss": 1.0}, "'bliss' is not one of joy"),
        ({"joy": 1.5}, "emotions: joy: 1.5 is above 1"),
    ],
)
def test_senseless_intensities_are_refused(intensities, message: str) -> None:
    with pytest.raises(ParameterError, match=message):
        emotion_stream(intensities)


def test_a_negative_time_is_refused() -> None:
    with pytest.raises(ParameterError, match="onset: -1 is below 0"):
        Timing(onset=-1.0)
