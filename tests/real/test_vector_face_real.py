"""The vector face on the real heads: mouth opens, eyes close, the rest keeps still."""

from __future__ import annotations

import warnings
from functools import cache

import numpy as np
import numpy.typing as npt
import pytest

from risorius.errors import RisoriusWarning
from risorius.head.eyes import EYE_LANDMARKS
from risorius.vectormuscle import VectorFace
from tests.real.heads import REAL_HEADS, real_head

pytestmark = pytest.mark.real


@cache
def _build(name: str) -> VectorFace:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RisoriusWarning)
        return VectorFace.build(real_head(name))


@pytest.fixture(params=REAL_HEADS)
def face(request: pytest.FixtureRequest) -> VectorFace:
    return _build(request.param)


def _skin(face: VectorFace, pose: dict[str, float]) -> npt.NDArray[np.float64]:
    return face.displace(pose)[face.head.skin.first_source()]


def test_eyes_lids_and_tongue_are_found(face: VectorFace) -> None:
    assert face.notes == ()
    groups = {control.group for control in face.controls}
    assert groups == {"muscle", "jaw", "lips", "cheek", "lid", "gaze", "tongue"}


def test_the_jaw_opens_the_mouth_by_over_60_percent_of_the_way_of_the_chin(face) -> None:
    moved = _skin(face, {"jaw_pitch": 18.0})
    upper, lower, chin = (face.head.skin_vertex(name) for name in ("2.2", "2.3", "2.1"))
    rest = face.head.skin.mesh.positions
    gap = (rest + moved)[upper] - (rest + moved)[lower]
    before = np.linalg.norm(rest[upper] - rest[lower])
    assert np.linalg.norm(moved[chin]) > 25.0
    assert gap[1] > 0.0
    assert np.linalg.norm(gap) - before > 0.6 * np.linalg.norm(moved[chin])
    assert np.linalg.norm(moved[upper]) < 0.05 * np.linalg.norm(moved[chin])


@pytest.mark.parametrize("side", ["l", "r"])
def test_a_blink_leaves_less_than_5_percent_of_the_opening(face: VectorFace, side: str) -> None:
    lids = face.mechanics.lids[side]
    rest = face.head.skin.mesh.positions
    moved = rest + _skin(face, {f"lid_upper_{side}": 1.0, f"lid_lower_{side}": 1.0})
    up = np.cross([0.0, 0.0, 1.0], lids.axis)

    def opening(points: npt.NDArray[np.float64]) -> float:
        names = EYE_LANDMARKS[side][2:]
        arms = points[[face.head.skin_vertex(name) for name in names]] - lids.centre
        upper, lower = np.arctan2(arms @ up, arms[:, 2])
        return float(upper - lower)

    assert opening(rest) > 0.3
    assert abs(opening(moved)) < 0.05 * opening(rest)


@pytest.mark.parametrize("side", ["l", "r"])
def test_closed_lids_do_not_cut_into_the_eyeball(face: VectorFace, side: str) -> None:
    lids, eye = face.mechanics.lids[side], face.mechanics.eyes[side]
    rest = face.head.skin.mesh.positions
    moved = rest + _skin(face, {f"lid_upper_{side}": 1.0, f"lid_lower_{side}": 1.0})
    turned = lids.vertices[lids.weight > 0.5]

    def clearance(points: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
        arm = points[turned] - lids.centre
        assert lids.surface is not None
        return np.linalg.norm(arm, axis=1) - lids.surface.radius(arm)

    added = clearance(moved) - np.minimum(clearance(rest), 0.0)
    assert added.min() > -0.05 * eye.radius


def test_jaw_side_muscles_leave_the_upper_lip_bit_identical(face: VectorFace) -> None:
    lips = face.mechanics.lips
    first = face.head.skin.first_source()
    upper = lips.upper & (lips.distance < lips.width)
    rest = face.head.positions[first][upper]
    lower = [m.name for m in face.vectors.muscles if getattr(m, "regions", ()) == ("lower",)]
    assert len(lower) >= 4
    for name in (*lower, "orbicularis_oris_lower"):
        posed = face.pose({name: 1.0})[first]
        np.testing.assert_array_equal(posed[upper], rest, err_msg=name)
        assert np.abs(posed - face.head.positions[first]).max() > 1.0


def test_the_back_of_the_head_keeps_still_in_every_control(face: VectorFace) -> None:
    rest = face.head.skin.mesh.positions
    hinge = face.mechanics.jaw.hinge
    behind = (rest[:, 2] < hinge[2] - 15.0) & ~face.mechanics.lips.inside
    assert behind.sum() > 200
    for control in face.controls:
        for value in (control.low, control.high):
            moved = _skin(face, {control.name: value})[behind]
            assert np.abs(moved).max() < 1e-6 * face.head.height, control.name


def test_upper_teeth_stay_and_lower_teeth_follow_the_jaw(face: VectorFace) -> None:
    moved = face.displace({"jaw_pitch": 18.0, "jaw_yaw": 4.0})
    parts = face.head.parts
    np.testing.assert_array_equal(moved[parts["teeth_upper"].source], 0.0)
    assert np.linalg.norm(moved[parts["teeth_lower"].source], axis=1).min() > 5.0


def test_eyes_turn_in_place(face: VectorFace) -> None:
    moved = face.pose({"gaze_yaw_l": 25.0, "gaze_pitch_l": 10.0})
    eye, part = face.mechanics.eyes["l"], face.head.parts["eye_left"]
    assert eye.is_round
    before = np.linalg.norm(face.head.positions[part.source] - eye.centre, axis=1)
    after = np.linalg.norm(moved[part.source] - eye.centre, axis=1)
    np.testing.assert_allclose(after, before, rtol=1e-9)


def test_the_neutral_pose_is_the_input_bit_for_bit(face: VectorFace) -> None:
    np.testing.assert_array_equal(face.displace({}), 0.0)
