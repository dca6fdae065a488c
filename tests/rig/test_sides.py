"""Shapes of one side and what they make together."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from risorius.controls.control import Control
from risorius.rig.sides import added, fair_share, other_side
from tests.face_fixtures import builtin_face


def test_the_other_side_of_a_pose_is_its_mirror_image() -> None:
    controls = builtin_face().controls
    pose = {"zygomaticus_major_l": 0.8}
    assert other_side(pose, controls) == {"zygomaticus_major_r": 0.8}


def test_symmetric_contrary_and_excessive_poses_have_no_other_side() -> None:
    controls = builtin_face().controls
    assert other_side({"jaw_pitch": 10.0}, controls) is None
    assert other_side({"jaw_yaw": 3.0}, controls) is None
    assert other_side({"zygomaticus_major_l": 1.0, "orbicularis_oris": 0.7}, controls) is None
    assert other_side({"zygomaticus_major_l": 1.0, "orbicularis_oris": 0.4}, controls) is not None


def test_poses_add_up_control_by_control() -> None:
    assert added({"a": 1.0, "b": 0.5}, {"b": 0.25, "c": 2.0}) == {"a": 1.0, "b": 0.75, "c": 2.0}


@given(st.integers(0, 2**32 - 1))
def test_the_shares_of_both_sides_add_up_to_both(seed: int) -> None:
    own, other, both = np.random.default_rng(seed).normal(size=(3, 20, 3))
    total = fair_share(own, other, both) + fair_share(other, own, both)
    np.testing.assert_allclose(total, both, atol=1e-12)


def test_a_place_that_one_side_alone_moves_keeps_its_motion() -> None:
    own, other = np.zeros((2, 3, 3))
    own[0], other[1] = [1.0, 2.0, 3.0], [4.0, 0.0, 0.0]
    result = fair_share(own, other, own + other)
    np.testing.assert_array_equal(result, own)


def test_a_control_without_a_range_for_both_is_not_played_together() -> None:
    controls = tuple(
        Control(name, 0.0, 1.0, 0.0, "1", "mouth", mirror)
        for name, mirror in (("middle", "middle"), ("x_l", "x_r"), ("x_r", "x_l"))
    )
    assert other_side({"x_l": 1.0, "middle": 0.6}, controls) is None
    assert other_side({"x_l": 1.0, "middle": 0.5}, controls) == {"x_r": 1.0, "middle": 0.5}
