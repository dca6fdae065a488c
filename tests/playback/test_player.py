from __future__ import annotations

import tracemalloc
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from risorius.controls.stream import Stream, StreamFrame
from risorius.errors import FormatError, ShapeError
from risorius.io.gltf import WeightTrack, write_glb
from risorius.io.gltf.write import glb_bytes
from risorius.playback.head_turn import HeadJoint
from risorius.playback.player import Player
from risorius.rig import Rig
from tests.io.glb import unpack, values
from tests.io.motion.streams import stream_of
from tests.playback.rigs import played_rig


def test_the_animation_of_a_glb_holds_the_weights_of_every_frame(tmp_path: Path) -> None:
    rig = played_rig()
    player = Player(rig, stream_of([{"jawOpen": 0.0}, {"jawOpen": 0.5}, {"joy": 1.0}]))
    write_glb(rig, tmp_path / "x.glb", track=player.track(name="take"))
    json, binary = unpack((tmp_path / "x.glb").read_bytes())
    (animation,) = json["animations"]
    assert animation["name"] == "take"
    (sampler,) = animation["samplers"]
    times = values(json, binary, sampler["input"]).ravel()
    weights = values(json, binary, sampler["output"]).reshape(3, len(rig.targets))
    assert times == pytest.approx([0.0, 0.04, 0.08])
    assert weights[1, rig.names.index("jawOpen")] == 0.5
    assert weights[2, rig.names.index("joy")] == 1.0
    assert np.count_nonzero(weights) == 2
    moving = {i for i, n in enumerate(json["nodes"]) if "weights" in json["meshes"][n["mesh"]]}
    assert {channel["target"]["node"] for channel in animation["channels"]} == moving
    assert Rig.load(tmp_path / "x.glb").names == rig.names


def test_a_player_can_be_gone_through_again() -> None:
    player = Player(played_rig(), stream_of([{"fap_3": 200.0}, {"fap_12": 90.0}]))
    first, second = list(player), list(player)
    assert np.array_equal(first, second)
    assert first[0].any()


def test_an_empty_stream_has_no_animation() -> None:
    with pytest.raises(FormatError, match="holds no frames"):
        Player(played_rig(), stream_of([])).track()


def test_tracks_of_wrong_shape_or_falling_times_are_refused() -> None:
    with pytest.raises(ShapeError, match="they must rise"):
        WeightTrack(np.array([0.0, 0.0]), np.zeros((2, 3), np.float32))
    with pytest.raises(ShapeError, match=r"must be \(k,\) and \(k, t\)"):
        WeightTrack(np.array([0.0]), np.zeros((2, 3), np.float32))
    track = WeightTrack(np.array([0.0]), np.zeros((1, 3), np.float32))
    with pytest.raises(ShapeError, match="weights of 3 targets"):
        glb_bytes(played_rig(), "x.glb", track=track)


def test_positions_are_those_of_the_weights_and_take_no_memory_with_time() -> None:
    rig = played_rig().subset(["jawOpen", "joy", "browInnerUp"])
    count = 5000

    def frames() -> Iterator[StreamFrame]:
        for number in range(count):
            yield StreamFrame(number / 60.0, {"jawOpen": (number % 50) / 50, "head_yaw": 2.0})

    player = Player(rig, Stream("made up", 60.0, ("jawOpen", "head_yaw"), frames))
    peaks: list[int] = []
    tracemalloc.start()
    for number, posed in enumerate(player.positions()):
        if number % 1000 == 999:
            peaks.append(tracemalloc.get_traced_memory()[1])
            tracemalloc.reset_peak()
        if number == 25:
            joint = HeadJoint.of_rig(rig)
            wanted = joint.turned(rig.posed({"jawOpen": 0.5}), {"head_yaw": 2.0})
            np.testing.assert_allclose(posed, wanted, atol=1e-3)
    tracemalloc.stop()
    assert len(peaks) == 5
    assert max(peaks[1:]) < 1.02 * peaks[1] + 1e4
