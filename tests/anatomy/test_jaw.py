from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from risorius.anatomy.jaw import JawAxes, JawPose, jaw_axes, rotate
from risorius.errors import LandmarkError
from tests.face_fixtures import builtin_face
from tests.synthetic import landmark_points, landmark_set

POINTS = np.random.default_rng(4).normal(scale=60.0, size=(40, 3))
SIDE = np.array([70.0, 0.0, 0.0])
HINGE = np.array([0.0, -20.0, 10.0])
CHIN = landmark_points()["2.1"]

angles = st.floats(-180.0, 180.0)


def _axes(**places: tuple[float, float, float]) -> JawAxes:
    marks = landmark_set(landmark_points() | places)
    return jaw_axes(condyle_left=HINGE + SIDE, condyle_right=HINGE - SIDE, landmarks=marks)


@given(st.tuples(*[st.floats(-1.0, 1.0)] * 3).filter(lambda a: np.linalg.norm(a) > 0.1), angles)
def test_rotation_is_rodrigues_formula(axis, angle: float) -> None:
    unit = np.asarray(axis) / np.linalg.norm(axis)
    expected = Rotation.from_rotvec(np.radians(angle) * unit).apply(POINTS - HINGE) + HINGE
    turned = rotate(POINTS, about=HINGE, axis=unit, angle=np.radians(angle))
    np.testing.assert_allclose(turned, expected, atol=1e-10)
    on_axis = HINGE + 31.0 * unit
    still = rotate(on_axis[None], about=HINGE, axis=unit, angle=np.radians(angle))
    np.testing.assert_allclose(still[0], on_axis, atol=1e-12)


def test_a_turn_by_nothing_returns_the_points_to_the_last_bit() -> None:
    axis = np.array([0.36, 0.48, 0.8])
    np.testing.assert_array_equal(rotate(POINTS, about=HINGE, axis=axis, angle=0.0), POINTS)


def test_each_point_may_turn_by_its_own_angle() -> None:
    axis = np.array([1.0, 0.0, 0.0])
    own = np.linspace(-1.0, 1.0, len(POINTS))
    together = rotate(POINTS, about=HINGE, axis=axis, angle=own)
    for row in (0, 17, 39):
        alone = rotate(POINTS[row : row + 1], about=HINGE, axis=axis, angle=own[row])
        np.testing.assert_array_equal(alone[0], together[row])


@given(st.floats(-4.0, 18.0), st.floats(-5.0, 5.0), st.floats(-2.0, 8.0))
def test_bone_keeps_its_shape(pitch: float, yaw: float, protrusion: float) -> None:
    moved = _axes().move(POINTS, JawPose(pitch, yaw, protrusion))
    gaps = np.linalg.norm(POINTS[:, None] - POINTS, axis=2)
    np.testing.assert_allclose(np.linalg.norm(moved[:, None] - moved, axis=2), gaps, atol=1e-9)
    edges, turned = POINTS[1:4] - POINTS[0], moved[1:4] - moved[0]
    assert np.linalg.det(turned) == pytest.approx(np.linalg.det(edges), rel=1e-9)


def test_opening_by_18_degrees_turns_the_chin_by_18_degrees_about_the_hinge() -> None:
    axes = _axes()
    moved = axes.move([CHIN], JawPose(pitch=18.0))[0]
    before, after = (point - HINGE for point in (np.asarray(CHIN), moved))
    for arm in (before, after):
        arm -= (arm @ axes.pitch_axis) * axes.pitch_axis
    cosine = before @ after / (np.linalg.norm(before) * np.linalg.norm(after))
    assert np.degrees(np.arccos(cosine)) == pytest.approx(18.0, abs=1e-6)


def test_positive_pitch_opens_yaw_goes_left_and_protrusion_forwards() -> None:
    axes = _axes()
    opened, turned, pushed = (
        axes.move([CHIN], pose)[0] - CHIN
        for pose in (JawPose(pitch=10.0), JawPose(yaw=5.0), JawPose(protrusion=4.0))
    )
    assert opened[1] < -5.0
    assert abs(opened[0]) < 1e-9
    assert turned[0] > 3.0
    assert abs(turned[1]) < 1e-9
    np.testing.assert_allclose(pushed, 4.0 * axes.forward, atol=1e-12)
    assert pushed[2] > 3.5


def test_opposite_yaws_are_mirror_images() -> None:
    axes = _axes()
    mirror = np.array([-1.0, 1.0, 1.0])
    left = axes.move(POINTS, JawPose(pitch=7.0, yaw=5.0, protrusion=2.0))
    right = axes.move(POINTS * mirror, JawPose(pitch=7.0, yaw=-5.0, protrusion=2.0))
    np.testing.assert_allclose(right * mirror, left, atol=1e-10)


def test_pitch_comes_before_yaw_and_yaw_before_protrusion() -> None:
    axes = _axes()
    pitched = axes.move(POINTS, JawPose(pitch=12.0))
    then = axes.move(pitched, JawPose(yaw=5.0))
    last = axes.move(then, JawPose(protrusion=3.0))
    np.testing.assert_allclose(axes.move(POINTS, JawPose(12.0, 5.0, 3.0)), last, atol=1e-12)


def test_a_share_turns_by_that_share_of_the_angle() -> None:
    axes = _axes()
    half = axes.move(POINTS, JawPose(pitch=16.0, protrusion=6.0), share=0.5)
    whole = axes.move(POINTS, JawPose(pitch=8.0, protrusion=3.0))
    np.testing.assert_allclose(half, whole, atol=1e-12)
    none = axes.move(POINTS, JawPose(18.0, 5.0, 8.0), share=0.0)
    np.testing.assert_array_equal(none, POINTS)


def test_the_axes_are_unit_and_yaw_and_protrusion_stand_square_to_the_hinge() -> None:
    axes = _axes(**{"11.4": (3.0, 130.0, -20.0)})
    for axis in (axes.pitch_axis, axes.yaw_axis, axes.forward):
        assert np.linalg.norm(axis) == pytest.approx(1.0, rel=1e-12)
    assert abs(axes.pitch_axis @ axes.yaw_axis) < 1e-12
    assert abs(axes.pitch_axis @ axes.forward) < 1e-12
    np.testing.assert_array_equal(axes.hinge, HINGE)


def test_a_known_crown_tilts_the_yaw_axis() -> None:
    axes = _axes(**{"11.4": (0.0, 80.0, -20.0)})
    expected = np.array([0.0, 100.0, -30.0]) / np.hypot(100.0, 30.0)
    np.testing.assert_allclose(axes.yaw_axis, expected, atol=1e-12)


def test_protrusion_runs_from_7_1_to_2_10_as_published() -> None:
    axes = _axes(**{"7.1": (0.0, -80.0, 0.0), "2.10": (0.0, -100.0, 80.0)})
    expected = np.array([0.0, -20.0, 80.0]) / np.hypot(20.0, 80.0)
    np.testing.assert_allclose(axes.forward, expected, atol=1e-12)


@pytest.mark.parametrize("back", [(0.0, -20.0, 30.0), (0.0, -100.0, 90.0), (0.0, -140.0, 20.0)])
def test_a_guessed_7_1_that_would_send_the_jaw_steeply_is_not_followed(back) -> None:
    axes = _axes(**{"7.1": back, "2.10": (0.0, -100.0, 80.0)})
    np.testing.assert_array_equal(axes.forward, _axes().forward)


def test_condyles_at_one_point_are_refused() -> None:
    with pytest.raises(LandmarkError, match="the condyles coincide; the jaw has no axis"):
        jaw_axes(condyle_left=HINGE, condyle_right=HINGE, landmarks=landmark_set())


@pytest.mark.parametrize(
    ("asked", "given"),
    [
        ({"jaw_pitch": 30.0}, {"jaw_pitch": 18.0}),
        ({"jaw_pitch": -10.0}, {"jaw_pitch": -4.0}),
        ({"jaw_yaw": 9.0}, {"jaw_yaw": 5.0}),
        ({"jaw_protrusion": 50.0}, {"jaw_protrusion": 8.0}),
    ],
)
def test_the_jaw_stops_at_its_limits(asked, given) -> None:
    face = builtin_face()
    np.testing.assert_array_equal(face.displace(asked), face.displace(given))


def test_teeth_follow_the_bone_and_the_skull_stays() -> None:
    face = builtin_face()
    moved = face.pose({"jaw_pitch": 18.0, "jaw_yaw": 3.0})
    lower, upper = face.head.parts["teeth_lower"], face.head.parts["teeth_upper"]
    expected = face.mechanics.jaw.move(face.head.positions[lower.source], JawPose(18.0, 3.0))
    np.testing.assert_allclose(moved[lower.source], expected, atol=1e-9)
    np.testing.assert_array_equal(moved[upper.source], face.head.positions[upper.source])


def test_the_skin_of_the_chin_follows_and_the_upper_lip_stays() -> None:
    face = builtin_face()
    share = face.mechanics.jaw_share
    vertex = face.head.skin_vertex
    assert share.min() >= 0.0
    assert share.max() <= 1.0
    assert share[vertex("2.1")] > 0.97
    assert share[vertex("2.3")] > 0.95
    assert share[vertex("2.2")] < 0.05
    for name in ("2.4", "2.5"):
        assert share[vertex(name)] == pytest.approx(0.5, abs=0.05)
    for name in ("9.3", "3.3", "4.1", "11.4", "10.1", "10.2"):
        assert share[vertex(name)] < 0.02


def test_the_mouth_opens_by_most_of_what_the_chin_travels() -> None:
    face = builtin_face()
    skin = face.head.skin
    moved = face.displace({"jaw_pitch": 18.0})[skin.first_source()]
    gap = moved[face.head.skin_vertex("2.2")] - moved[face.head.skin_vertex("2.3")]
    chin = np.linalg.norm(moved[face.head.skin_vertex("2.1")])
    assert gap[1] > 0.6 * chin
