"""The layered face keeps the contract of every face and its own laws."""

from __future__ import annotations

import numpy as np
import pytest

from risorius.controls.presets import EMOTIONS, default_presets
from risorius.errors import ParameterError
from risorius.layered.face import LayeredFace
from risorius.rig.face import Face
from risorius.rig.quality.still import still_zone
from tests.layered.faces import builtin_layered, made_up_layered

MIRROR = np.array([-1.0, 1.0, 1.0])


def _both(face: LayeredFace, pose: dict[str, float]) -> dict[str, float]:
    """Spell out paired controls."""
    names = {control.name for control in face.controls}
    full: dict[str, float] = {}
    for name, value in pose.items():
        full |= {name: value} if name in names else {f"{name}_l": value, f"{name}_r": value}
    return full


def _skin(face: LayeredFace, pose: dict[str, float]) -> np.ndarray:
    return face.displace(_both(face, pose))[face.head.skin.first_source()]


def _landmark(face: LayeredFace, moved: np.ndarray, name: str) -> np.ndarray:
    return moved[face.head.skin_vertex(name)]


def test_it_is_a_face() -> None:
    assert isinstance(builtin_layered(), Face)


def test_rest_is_exactly_zero() -> None:
    face = builtin_layered()
    assert not face.displace({}).any()
    assert not face.displace(dict.fromkeys(face.fields, 0.0)).any()


def test_a_pose_depends_on_nothing_but_itself() -> None:
    face = builtin_layered()
    pose = {"zygomaticus_major_l": 0.7, "jaw_pitch": 5.0}
    first = face.displace(pose)
    face.displace({"corrugator_l": 1.0})
    np.testing.assert_array_equal(first, face.displace(dict(reversed(pose.items()))))


def test_unknown_controls_are_refused() -> None:
    with pytest.raises(ParameterError, match="no control 'smile'"):
        builtin_layered().displace({"smile": 1.0})


def test_unit_fields_add_up() -> None:
    face = builtin_layered()
    a, b = {"risorius_l": 0.4}, {"mentalis_r": 0.9}
    both = face.linear_skin(a | b)
    np.testing.assert_allclose(both, face.linear_skin(a) + face.linear_skin(b), atol=1e-12)
    np.testing.assert_allclose(face.linear_skin({"risorius_l": 0.8}), 2.0 * face.linear_skin(a))


@pytest.mark.parametrize(
    "pose",
    [
        {"zygomaticus_major": 1.0},
        {"orbicularis_oris": 1.0, "procerus": 0.5},
        {"depressor_anguli": 1.0, "mentalis": 0.6, "jaw_pitch": 6.0},
        {"lid_upper": 0.7, "lid_lower": 0.4},
    ],
)
def test_symmetric_poses_are_symmetric_to_a_millionth(pose: dict[str, float]) -> None:
    face = builtin_layered()
    assert face.skin.partner is not None
    moved = _skin(face, pose)
    assert np.abs(face.skin.mirrored(moved) - moved).max() < 1e-6


@pytest.mark.parametrize("muscle", ["zygomaticus_major", "corrugator", "orbicularis_oculi"])
def test_right_muscles_mirror_left_ones(muscle: str) -> None:
    face = builtin_layered()
    left, right = _skin(face, {f"{muscle}_l": 1.0}), _skin(face, {f"{muscle}_r": 1.0})
    assert np.abs(face.skin.mirrored(left) - right).max() < 1e-6


@pytest.mark.parametrize(
    ("muscle", "landmark", "direction"),
    [
        ("zygomaticus_major", "2.4", [1, 1, -1]),
        ("risorius", "2.4", [1, 0, -1]),
        ("depressor_anguli", "2.4", [0, -1, 0]),
        ("frontalis_inner", "4.1", [0, 1, 0]),
        ("frontalis_outer", "4.5", [0, 1, 0]),
        ("corrugator", "4.3", [-1, -1, 0]),
        ("levator_labii", "8.10", [0, 1, 0]),
        ("depressor_labii", "8.2", [0, -1, 0]),
        ("mentalis", "2.1", [0, 1, 0]),
        ("procerus", "4.1", [0, -1, 0]),
        ("levator_alae_nasi", "9.1", [0, 1, 0]),
        ("orbicularis_oris", "2.4", [-1, 0, 1]),
        ("orbicularis_oris", "8.1", [0, 0, 1]),
    ],
)
def test_skin_moves_from_insertion_towards_origin(
    muscle: str, landmark: str, direction: list[int]
) -> None:
    face = builtin_layered()
    moved = _landmark(face, _skin(face, {muscle: 1.0}), landmark)
    for axis, sign in enumerate(direction):
        if sign:
            assert sign * moved[axis] > 0.5, (axis, moved)


def test_contraction_is_strong_and_still_human() -> None:
    face = builtin_layered()
    for name in face.fields:
        largest = np.linalg.norm(_skin(face, {name: 1.0}), axis=1).max()
        assert 2.0 < largest < 20.0, name


@pytest.mark.parametrize("emotion", EMOTIONS)
def test_emotions_leave_the_back_of_the_head_and_the_ears_alone(emotion: str) -> None:
    face = builtin_layered()
    pose = default_presets().fit(default_presets().emotions[emotion], face.controls).pose
    moved = np.linalg.norm(face.displace(pose), axis=1)
    assert moved.max() > 4.0
    for zone, still in still_zone(face.head).items():
        assert moved[still].max() < 1e-6, zone


def test_joy_and_sadness_move_the_mouth_corner_opposite_ways() -> None:
    face, book = builtin_layered(), default_presets()
    corner = {
        name: _landmark(
            face, _skin(face, dict(book.fit(book.emotions[name], face.controls).pose)), "2.4"
        )
        for name in ("joy", "sadness")
    }
    assert corner["joy"][1] > 3.0 > -2.0 > corner["sadness"][1]
    assert corner["joy"][0] > 2.0


def test_extreme_random_poses_stay_finite_and_bounded() -> None:
    face = builtin_layered()
    random = np.random.default_rng(5)
    for _ in range(10):
        pose = {
            control.name: random.choice([control.low, control.default, control.high])
            for control in face.controls
        }
        moved = face.displace(pose)
        assert np.isfinite(moved).all()
        assert np.linalg.norm(moved, axis=1).max() < 80.0
    assert not face.displace({}).any()


def test_heads_without_eyes_have_all_muscles_and_no_lids() -> None:
    face = made_up_layered()
    names = {control.name for control in face.controls}
    assert "zygomaticus_major_l" in names
    assert not any(name.startswith("lid_") for name in names)
    assert np.isfinite(face.displace({"zygomaticus_major_l": 1.0, "jaw_pitch": 10.0})).all()


def test_posed_fibres_shorten_and_follow_the_jaw() -> None:
    face = builtin_layered()
    name = "depressor_labii_l"
    rest, shortened = face.fibres[name], face.posed_fibres({name: 1.0})[name]

    def length(fibres: np.ndarray) -> float:
        return float(np.linalg.norm(np.diff(fibres, axis=0), axis=2).sum(axis=0).mean())

    limit = face.muscle_map.by_name["depressor_labii"].shortening
    assert length(shortened) == pytest.approx((1.0 - limit) * length(rest), rel=0.03)
    np.testing.assert_allclose(shortened[0], rest[0])
    opened = face.posed_fibres({"jaw_pitch": 15.0})
    assert (opened[name][0] - rest[0])[:, 1].max() < -5.0
    np.testing.assert_allclose(opened["frontalis_l"], face.fibres["frontalis_l"], atol=1e-9)
