"""A head cloned onto itself keeps its shapes."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from risorius import Head, Rig
from risorius.anatomy.template import builtin_head
from risorius.cloning import Cloning, absolute_error, clone, motion_error
from tests.cloning.rigs import copy_of, dense, self_cloning, source_rig


@pytest.fixture(scope="module")
def clones() -> np.ndarray:
    return self_cloning().carry(dense(source_rig()))


def test_the_error_by_equation_6_1_is_below_a_thousandth_of_a_per_cent(clones: np.ndarray) -> None:
    rest = source_rig().mesh.positions
    for truth, made in zip(dense(source_rig()), clones):
        assert absolute_error(rest, truth, made) < 1e-3
        assert motion_error(truth, made) < 0.1


def test_what_rests_in_the_source_rests_to_the_last_bit(clones: np.ndarray) -> None:
    for truth, made in zip(dense(source_rig()), clones):
        still = ~truth.any(axis=1)
        assert still.any()
        assert (made[still] == 0.0).all()


def test_the_same_input_makes_the_same_bytes(clones: np.ndarray) -> None:
    again = Cloning.build(builtin_head(), builtin_head()).carry(dense(source_rig()))
    assert again.tobytes() == clones.tobytes()


def test_the_target_keeps_its_mesh_and_the_shapes_their_names_and_order() -> None:
    rig = source_rig()
    made = clone(rig, builtin_head())
    assert isinstance(made, Rig)
    assert made.names == rig.names
    assert made.mesh is builtin_head().source
    assert [target.pose for target in made.targets] == [target.pose for target in rig.targets]


@pytest.mark.filterwarnings("ignore:frame. the head is turned", "ignore:unit. eyes")
def test_a_turned_and_enlarged_copy_gets_the_turned_and_enlarged_motion() -> None:
    head = builtin_head()
    turn = Rotation.from_euler("yxz", [20.0, 6.0, -4.0], degrees=True).as_matrix()
    scale, shift = 10.0, np.array([30.0, -400.0, 120.0])
    target: Head = copy_of(head, scale * head.source.positions @ turn.T + shift)
    made = dense(clone(source_rig(), target, source=head))
    for truth, moved in zip(dense(source_rig()), made):
        assert motion_error(scale * truth @ turn.T, moved) < 0.5
