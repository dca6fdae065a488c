from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from risorius.vectormuscle.combine import combine
from risorius.vectormuscle.reference import combine_reference, effect_reference
from tests.vectormuscle.patches import context, linear, patch

MESH = patch(21, 31, step=2.0, bulge=0.004)
SEEN = context(MESH, lower=MESH.positions[:, 1] < -30.0, support=0.7)
MUSCLES = (
    linear(name="a_l", origin=np.array([8.0, 0.0, -4.0]), out=0.2),
    linear(name="a_r", origin=np.array([-8.0, 0.0, -4.0]), out=0.2),
    linear(name="b", insertion=np.array([5.0, -20.0, 0.0]), half_angle=50.0),
    linear(name="c", origin=np.array([0.0, -58.0, 0.0]), insertion=np.array([0.0, -30.0, 0.0])),
    linear(name="d", origin=np.array([19.0, -30.0, 2.0]), regions=("lower",)),
)
BOUND = [muscle.bind(SEEN) for muscle in MUSCLES]

contractions = st.lists(st.floats(0.0, 1.0), min_size=5, max_size=5)


def test_nothing_contracted_moves_nothing() -> None:
    np.testing.assert_array_equal(combine([(b, 0.0) for b in BOUND], MESH.positions), 0.0)
    np.testing.assert_array_equal(combine([], MESH.positions), 0.0)


@given(contractions, st.permutations(range(5)))
def test_the_order_of_the_muscles_does_not_matter_to_the_last_bit(shares, order) -> None:
    pairs = list(zip(BOUND, shares))
    shuffled = [pairs[k] for k in order]
    np.testing.assert_array_equal(combine(shuffled, MESH.positions), combine(pairs, MESH.positions))


def test_one_muscle_is_its_own_law_in_the_limit_of_small_steps() -> None:
    bound = BOUND[2]
    law = np.zeros_like(MESH.positions)
    law[bound.vertices] = bound.displace(MESH.positions[bound.vertices], 0.01)
    np.testing.assert_allclose(combine([(bound, 0.01)], MESH.positions), law, atol=1e-5)
    one_step = combine([(bound, 1.0)], MESH.positions, steps=1)
    np.testing.assert_array_equal(
        one_step[bound.vertices], bound.displace(MESH.positions[bound.vertices], 1.0)
    )


def test_smaller_steps_converge() -> None:
    pairs = [(bound, 1.0) for bound in BOUND]
    fine = combine(pairs, MESH.positions, steps=256)
    errors = [np.abs(combine(pairs, MESH.positions, steps=m) - fine).max() for m in (2, 8, 32)]
    assert errors[1] < 0.5 * errors[0]
    assert errors[2] < 0.5 * errors[1]


@given(contractions)
def test_no_more_than_the_strongest_muscle_pulls_in_any_pulled_direction(shares) -> None:
    pairs = list(zip(BOUND, shares))
    total = combine(pairs, MESH.positions, steps=1)
    single = [combine([pair], MESH.positions, steps=1) for pair in pairs]
    for field in single:
        length = np.linalg.norm(field, axis=1)
        moved = length > 0.0
        unit = field[moved] / length[moved, None]
        most = np.max([(other[moved] * unit).sum(axis=1) for other in single], axis=0)
        assert ((total[moved] * unit).sum(axis=1) <= most + 1e-12).all()


def test_the_same_muscle_twice_pulls_once() -> None:
    once = combine([(BOUND[0], 0.7)], MESH.positions)
    twice = combine([(BOUND[0], 0.7), (BOUND[0], 0.7)], MESH.positions)
    np.testing.assert_allclose(twice, once, atol=1e-12)


def test_far_muscles_do_not_know_of_each_other() -> None:
    wide = patch(61, 31, step=2.0)
    seen = context(wide)
    left, right = (
        linear(origin=np.array([x, 0.0, 0.0]), insertion=np.array([x, -30.0, 0.0])).bind(seen)
        for x in (40.0, -40.0)
    )
    assert not np.intersect1d(left.vertices, right.vertices).size
    both = combine([(left, 1.0), (right, 0.5)], wide.positions)
    apart = combine([(left, 1.0)], wide.positions) + combine([(right, 0.5)], wide.positions)
    np.testing.assert_array_equal(both, apart)


@given(contractions)
def test_the_fast_path_is_the_loop(shares) -> None:
    small = patch(7, 9, step=6.0, bulge=0.004)
    seen = context(small, lower=small.positions[:, 1] < -30.0, support=0.7)
    pairs = list(zip(MUSCLES, shares))
    fast = combine([(muscle.bind(seen), share) for muscle, share in pairs], small.positions)
    np.testing.assert_allclose(combine_reference(pairs, seen), fast, atol=1e-12)


def test_the_fast_path_is_the_loop_in_the_published_profile_too() -> None:
    seen = context(MESH, angular="published")
    pairs = [(muscle, 0.8) for muscle in MUSCLES]
    fast = combine([(muscle.bind(seen), share) for muscle, share in pairs], MESH.positions)
    assert np.abs(fast).max() > 3.0
    np.testing.assert_allclose(combine_reference(pairs, seen), fast, atol=1e-12)


def test_the_effect_is_the_loops_at_every_vertex() -> None:
    for muscle in MUSCLES:
        for smooth in (True, False):
            loop = [effect_reference(muscle, p, smooth=smooth) for p in MESH.positions.tolist()]
            fast = muscle.influence(MESH.positions, smooth=smooth)
            np.testing.assert_allclose(fast, loop, atol=1e-13)
