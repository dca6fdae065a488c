"""Takes: any moment of a stream, on the baked face and on the face itself."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from risorius.controls.shape_sets import SHAPE_SETS
from risorius.controls.stream import Stream, StreamFrame
from risorius.errors import Cancelled, FormatError
from risorius.playback.emotion_timing import emotion_stream
from risorius.playback.pictures import has_ffmpeg
from risorius.project import Project
from risorius.rig.rig import Rig
from risorius.studio.baking import bake_subject
from risorius.studio.jobs import Job
from risorius.studio.scene import Stage, stage_of
from risorius.studio.stage_rig import StageRig
from risorius.studio.subject import build_subject
from risorius.studio.take import Rehearsal, Take, open_take, rehearse
from risorius.studio.work import work_of


@cache
def _stage() -> Stage:
    return stage_of(build_subject(work_of(Project(method="vector"))))


@cache
def _baked() -> StageRig:
    rig = bake_subject(_stage().subject, SHAPE_SETS, Job("bake"))
    return StageRig.build(_stage(), rig, Job("bake"))


def _stream(*frames: Mapping[str, float], rate: float = 10.0) -> Stream:
    names = tuple(dict.fromkeys(name for frame in frames for name in frame))

    def rows() -> Iterator[StreamFrame]:
        for number, values in enumerate(frames):
            yield StreamFrame(number / rate, values)

    return Stream("made", rate, names, rows)


def _take(stream: Stream) -> Take:
    return open_take(stream, _baked(), _stage().subject.presets, Job("open"))


def _rehearsal(stream: Stream) -> Rehearsal:
    subject = _stage().subject
    found = rehearse(stream, subject.face, subject.presets, Job("open"))
    assert found is not None
    return found


def test_the_moment_of_a_frame_is_the_pose_of_the_rig() -> None:
    take = _take(_stream({}, {"joy": 0.5, "jawOpen": 0.3}, {"joy": 1.0}))
    rig = take.rig.rig
    wanted = rig.frame.to_canonical(rig.posed({"joy": 0.5, "jawOpen": 0.3}))
    shown = take.shown(0.1)(_stage(), {"skin"}).meshes["skin"]
    part = _stage().subject.head.skin
    assert np.abs(shown - wanted[part.first_source()]).max() < 1.0 / 128.0


def test_what_was_baked_of_another_stage_moves_only_meshes_that_are_still_there() -> None:
    take = _take(_stream({"jawOpen": 1.0}))
    groups = {"skin", "parts"}
    assert {"skin", "teeth_lower"} <= set(take.shown(0.0)(_stage(), groups).meshes)
    others = tuple(each for each in _stage().meshes if each.name != "teeth_lower")
    changed = replace(_stage(), meshes=others)
    assert "teeth_lower" not in take.shown(0.0)(changed, groups).meshes
    another = replace(_stage(), meshes=tuple(replace(each) for each in others))
    shown = take.shown(0.0)(another, groups).meshes
    assert list(shown) == ["skin"]
    assert np.array_equal(shown["skin"], another.rest("skin"))


@pytest.mark.parametrize("make", [_take, _rehearsal])
def test_between_two_frames_motion_is_straight_and_beyond_the_ends_it_rests(make) -> None:
    timed = make(_stream({}, {"jaw_pitch": 1.0}))
    places = [timed.shown(time)(_stage(), {"skin"}).meshes["skin"] for time in (0.0, 0.05, 0.1, 9)]
    start, middle, end, after = places
    assert np.abs(end - start).max() > 5.0
    if isinstance(timed, Take):
        assert np.abs(middle - 0.5 * (start + end)).max() < 1.0 / 128.0
    else:  # the jaw itself goes on a circle
        subject = _stage().subject
        half = 0.5 * next(each.high for each in subject.face.controls if each.name == "jaw_pitch")
        posed = subject.face.pose({"jaw_pitch": half})[subject.head.skin.first_source()]
        assert np.abs(middle - posed).max() < 1e-9
    assert np.array_equal(after, end)
    assert timed.curve().tolist() == [0.0, 1.0]


def test_a_rehearsal_shows_the_face_itself_and_its_bones() -> None:
    subject = _stage().subject
    pose = subject.presets.fit(subject.presets.emotions["joy"], subject.face.controls).pose
    timed = _rehearsal(_stream({"joy": 1.0}))
    shown = timed.shown(0.0)(_stage(), {"skin", "skull"}).meshes
    wanted = subject.face.pose(pose)[subject.head.skin.first_source()]
    assert np.abs(shown["skin"] - wanted).max() < 1e-9


def test_parameters_of_mpeg4_wait_for_the_rig() -> None:
    stream = _stream({"fap_3": 200.0})
    subject = _stage().subject
    assert rehearse(stream, subject.face, subject.presets, Job("open")) is None
    shown = _take(stream).shown(0.0)(_stage(), {"skin"}).meshes["skin"]
    assert np.abs(shown - _stage().rest("skin")).max() > 1.0


@pytest.mark.parametrize("make", [_take, _rehearsal])
def test_the_head_turns_as_the_stream_says(make) -> None:
    timed = make(_stream({"head_yaw": 0.0}, {"head_yaw": 20.0}))
    turn = timed.shown(0.1)(_stage(), {"skin"}).turn
    assert turn is not None
    assert np.allclose(turn[3:], [0.0, np.sin(np.radians(10.0)), 0.0, np.cos(np.radians(10.0))])
    half = timed.shown(0.05)(_stage(), {"skin"}).turn
    assert half is not None and np.allclose(half[4], np.sin(np.radians(5.0)), atol=1e-4)
    assert make(_stream({"joy": 1.0})).shown(0.0)(_stage(), {"skin"}).turn is None


def test_recording_writes_an_animation_of_every_frame(tmp_path: Path) -> None:
    path = tmp_path / "take.glb"
    assert _take(emotion_stream({"joy": 1.0}, rate=10.0)).record(path, Job("record")) == 23
    assert len(Rig.load(path).targets) == len(_baked().rig.targets)
    assert b'"animations"' in path.read_bytes()


@pytest.mark.skipif(not has_ffmpeg(), reason="no ffmpeg")
def test_a_film_that_is_stopped_leaves_nothing(tmp_path: Path) -> None:
    class Impatient(Job):
        def tick(self, done: int, count: int, name: str) -> None:
            if done == 2:
                self.cancel()
            super().tick(done, count, name)

    with pytest.raises(Cancelled, match="cancelled"):
        _take(emotion_stream({"joy": 1.0})).record(tmp_path / "take.mp4", Impatient("recording"))
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("make", [_take, _rehearsal])
def test_a_stream_without_frames_or_without_end_is_refused(make) -> None:
    with pytest.raises(FormatError, match="holds no frames"):
        make(_stream())
    with pytest.raises(FormatError, match="too long for the timeline"):
        make(_stream(*[{"joy": 0.1}] * 20_001))
