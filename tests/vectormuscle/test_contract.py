"""What every face promises (spec unify.md section 7), for vector muscles on the built-in head."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import numpy.typing as npt
import pytest
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation

from risorius.anatomy.template import builtin_head
from risorius.controls import default_presets, mirrored
from risorius.errors import ParameterError, RisoriusWarning
from risorius.head import Head
from risorius.landmarks import LandmarkSpec
from risorius.mesh.normals import face_areas, face_normals
from risorius.rig import Face
from risorius.vectormuscle import VectorFace
from tests.face_fixtures import builtin_face

FACE = builtin_face()
HEAD = FACE.head
REST = HEAD.positions
CONTROLS = {control.name: control for control in FACE.controls}
# Vector muscles lack some that the emotions name; the presets say what stands in for them.
EMOTIONS = {
    name: default_presets().fit(pose, FACE.controls).pose
    for name, pose in default_presets().emotions.items()
}
# Two muscles that overlap, jaw, lid, gaze, tongue and cheek at once, different on both sides.
BUSY = {
    "zygomaticus_major_l": 0.8,
    "levator_labii_l": 0.5,
    "risorius_r": 0.6,
    "orbicularis_oris": 0.3,
    "jaw_pitch": 9.0,
    "jaw_yaw": 2.0,
    "lid_upper_l": 0.7,
    "gaze_yaw_r": 12.0,
    "tongue_side": 0.4,
    "cheek_puff_r": 0.5,
}


def _moved_head(scale: float, turn: npt.NDArray[np.float64], **options: str) -> Head:
    source = builtin_head().source
    positions = scale * source.positions @ turn.T
    specs = {
        name: LandmarkSpec(vertex=mark.vertices[0])
        if len(mark.vertices) == 1
        else LandmarkSpec(position=tuple(mark.at(positions)))
        for name, mark in builtin_head().landmarks.items()
    }
    return Head.from_mesh(replace(source, positions=positions), specs, **options)


def test_it_is_a_face() -> None:
    assert isinstance(FACE, Face)
    assert len(CONTROLS) == len(FACE.controls)


def test_the_neutral_pose_is_the_input_bit_for_bit() -> None:
    at_rest = {control.name: control.default for control in FACE.controls}
    for pose in ({}, at_rest):
        np.testing.assert_array_equal(FACE.displace(pose), 0.0)
        np.testing.assert_array_equal(FACE.pose(pose), REST)


def test_the_same_pose_gives_the_same_bytes_whatever_was_posed_before() -> None:
    first = FACE.pose(BUSY)
    FACE.pose(EMOTIONS["disgust"])
    again = FACE.pose(dict(reversed(BUSY.items())))
    assert first.tobytes() == again.tobytes()


def test_a_face_built_again_moves_alike_bit_for_bit() -> None:
    again = VectorFace.build(builtin_head())
    assert again.pose(BUSY).tobytes() == FACE.pose(BUSY).tobytes()


def test_posing_leaves_the_head_as_it_was() -> None:
    before = REST.copy()
    FACE.pose(BUSY)
    np.testing.assert_array_equal(HEAD.positions, before)


def _inverted_share(moved: npt.NDArray[np.float64]) -> float:
    """Return the share of the skin's rest area whose faces have turned by over 90 degrees."""
    faces = HEAD.skin.mesh.faces
    rest = HEAD.skin.mesh.positions
    area = face_areas(rest, faces)
    posed = moved[HEAD.skin.first_source()]
    turned = (face_normals(posed, faces) * face_normals(rest, faces)).sum(axis=1) < 0.0
    return float(area[turned].sum() / area.sum())


def test_the_measure_of_inverted_faces_sees_a_folded_patch() -> None:
    folded = REST.copy()
    folded[REST[:, 2] > -10.0, 2] *= -1.0
    assert _inverted_share(folded) > 0.01
    assert _inverted_share(REST) == 0.0


@pytest.mark.parametrize("name", CONTROLS)
def test_every_control_at_its_ends_is_finite_and_turns_no_skin_inside_out(name: str) -> None:
    control = CONTROLS[name]
    for value in (control.low, control.default, control.high):
        moved = FACE.pose({name: value})
        assert np.isfinite(moved).all()
        assert _inverted_share(moved) < 0.01
    assert np.linalg.norm(moved - REST, axis=1).max() > 0.5


@pytest.mark.parametrize("end", ["low", "high"])
def test_all_controls_at_once_stay_finite(end: str) -> None:
    moved = FACE.pose({name: getattr(control, end) for name, control in CONTROLS.items()})
    assert np.isfinite(moved).all()
    assert np.linalg.norm(moved - REST, axis=1).max() < 0.5 * HEAD.height


@pytest.mark.parametrize("name", EMOTIONS)
def test_emotions_turn_no_skin_inside_out(name: str) -> None:
    assert _inverted_share(FACE.pose(EMOTIONS[name])) < 0.01


@pytest.mark.parametrize("pose", [BUSY, *EMOTIONS.values()], ids=["busy", *EMOTIONS])
def test_the_mirrored_pose_is_the_mirror_image(pose) -> None:
    left, right = FACE.displace(pose), FACE.displace(mirrored(pose, CONTROLS))
    size = np.abs(left).max()
    kinds = {
        f"{kind}_{side}": f"{kind}_{other}"
        for kind in ("eye", "lashes")
        for side, other in (("left", "right"), ("right", "left"))
    }
    for kind, part in HEAD.parts.items():
        other = HEAD.parts[kinds.get(kind, kind)]
        mirror = np.array([-1.0, 1.0, 1.0])
        distance, partner = cKDTree(other.mesh.positions).query(part.mesh.positions * mirror)
        assert distance.max() < 1e-9
        assert len(set(partner)) == part.vertex_count
        one = left[part.first_source()]
        two = right[other.first_source()][partner] * mirror
        np.testing.assert_allclose(two, one, atol=1e-6 * size, err_msg=kind)


@pytest.mark.parametrize(
    ("scale", "axis"), [(0.001, "y"), (0.001, "x"), (0.1, "z")], ids=["m y", "m x", "cm z"]
)
def test_a_head_of_another_size_and_turn_gives_the_same_face(scale: float, axis: str) -> None:
    turn = np.round(Rotation.from_euler(axis, 90, degrees=True).as_matrix())
    face = VectorFace.build(_moved_head(scale, turn))
    for pose in (BUSY, EMOTIONS["fear"]):
        expected = FACE.displace(pose)
        found = face.head.frame.vectors_to_input(face.displace(pose)) @ turn / scale
        np.testing.assert_allclose(found, expected, atol=1e-5 * HEAD.height)


def test_a_head_a_thousand_times_too_large_gives_the_same_face() -> None:
    turn = np.round(Rotation.from_euler("y", 90, degrees=True).as_matrix())
    with pytest.warns(RisoriusWarning, match="fit no unit"):
        head = _moved_head(1000.0, turn)
    face = VectorFace.build(head)
    expected = FACE.displace(BUSY)
    found = face.head.frame.vectors_to_input(face.displace(BUSY)) @ turn / 1000.0
    np.testing.assert_allclose(found, expected, atol=1e-5 * HEAD.height)


def test_values_outside_the_range_are_clamped() -> None:
    for name, control in CONTROLS.items():
        for beyond, end in ((control.low - 99.0, control.low), (control.high + 99.0, control.high)):
            np.testing.assert_array_equal(FACE.displace({name: beyond}), FACE.displace({name: end}))


def test_a_control_that_does_not_exist_is_refused() -> None:
    with pytest.raises(ParameterError, match="this face has no control 'smile'; it has buccinator"):
        FACE.pose({"smile": 1.0})


@pytest.mark.parametrize("value", [float("nan"), float("inf"), "much", None])
def test_a_value_that_is_no_number_is_refused(value: object) -> None:
    with pytest.raises(ParameterError, match=r"^pose: jaw_pitch: "):
        FACE.pose({"jaw_pitch": value})


def test_joy_raises_the_corners_of_the_mouth() -> None:
    moved = FACE.displace(EMOTIONS["joy"])[HEAD.skin.first_source()]
    for name, sign in (("2.4", 1.0), ("2.5", -1.0)):
        corner = moved[HEAD.skin_vertex(name)]
        assert corner[1] > 2.0
        assert sign * corner[0] > 1.0
