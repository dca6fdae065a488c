from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from risorius.errors import LandmarkError, ShapeError
from risorius.head.frame import Frame
from risorius.io.gltf import write_glb
from risorius.io.track import TurnTrack, WeightTrack
from risorius.io.usd import write_usd
from risorius.playback.head_turn import HeadJoint
from risorius.playback.player import Player
from risorius.rig import Rig
from tests.io.glb import unpack, values
from tests.io.motion.streams import stream_of
from tests.playback.rigs import played_rig
from tests.tools import require_module

TAKE = [{"jawOpen": 0.5}, {"fap_49": 40000.0, "jawOpen": 1.0}, {"head_pitch": 20.0}]
angles = st.floats(-80.0, 80.0)


@pytest.fixture(scope="module")
def joint() -> HeadJoint:
    return HeadJoint.of_rig(played_rig())


def test_the_joint_lies_inside_the_head_below_and_behind_the_eyes(joint: HeadJoint) -> None:
    assert abs(joint.pivot[0]) < 1.0
    assert -60.0 < joint.pivot[1] < -25.0
    assert -110.0 < joint.pivot[2] < -50.0
    eyes_only = {n: s for n, s in played_rig().landmarks.items() if n.startswith("3.")}
    other = HeadJoint.of_rig(replace(played_rig(), landmarks=eyes_only))
    assert np.linalg.norm(other.pivot - joint.pivot) < 5.0


@pytest.mark.parametrize(
    ("turn", "axis", "sign"),
    [
        ({"head_pitch": 20.0}, 1, 1),  # the nose goes up
        ({"fap_48": 20000.0}, 1, -1),
        ({"head_yaw": 20.0}, 0, 1),  # to the left
        ({"fap_49": 20000.0}, 0, 1),
    ],
)
def test_the_nose_goes_where_the_turn_says(
    joint: HeadJoint, turn: dict[str, float], axis: int, sign: int
) -> None:
    moved = _motion(joint, [0.0, 0.0, 100.0], turn)
    assert sign * moved[axis] > 10.0


@pytest.mark.parametrize(("turn", "sign"), [({"head_roll": 20.0}, 1), ({"fap_50": 20000.0}, -1)])
def test_the_crown_tilts_where_the_turn_says(
    joint: HeadJoint, turn: dict[str, float], sign: int
) -> None:
    assert sign * _motion(joint, [0.0, 100.0, 0.0], turn)[0] > 10.0


def _motion(joint: HeadJoint, place: list[float], turn: dict[str, float]) -> np.ndarray:
    """Return how a point moves that lies at `place` from the joint [mm, canonical frame]."""
    point = joint.frame.to_input((joint.pivot + place)[None])
    return joint.frame.to_canonical(joint.turned(point, turn))[0] - joint.pivot - place


@given(pitch=angles, yaw=angles, roll=angles)
def test_a_turn_is_rigid_and_leaves_the_joint_where_it_is(
    pitch: float, yaw: float, roll: float
) -> None:
    # A head in centimetres that lies on its back, with its origin elsewhere.
    frame = Frame(np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]]), 10.0, np.array([3.0, 1, 2]), "cm")
    joint = HeadJoint(np.array([0.0, -40.0, -78.0]), frame)
    turn = {"head_pitch": pitch, "head_yaw": yaw, "head_roll": roll}
    points = np.random.default_rng(2).normal(size=(6, 3))
    moved = joint.turned(points, turn)
    pivot = frame.to_input(joint.pivot[None])
    np.testing.assert_allclose(joint.turned(pivot, turn), pivot, atol=1e-12)
    before = np.linalg.norm(points[:, None] - points, axis=2)
    np.testing.assert_allclose(np.linalg.norm(moved[:, None] - moved, axis=2), before, atol=1e-12)
    rotation = joint.rotation(turn)
    expected = frame.to_canonical(points) - joint.pivot
    if rotation is not None:
        expected = expected @ rotation.T
    np.testing.assert_allclose(frame.to_canonical(moved) - joint.pivot, expected, atol=1e-9)


def test_a_frame_without_a_turn_is_left_bit_for_bit(joint: HeadJoint) -> None:
    points = np.random.default_rng(0).normal(size=(5, 3))
    assert np.array_equal(joint.turned(points, {"jawOpen": 1.0}), points)
    assert joint.track([{}, {"fap_49": 0.0}]) is None


def test_quaternions_of_a_slow_turn_never_jump(joint: HeadJoint) -> None:
    track = joint.track({"head_yaw": float(angle)} for angle in range(0, 720, 10))
    assert track is not None
    steps = (track.rotations[1:] * track.rotations[:-1]).sum(axis=1)
    assert steps.min() > 0.99


def _pose_by_nodes(json: dict[str, Any], binary: bytes, rig: Rig, moment: int) -> np.ndarray:
    """Return the vertices of the skin as a player of glTF would place them."""
    from scipy.spatial.transform import Rotation

    (animation,) = json["animations"]
    output = {
        channel["target"]["path"]: values(
            json, binary, animation["samplers"][channel["sampler"]]["output"]
        )
        for channel in animation["channels"]
    }
    weights = output["weights"].reshape(-1, len(rig.targets))[moment]
    (turning,) = (n for n in json["nodes"] if n["name"] == "head_turn")
    (resting,) = (n for n in json["nodes"] if n["name"] == "head_rest")
    assert turning["children"] == [json["nodes"].index(resting)]
    points = rig.posed(dict(zip(rig.names, weights.tolist()))) + resting["translation"]
    rotation = Rotation.from_quat(output["rotation"][moment])
    return rotation.apply(points) + turning["translation"]


def test_a_glb_turns_its_head_node_about_the_joint(tmp_path: Path) -> None:
    rig = played_rig()
    player = Player(rig, stream_of(TAKE))
    track = player.track()
    write_glb(rig, tmp_path / "x.glb", track=track)
    json, binary = unpack((tmp_path / "x.glb").read_bytes())
    for moment, posed in enumerate(player.positions()):
        shown = _pose_by_nodes(json, binary, rig, moment)
        np.testing.assert_allclose(shown, posed, atol=2e-3)
    assert not player.unmatched
    # At rest the head stands where it stood.
    again = Rig.load(tmp_path / "x.glb")
    np.testing.assert_allclose(again.mesh.positions, rig.mesh.positions, atol=1e-4)


@pytest.mark.parametrize("ending", ["usda", "usdz"])
def test_usd_itself_plays_weights_and_turns_as_we_do(tmp_path: Path, ending: str) -> None:
    require_module("pxr")
    from pxr import Gf, Usd, UsdGeom, UsdSkel

    rig = played_rig().subset(["jawOpen", "joy"])
    player = Player(rig, stream_of(TAKE))
    write_usd(rig, tmp_path / f"x.{ending}", track=player.track())
    stage = Usd.Stage.Open(str(tmp_path / f"x.{ending}"))
    assert (stage.GetStartTimeCode(), stage.GetEndTimeCode()) == (0.0, 2.0)
    assert stage.GetTimeCodesPerSecond() == 25.0
    if ending == "usdz":
        return
    root = UsdSkel.Root(stage.GetPrimAtPath("/Head"))
    assert UsdSkel.BakeSkinning(root, Gf.Interval(0.0, 2.0))
    own = np.flatnonzero(rig.part_of_vertex == rig.part_names.index("skin"))
    skin = UsdGeom.Mesh(stage.GetPrimAtPath("/Head/skin"))
    for code, posed in enumerate(player.positions()):
        # A part that hangs on one joint as a whole is placed by its transform.
        place = np.array(skin.GetLocalTransformation(code))
        points = np.array(skin.GetPointsAttr().Get(code)) @ place[:3, :3] + place[3, :3]
        np.testing.assert_allclose(points, posed[own], atol=2e-3)


def test_a_rig_without_landmarks_says_why_its_head_does_not_turn() -> None:
    rig = replace(played_rig(), landmarks={})
    with pytest.raises(LandmarkError, match="lobes of the ears"):
        HeadJoint.of_rig(rig)
    player = Player(rig, stream_of([{"head_yaw": 10.0, "jawOpen": 1.0}]))
    assert player.track().turns is None
    assert list(player.unmatched) == ["head_yaw"]


def test_tracks_of_turns_are_checked() -> None:
    with pytest.raises(ShapeError, match="unit quaternions"):
        TurnTrack(np.zeros(3), np.zeros((2, 4)))
    with pytest.raises(ShapeError, match=r"must be \(3,\) and \(k, 4\)"):
        TurnTrack(np.zeros(2), np.zeros((2, 4)))
    turns = TurnTrack(np.zeros(3), np.array([[0.0, 0.0, 0.0, 1.0]]))
    with pytest.raises(ShapeError, match="1 turns for 2 moments"):
        WeightTrack(np.array([0.0, 1.0]), np.zeros((2, 1), np.float32), turns=turns)
