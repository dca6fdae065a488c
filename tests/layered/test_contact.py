"""Skin stays out of teeth and eyeballs, lips out of each other, tissue keeps its volume."""

from __future__ import annotations

import numpy as np
import pytest

from risorius.layered.kernels.turns import best_turns
from risorius.spatial.hull import convex_hull
from tests.layered.faces import builtin_layered


def _pressed(pose: dict[str, float], amount: float) -> np.ndarray:
    """Return the skin pushed back onto the teeth round the mouth, then resolved."""
    face = builtin_layered()
    near = np.exp(-((face.skin.mouth.distance / 15.0) ** 2)) * ~face.skin.hidden
    pushed = np.zeros_like(face.skin.positions)
    pushed[:, 2] = -amount * near
    return face.skin.positions + face.contact.resolve(pushed, pose)


@pytest.mark.parametrize("amount", [4.0, 8.0])
def test_lips_pressed_onto_the_teeth_stay_outside(amount: float) -> None:
    face = builtin_layered()
    points = _pressed({}, amount)[~face.skin.hidden]
    for kind in ("teeth_upper", "teeth_lower"):
        hull = convex_hull(face.head.parts[kind].mesh.positions)
        rest = hull.depth(face.skin.positions[~face.skin.hidden])
        assert (hull.depth(points) - np.maximum(rest, 0.0)).max() < 0.1


def test_the_lower_teeth_push_where_the_jaw_has_carried_them() -> None:
    face = builtin_layered()
    names = {control.name for control in face.controls}
    assert "jaw_pitch" in names
    moved = face.displace({"jaw_pitch": 12.0, "zygomaticus_major_l": 1.0, "depressor_labii_l": 1.0})
    skin = face.head.skin.mesh.positions + moved[face.head.skin.first_source()]
    teeth = face.head.parts["teeth_lower"]
    posed = teeth.mesh.positions + moved[teeth.first_source()]
    depth = convex_hull(posed).depth(skin[~face.skin.hidden])
    rest = convex_hull(teeth.mesh.positions).depth(face.skin.positions[~face.skin.hidden])
    assert (depth - np.maximum(rest, 0.0)).max() < 0.1


def test_resting_skin_is_not_touched() -> None:
    face = builtin_layered()
    still = np.zeros_like(face.skin.positions)
    assert not face.contact.resolve(still, {}).any()


def test_crossing_lips_are_parted() -> None:
    face = builtin_layered()
    lips = face.mechanics.lips
    raised = np.zeros_like(face.skin.positions)
    raised[:, 1] = 3.0 * lips.lower * np.exp(-((lips.distance / 8.0) ** 2))
    parted = face.contact.lips.part(raised)
    pairs = lips.pairs(face.skin.positions)
    rest = face.skin.positions
    before = (rest + raised)[pairs[:, 0], 1] - (rest + raised)[pairs[:, 1], 1]
    after = (rest + parted)[pairs[:, 0], 1] - (rest + parted)[pairs[:, 1], 1]
    assert before.min() < -2.0
    assert after.min() > -0.7


def test_shrinking_skin_swells_and_stretching_skin_thins() -> None:
    face = builtin_layered()
    correctives = face.correctives
    centre = np.array([42.0, -40.0, -5.0])
    offset = correctives.rest - centre
    near = np.exp(-((np.linalg.norm(offset, axis=1) / 18.0) ** 2))[:, None]
    middle = np.linalg.norm(offset, axis=1).argmin()
    normal = face.skin.normals[correctives.active[middle]]
    out = {}
    for sign in (-1.0, 1.0):
        tangent = offset - (offset @ normal)[:, None] * normal
        moved = correctives.swelling.out(correctives.rest + sign * 0.25 * near * tangent)
        out[sign] = float(moved[middle] @ normal)
    assert out[-1.0] > 0.5
    assert out[1.0] < -0.3


def test_the_best_turn_of_a_rigidly_turned_star_is_the_turn() -> None:
    random = np.random.default_rng(3)
    rest = random.standard_normal((7, 3))
    angle = 0.3
    turn = np.array(
        [[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1.0]]
    )
    moved = rest @ turn.T - rest
    others = np.array([[j for j in range(7) if j != i] for i in range(7)], np.int32)
    starts = np.arange(0, 43, 6, dtype=np.int32)
    turns = np.empty((7, 3, 3))
    best_turns(starts, others.ravel(), np.ones(42), rest, moved, turns)
    np.testing.assert_allclose(turns + np.eye(3), np.broadcast_to(turn, (7, 3, 3)), atol=1e-2)


def test_rotations_and_volume_leave_small_motion_nearly_alone() -> None:
    face = builtin_layered()
    linear = 0.01 * face.fields["zygomaticus_major_l"]
    shaped = face.correctives.shape(linear)
    assert np.abs(shaped - linear).max() < 0.6 * np.abs(linear).max()
