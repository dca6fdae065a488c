from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from risorius.errors import ParameterError, ShapeError
from risorius.rig import MorphTarget, Rig
from tests.synthetic import quad_mesh

MESH = quad_mesh()
RANDOM = np.random.default_rng(7)
LIFT = np.zeros((8, 3))
LIFT[[1, 4]] = ((0.0, 1.0, 0.0), (0.0, 2.0, 0.5))
WIDEN = RANDOM.normal(size=(8, 3))
RIG = Rig(
    MESH,
    (
        MorphTarget.from_dense("lift", LIFT, pose={"levator": 1.0}),
        MorphTarget.from_dense("widen", WIDEN),
    ),
    left_out={"wink": "the face has no lids"},
)


@given(arrays(np.float64, (8, 3), elements=st.sampled_from([0.0, 0.0, -0.0, 1e-150, 1.5, -2e10])))
def test_a_target_made_from_a_dense_field_gives_it_back(deltas: np.ndarray) -> None:
    target = MorphTarget.from_dense("any", deltas)
    np.testing.assert_array_equal(target.dense(8), deltas)


def test_a_target_holds_only_the_vertices_that_move() -> None:
    target = RIG.target("lift")
    assert target.vertices.tolist() == [1, 4]
    assert target.vertices.dtype == np.int32
    np.testing.assert_array_equal(target.deltas, LIFT[[1, 4]])


def test_motion_up_to_the_still_length_is_dropped() -> None:
    assert MorphTarget.from_dense("lift", LIFT, still=1.0).vertices.tolist() == [4]
    assert MorphTarget.from_dense("lift", LIFT, still=0.99).vertices.tolist() == [1, 4]
    assert MorphTarget.from_dense("lift", 1.3 * LIFT, still=1.5).vertices.tolist() == [4]
    assert len(MorphTarget.from_dense("lift", LIFT, still=9.0).vertices) == 0


def test_zero_weights_give_the_neutral_bit_for_bit() -> None:
    for weights in ({}, {"lift": 0.0, "widen": 0.0}):
        assert RIG.posed(weights).tobytes() == MESH.positions.tobytes()


def test_posing_adds_weighted_targets_in_any_order_and_leaves_the_neutral_alone() -> None:
    before = MESH.positions.copy()
    expected = MESH.positions + 0.5 * LIFT - 2.0 * WIDEN
    np.testing.assert_allclose(RIG.posed({"lift": 0.5, "widen": -2.0}), expected, rtol=1e-14)
    np.testing.assert_allclose(RIG.posed({"widen": -2.0, "lift": 0.5}), expected, rtol=1e-14)
    np.testing.assert_array_equal(MESH.positions, before)


def test_names_keep_their_order_and_lead_to_the_targets() -> None:
    assert RIG.names == ("lift", "widen")
    assert RIG.by_name["widen"] is RIG.targets[1]
    assert RIG.target("lift").pose == {"levator": 1.0}


def test_a_subset_keeps_everything_but_the_other_targets() -> None:
    part = RIG.subset(["widen"])
    assert part.names == ("widen",)
    assert part.mesh is MESH
    assert part.left_out == RIG.left_out
    assert RIG.subset(reversed(RIG.names)).names == ("widen", "lift")


@pytest.mark.parametrize("ask", [lambda: RIG.posed({"smile": 1.0}), lambda: RIG.subset(["smile"])])
def test_an_unknown_target_is_refused_with_those_that_exist(ask) -> None:
    with pytest.raises(ParameterError, match="rig: no target 'smile'; it has lift, widen"):
        ask()


def test_two_targets_of_one_name_are_refused() -> None:
    with pytest.raises(ParameterError, match="rig: two targets are named 'lift'"):
        Rig(MESH, (RIG.targets[0], RIG.targets[0]))


def test_a_target_of_a_larger_mesh_is_refused() -> None:
    target = MorphTarget.from_dense("lift", np.ones((9, 3)))
    with pytest.raises(ShapeError, match="target 'lift' moves a vertex that does not exist"):
        Rig(MESH, (target,))


def test_deltas_that_are_not_finite_are_refused_by_row() -> None:
    deltas = LIFT.copy()
    deltas[3, 2] = np.nan
    with pytest.raises(ShapeError, match="target 'lift': deltas: row 3 is"):
        MorphTarget.from_dense("lift", deltas)


@pytest.mark.parametrize("vertices", [(4, 1), (1, 1), (-1, 4)])
def test_vertices_that_do_not_ascend_are_refused(vertices: tuple[int, int]) -> None:
    with pytest.raises(ShapeError, match="target 'lift': vertices must ascend from 0"):
        MorphTarget("lift", np.array(vertices, np.int32), np.zeros((2, 3)))


def test_deltas_that_do_not_match_the_vertices_are_refused() -> None:
    with pytest.raises(ShapeError, match=r"expected deltas of shape \(1, 3\), got \(2, 3\)"):
        MorphTarget("lift", np.array([1], np.int32), np.zeros((2, 3)))
