from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from risorius.controls import default_presets
from risorius.controls.control import Pose
from risorius.errors import FormatError
from risorius.layered.faithful import FaithfulFace
from risorius.playback.live import LivePlayer, rig_of_singles
from risorius.playback.motion_basis import motion_basis
from risorius.rig import Face, Rig
from risorius.springmuscle.face import SpringFace
from tests.face_fixtures import builtin_face
from tests.io.motion.streams import stream_of

TAKE = [{"jawOpen": 0.0}, {"jawOpen": 0.5}, {"jawOpen": 1.0, "head_yaw": 10.0}, {"jawOpen": 1.0}]


@cache
def _rig() -> Rig:
    return rig_of_singles(builtin_face(), default_presets())


class _Lagging:
    """A face that goes half of its way in each step: what physics looks like to a player."""

    def __init__(self, face: Face) -> None:
        self._face = face
        self.head, self.controls = face.head, face.controls
        self.displace, self.pose = face.displace, face.pose

    def live(self) -> _Session:
        return _Session(self._face)


class _Session:
    def __init__(self, face: Face) -> None:
        self._face, self._at, self._pose = face, face.head.positions.copy(), {}
        self.passed: list[float] = []

    def set(self, pose: Pose) -> None:
        self._pose = pose

    def step(self, dt: float) -> np.ndarray:
        self.passed.append(dt)
        self._at = 0.5 * (self._at + self._face.pose(self._pose))
        return self._at


def test_every_frame_is_the_pose_of_the_face_and_no_sum_of_targets() -> None:
    player = LivePlayer(builtin_face(), _rig(), stream_of([{"jawOpen": 1.0, "mouthFunnel": 1.0}]))
    assert not player.has_physics
    (posed,) = player.positions()
    pose = player.pose_of({"jawOpen": 1.0, "mouthFunnel": 1.0})
    expected = _rig().frame.to_input(builtin_face().pose(pose))
    np.testing.assert_array_equal(posed, expected)
    summed = _rig().posed(dict(zip(_rig().names, player.weights.of(TAKE[2]).tolist())))
    assert np.abs(posed - summed).max() > 0.1


def test_controls_stay_within_their_ranges_however_much_is_asked() -> None:
    player = LivePlayer(builtin_face(), _rig(), stream_of([{}]))
    pose = player.pose_of({"joy": 1.0, "mouthSmileLeft": 1.0, "zygomaticus_major_l": 3.0})
    ranges = {control.name: control for control in builtin_face().controls}
    assert pose["zygomaticus_major_l"] == 1.0
    assert all(ranges[name].low <= value <= ranges[name].high for name, value in pose.items())


def test_a_face_with_physics_lags_behind_and_arrives() -> None:
    player = LivePlayer(_Lagging(builtin_face()), _rig(), stream_of(TAKE * 1))
    assert player.has_physics
    rest = _rig().mesh.positions
    open_mouth = _rig().frame.to_input(builtin_face().pose(player.pose_of({"jawOpen": 1.0})))
    *_, second, third, fourth = player._simulated()
    far = [float(np.abs(open_mouth - posed).max()) for posed, _ in (second, third, fourth)]
    assert far[0] > far[1] > far[2] > 1.0
    assert np.abs(rest - second[0]).max() > 1.0


def test_live_motion_as_components_follows_the_simulation() -> None:
    player = LivePlayer(_Lagging(builtin_face()), _rig(), stream_of(TAKE))
    rig, track = player.animated(name="take")
    assert track.turns is not None
    assert track.weights.shape == (4, len(rig.targets))
    assert 1 <= len(rig.targets) <= 4
    assert np.abs(track.weights).max() == pytest.approx(1.0)
    for row, (posed, _) in zip(track.weights, player._simulated()):
        shown = rig.posed(dict(zip(rig.names, row.tolist())))
        assert np.sqrt(((shown - posed) ** 2).sum(axis=1).mean()) < 0.05
    again, same = player.animated(name="take")
    np.testing.assert_array_equal(track.weights, same.weights)
    np.testing.assert_array_equal(rig.targets[0].deltas, again.targets[0].deltas)


def test_motion_of_one_shape_is_one_component() -> None:
    rest = _rig().mesh.positions
    moved = _rig().target("jaw_pitch").dense(len(rest))
    found = motion_basis(_rig(), [rest + w * moved for w in (0.0, 0.25, 1.0)], source="x")
    assert len(found.rig.targets) == 1
    np.testing.assert_allclose(found.weights[:, 0], [0.0, 0.25, 1.0], atol=1e-5)
    assert found.error < 1e-3


def test_motion_that_is_none_or_absent() -> None:
    rest = _rig().mesh.positions
    assert motion_basis(_rig(), [rest, rest], source="x").weights.shape == (2, 0)
    with pytest.raises(FormatError, match="x: holds no frames"):
        motion_basis(_rig(), [], source="x")


def test_a_face_of_springs_plays_its_physics_and_the_same_bytes_again() -> None:
    face = SpringFace.build(builtin_face().head)
    rig = rig_of_singles(face, default_presets())
    player = LivePlayer(face, rig, stream_of(TAKE))
    assert player.has_physics
    first, second = list(player.positions()), list(player.positions())
    np.testing.assert_array_equal(first, second)
    # It follows the stream, and is not yet where the pose at rest would be.
    opened = rig.frame.to_input(face.pose(player.pose_of(TAKE[3])))
    unturned = [posed for posed, _ in player._simulated()]
    apart = [float(np.abs(opened - posed).max()) for posed in unturned]
    assert apart[3] < 0.5 * apart[0]


@pytest.mark.slow
def test_the_published_layered_face_plays_its_physics() -> None:
    face = FaithfulFace.build(builtin_face().head)
    rig = _rig().subset(["jaw_pitch", "zygomaticus_major_l"])
    player = LivePlayer(face, rig, stream_of([{"jaw_pitch": 0.0}, {"jaw_pitch": 1.0}]))
    assert player.has_physics
    closed, opening = player.positions()
    np.testing.assert_allclose(closed, rig.mesh.positions, atol=1e-3)
    assert np.abs(opening - closed).max() > 5.0
