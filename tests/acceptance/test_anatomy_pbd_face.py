"""The acceptance list of the layered face, items 9, 10, 13-17, 19 and 21: the face.

The number of a test is that of its item; the others stand in test_anatomy_pbd.py. What is about
bodies of muscles is asked of the published (faithful) face, everything else of both profiles.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from risorius.anatomy.jaw import JawPose
from risorius.anatomy.skin import mirror_partners
from risorius.controls.presets import default_presets
from risorius.io.obj_folder import write_obj_folder
from risorius.layered.faithful import FaithfulFace
from risorius.layered.faithful.anatomy import LaidMuscle
from risorius.layered.faithful.teeth import Teeth
from risorius.rig.bake import bake
from risorius.rig.quality import inspect_rig
from risorius.rig.rig import Rig
from tests.acceptance.anatomy_faces import (
    HEAD,
    MIRROR,
    SMILE,
    Either,
    at,
    emotions_of,
    face_of,
    improved,
    published,
)


@pytest.fixture(scope="module")
def face() -> FaithfulFace:
    return published()


@pytest.fixture(scope="module", params=["faithful", "improved"])
def either(request: pytest.FixtureRequest) -> Either:
    return face_of(request.param)


@pytest.fixture
def emotions(either: Either) -> dict[str, np.ndarray]:
    return emotions_of("faithful" if isinstance(either, FaithfulFace) else "improved")


def _of(positions: np.ndarray, laid: LaidMuscle) -> np.ndarray:
    return positions[laid.surface.first : laid.surface.last]


def test_09_the_jaw_turns_about_its_axis_and_is_clamped(either: Either) -> None:
    jaw = either.mechanics.jaw
    chin = HEAD.landmarks.position("2.10")[None]

    def arm(point: np.ndarray) -> np.ndarray:
        apart = point[0] - jaw.hinge
        return apart - (apart @ jaw.pitch_axis) * jaw.pitch_axis

    before, after = arm(chin), arm(jaw.move(chin, JawPose(18.0)))
    cosine = before @ after / (np.linalg.norm(before) * np.linalg.norm(after))
    assert np.degrees(np.arccos(cosine)) == pytest.approx(18.0, abs=1e-6)
    for asked, given in (
        ({"jaw_pitch": 30.0}, {"jaw_pitch": 18.0}),
        ({"jaw_pitch": -10.0}, {"jaw_pitch": -4.0}),
        ({"jaw_yaw": 9.0}, {"jaw_yaw": 5.0}),
    ):
        np.testing.assert_array_equal(either.displace(asked), either.displace(given))
    frame = jaw.move(np.vstack([np.eye(3), np.zeros(3)]), JawPose(18.0, 5.0))
    turn = frame[:3] - frame[3]
    np.testing.assert_allclose(turn @ turn.T, np.eye(3), atol=1e-12)
    left, right = (jaw.move(chin, JawPose(0.0, yaw)) for yaw in (5.0, -5.0))
    np.testing.assert_allclose(left, right * MIRROR, atol=1e-6)
    upper = HEAD.parts["teeth_upper"].first_source()
    assert not either.displace({"jaw_pitch": 18.0, "jaw_yaw": 5.0})[upper].any()


def test_09_the_cranium_does_not_follow_the_jaw(face: FaithfulFace) -> None:
    cranium = face.muscles.anatomy.surfaces["cranium"]
    opened = face.bones({"jaw_pitch": 18.0})
    rest = face.muscles.anatomy.positions
    part = slice(cranium.first, cranium.last)
    np.testing.assert_array_equal(opened[part], rest[part])


def test_10_the_jaw_moves_exactly_the_muscles_that_depend_on_it(face: FaithfulFace) -> None:
    anatomy = face.muscles.anatomy
    moved = face.muscle_positions({"jaw_pitch": 15.0}) - anatomy.positions
    supports = anatomy.supports()
    depends = {name for name, beneath in supports.items() if "mandible" in beneath}
    assert {"masseter_l", "depressor_labii_r", "risorius_l", "orbicularis_oris"} <= depends
    assert {"frontalis_l", "corrugator_r", "levator_labii_l"}.isdisjoint(depends)
    for laid in anatomy.muscles:
        largest = np.abs(_of(moved, laid)).max()
        assert (largest > 0.5) == (laid.name in depends), laid.name
        assert largest > 0.5 or largest < 1e-3, laid.name


def test_10_the_jaw_moves_the_fibres_on_it_and_none_above_the_mouth() -> None:
    """The improved profile's fibres follow the share of the jaw that the skin over them has.

    Muscles that cross the cheek between skull and mouth corner ride on soft tissue there and
    move with it, also where the map lays them on the skull only; what is asked is that everything
    on the mandible moves and nothing on the upper face does.
    """
    face = improved()
    moved = face.posed_fibres({"jaw_pitch": 15.0})
    largest = {name: float(np.abs(moved[name] - rest).max()) for name, rest in face.fibres.items()}
    by_name = face.muscle_map.by_name
    for name, amount in largest.items():
        if "mandible" in by_name[name.removesuffix("_l").removesuffix("_r")].on:
            assert amount > 1.0, name
        if name.startswith(("frontalis", "corrugator", "procerus")):
            assert amount < 1e-3, name


def test_13_the_lids_close_and_their_corners_stay(either: Either) -> None:
    """The closed lids leave less than 5 % of the opening to be seen, column by column.

    Corners of the published face stay to 1 % of the height of the eye. In the improved one the
    ring muscle draws the outer corner down and in, as in the true blink of a scanned head (9 %
    there); asked is that it stays within 20 %.
    """
    bound = 0.01 if isinstance(either, FaithfulFace) else 0.2
    both = {f"lid_{lid}_{side}": 1.0 for lid in ("upper", "lower") for side in "lr"}
    (shut,) = inspect_rig(bake(either, {"blink": both})).shapes
    for side, corners in (("l", ("3.7", "3.11")), ("r", ("3.8", "3.12"))):
        closed = either.displace({f"lid_upper_{side}": 1.0, f"lid_lower_{side}": 1.0})
        assert shut.lids[side].left < 5.0
        height = either.mechanics.margins[side].height
        for corner in corners:
            assert np.linalg.norm(at(closed, corner)) < bound * height


def _biting(either: Either) -> dict[str, float]:
    names = {control.name for control in either.controls}
    closing = {"orbicularis_oris", "orbicularis_oris_upper", "orbicularis_oris_lower"} & names
    return SMILE | {"jaw_pitch": 18.0} | dict.fromkeys(closing, 1.0)


def test_14_the_skin_stays_out_of_the_teeth(either: Either) -> None:
    poses = {"bite": _biting(either), "smile": SMILE | {"jaw_pitch": 18.0}}
    for shape in inspect_rig(bake(either, poses)).shapes:
        assert {"teeth_upper", "teeth_lower"} <= set(shape.penetration)
        for kind in ("teeth_upper", "teeth_lower"):
            assert shape.penetration[kind].depth < 0.1, (shape.name, kind)


def test_14_the_skin_stays_in_front_of_the_hulls_of_the_teeth(face: FaithfulFace) -> None:
    placed = face.teeth.moved(face.mechanics.jaw, JawPose(18.0))
    assert len(placed.arches) == 2

    def deepest(chosen: FaithfulFace) -> float:
        moved = chosen.displace(_biting(chosen))[HEAD.skin.first_source()]
        return max(arch.depth(HEAD.skin.mesh.positions + moved).max() for arch in placed.arches)

    assert deepest(face) < 0.1
    assert deepest(replace(face, teeth=Teeth(()))) > 0.1, "nothing would get inside"


def test_15_the_back_of_the_head_stays(either: Either, emotions: dict[str, np.ndarray]) -> None:
    source = HEAD.skin.first_source()
    back = HEAD.skin.mesh.positions[:, 2] < either.mechanics.jaw.hinge[2] - 60.0
    assert back.sum() > 100
    extremes = [
        {c.name: c.high for c in either.controls if c.group in groups}
        for groups in (("muscle",), ("jaw", "lid"), ("muscle", "jaw", "lid", "lips", "cheek"))
    ]
    for displacement in (*emotions.values(), *(either.displace(pose) for pose in extremes)):
        assert np.abs(displacement[source][back]).max() < 1e-6


def test_15_the_influence_is_full_at_its_sources(face: FaithfulFace) -> None:
    sources = face.anchors.vertices[~face.anchors.on("cranium")]
    assert len(sources) > 500
    np.testing.assert_array_equal(face.influence[sources], 1.0)
    assert face.influence.min() == 0.0


def test_16_a_pose_depends_on_itself_only(either: Either) -> None:
    smile = either.displace(SMILE)
    either.displace({"jaw_pitch": 18.0, "frontalis_l": 1.0})
    np.testing.assert_array_equal(either.displace(SMILE), smile)
    assert np.abs(either.displace({})).max() == 0.0


def test_17_emotions_move_the_landmarks_as_they_should(emotions: dict[str, np.ndarray]) -> None:
    for left, right, sign in (("2.4", "2.5", 1.0), ("2.5", "2.4", -1.0)):
        joy = at(emotions["joy"], left)
        assert joy[1] > 0.0, "joy raises the mouth corners"
        assert sign * joy[0] > 0.0, "joy widens the mouth"
        assert at(emotions["sadness"], right)[1] < 0.0, "sadness lowers the mouth corners"
    for brow in ("4.1", "4.2"):
        assert at(emotions["sadness"], brow)[1] > 1.0, "sadness raises the inner brows"
        assert at(emotions["fear"], brow)[1] > 1.0, "fear raises the inner brows"
        assert at(emotions["surprise"], brow)[1] > 1.0, "surprise raises the brows"
    assert at(emotions["surprise"], "2.3")[1] < -5.0, "surprise opens the mouth"
    assert at(emotions["disgust"], "2.2")[1] > 0.0, "disgust raises the upper lip"
    for inner, outwards in (("4.1", 1.0), ("4.2", -1.0)):
        assert outwards * at(emotions["anger"], inner)[0] < 0.0, "anger draws the brows together"
        assert at(emotions["anger"], inner)[1] < 0.0, "anger lowers the brows"


def test_17_the_muscles_of_fear_widen_the_lips(either: Either) -> None:
    book = default_presets()
    pose = book.fit(book.emotions["fear"], either.controls).pose
    # The jaw, which drops in fear, carries the corners in; its own part is left out.
    moved = either.displace({name: v for name, v in pose.items() if not name.startswith("jaw")})
    assert at(moved, "2.4")[0] > 0.0
    assert at(moved, "2.5")[0] < 0.0


def test_19_a_mirrored_pose_gives_the_mirrored_face(either: Either) -> None:
    partner = mirror_partners(HEAD.skin.mesh)
    assert partner is not None
    source = HEAD.skin.first_source()
    left, right = (
        either.displace({f"zygomaticus_major_{side}": 1.0, "jaw_pitch": 6.0, "jaw_yaw": yaw})[
            source
        ]
        for side, yaw in (("l", 3.0), ("r", -3.0))
    )
    off = np.abs(left[partner] * MIRROR - right).max()
    assert off < 0.01 * np.abs(left).max()


@pytest.fixture(scope="module")
def shapes() -> dict[str, dict[str, float]]:
    return {"smile": SMILE, "open": {"jaw_pitch": 12.0}}


def test_21_neutral_and_target_are_the_pose(
    either: Either, shapes: dict[str, dict[str, float]]
) -> None:
    """The sum over the neutral is exact in the rig; the face's own pose agrees to rounding.

    The published face bakes its poses side by side in single precision, 16 at a time, and poses
    one by packing constraints instead: both converge to the same rest within the tolerance.
    """
    rig = bake(either, shapes)
    for name, pose in shapes.items():
        dense = rig.target(name).dense(HEAD.vertex_count)
        np.testing.assert_array_equal(rig.posed({name: 1.0}), HEAD.source.positions + dense)
        posed = HEAD.frame.vectors_to_input(either.displace(pose))
        # Motion below a ten-thousandth of a millimetre is left out of rigs.
        off = np.abs(dense - posed).max()
        assert off < (2e-2 if isinstance(either, FaithfulFace) else 2e-4), name


@pytest.mark.parametrize("name", ["face.npz", "face.glb", "face.obj"])
def test_21_every_format_brings_the_shapes_back(
    tmp_path: Path, name: str, shapes: dict[str, dict[str, float]]
) -> None:
    rig = bake(published(), shapes)
    path = tmp_path / name
    if name.endswith(".obj"):
        path = tmp_path / "folder"
        write_obj_folder(rig, path)
    else:
        rig.save(path)
    back = Rig.load(path)
    for shape in shapes:
        first, second = (r.target(shape).dense(HEAD.vertex_count) for r in (rig, back))
        # Files hold single precision: 1e-6 of the head's height.
        assert np.abs(first - second).max() < 1e-6 * HEAD.height
