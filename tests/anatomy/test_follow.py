from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from risorius.anatomy.follow import follow_skin
from risorius.mesh.core import TriMesh
from tests.synthetic import slit_sheet

SKIN = slit_sheet("slit").mesh
BROW = SKIN.positions[[30, 31, 32, 70]] + np.array([0.3, 0.2, 1.5])

shift = st.tuples(*[st.floats(-20.0, 20.0)] * 3)


@given(shift)
def test_what_lies_on_the_skin_goes_along_when_all_of_it_moves(move) -> None:
    moved = follow_skin(BROW, SKIN).displace(np.tile(move, (SKIN.vertex_count, 1)))
    np.testing.assert_allclose(moved, np.tile(move, (len(BROW), 1)), atol=1e-9)


def test_a_point_on_a_vertex_follows_that_vertex() -> None:
    field = np.random.default_rng(3).normal(size=SKIN.positions.shape)
    moved = follow_skin(SKIN.positions[[5, 44]], SKIN).displace(field)
    np.testing.assert_allclose(moved, field[[5, 44]], atol=1e-5)


def test_weights_are_positive_and_add_up_to_one() -> None:
    follower = follow_skin(BROW, SKIN)
    assert follower.weights.min() > 0.0
    np.testing.assert_allclose(follower.weights.sum(axis=1), 1.0)
    nearest = np.linalg.norm(SKIN.positions[None] - BROW[:, None], axis=2).argmin(axis=1)
    np.testing.assert_array_equal(follower.vertices[:, 0], nearest)


def test_only_the_vertices_given_carry() -> None:
    only = np.array([3, 9], np.int32)
    follower = follow_skin(BROW, SKIN, only=only)
    assert set(follower.vertices.ravel()) == {3, 9}


def test_one_neighbour_is_the_nearest_vertex() -> None:
    follower = follow_skin(BROW, SKIN, neighbours=1)
    assert follower.vertices.shape == (4, 1)
    np.testing.assert_array_equal(follower.weights, 1.0)


def test_vertices_that_no_face_uses_carry_nothing() -> None:
    loose = TriMesh(np.concatenate([SKIN.positions, BROW]), SKIN.faces)
    assert follow_skin(BROW, loose).vertices.max() < SKIN.vertex_count
