"""Acceptance of the vector muscles: specification vector-muscles.md section 7, items 1-6.

Item 5, speed, stands in benchmarks/test_vector_muscles.py: tests do not assert on time.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from risorius.controls import mirrored
from risorius.vectormuscle import default_vector_set
from risorius.vectormuscle.combine import combine
from risorius.vectormuscle.kinds import LinearMuscle
from risorius.vectormuscle.profile import fold_limit, radial_factor
from risorius.vectormuscle.wrinkle import BoundWrinkles, Wrinkles, bind_wrinkles, raise_wrinkles
from tests.face_fixtures import builtin_face, mirror_vertices
from tests.vectormuscle.patches import context, linear, local_maxima, move_by, patch

FACE = builtin_face()
SKIN = FACE.head.skin
LIPS = FACE.mechanics.lips
LINEAR = [muscle for muscle in FACE.vectors.muscles if isinstance(muscle, LinearMuscle)]
NAMES = [muscle.name for muscle in FACE.vectors.muscles]


def _skin(pose: dict[str, float]) -> np.ndarray:
    return FACE.displace(pose)[SKIN.first_source()]


@pytest.mark.parametrize("muscle", LINEAR, ids=lambda muscle: muscle.name)
def test_1_the_profile_is_0_1_0_at_the_origin_the_start_and_the_finish(muscle) -> None:
    start, finish = muscle.start_radius, muscle.finish_radius
    values = radial_factor([0.0, start, finish], start_radius=start, finish_radius=finish)
    np.testing.assert_allclose(values, [0.0, 1.0, 0.0], atol=1e-12)


@pytest.mark.parametrize("muscle", LINEAR, ids=lambda muscle: muscle.name)
def test_1_the_effect_does_not_jump_at_any_border_of_the_zone(muscle) -> None:
    random = np.random.default_rng(7)
    direction = random.normal(size=(4000, 3))
    direction /= np.linalg.norm(direction, axis=1, keepdims=True)
    # Points on the borders: the origin, both radii, the rim of the cone and its inside.
    radius = np.concatenate(
        [
            np.full(1000, 1e-7),
            np.full(1000, muscle.start_radius),
            np.full(1000, muscle.finish_radius),
            random.uniform(0.0, 1.1 * muscle.finish_radius, 1000),
        ]
    )
    axis = (muscle.insertion - muscle.origin) / np.linalg.norm(muscle.insertion - muscle.origin)
    side = direction - (direction @ axis)[:, None] * axis
    side /= np.linalg.norm(side, axis=1, keepdims=True)
    angle = np.radians(muscle.half_angle) * random.choice([0.0, 0.5, 1.0], 4000)
    spoke = np.cos(angle)[:, None] * axis + np.sin(angle)[:, None] * side
    points = muscle.origin + radius[:, None] * spoke
    step = 1e-6 * direction
    jump = np.abs(muscle.influence(points + step) - muscle.influence(points))
    # At the origin itself the angle is undefined; there the effect is as small as the distance.
    assert jump.max() < 1e-6


def test_1_the_published_profile_does_jump_at_the_side() -> None:
    muscle = linear()
    rim = np.radians(muscle.half_angle) + np.array([-1e-8, 1e-8])
    points = 30.0 * np.stack([np.sin(rim), -np.cos(rim), np.zeros(2)], axis=1)
    inside, outside = muscle.influence(points, smooth=False)
    assert inside - outside > 0.8
    assert np.ptp(muscle.influence(points)) < 1e-6


def test_2_points_come_closer_to_the_origin_the_more_the_muscle_contracts() -> None:
    mesh = patch(bulge=0.002)
    distance = [
        np.linalg.norm(mesh.positions + move_by(linear(), mesh, share), axis=1)
        for share in np.linspace(0.0, 1.0, 6)
    ]
    assert (np.diff(distance, axis=0) <= 1e-12).all()


@pytest.mark.parametrize("name", [muscle.name for muscle in LINEAR])
def test_2_nothing_outside_the_zone_moves(name: str) -> None:
    muscle = next(m for m in LINEAR if m.name == name)
    moved = _skin({name: 1.0})
    outside = muscle.influence(SKIN.mesh.positions) == 0.0
    assert outside.sum() > 1000
    np.testing.assert_array_equal(moved[outside], 0.0)


@pytest.mark.parametrize("strength", [1.0, 1.5])
def test_2_at_full_pull_points_keep_their_order(strength: float) -> None:
    muscle = linear(strength=strength)
    assert muscle.pull < fold_limit(start_radius=30.0, finish_radius=50.0)
    line = np.stack([np.zeros(500), -np.linspace(0.0, 60.0, 500), np.zeros(500)], axis=1)
    moved = line[:, 1] + muscle.pull * muscle.influence(line)
    assert (np.diff(moved) < 0.0).all()


LOWER = [
    muscle.name for muscle in FACE.vectors.muscles if getattr(muscle, "regions", ()) == ("lower",)
]


@pytest.mark.parametrize("name", [*LOWER, "orbicularis_oris_lower"])
def test_3_lower_muscles_leave_the_upper_lip_bit_identical(name: str) -> None:
    assert len(LOWER) >= 4
    posed = FACE.pose({name: 1.0})[SKIN.first_source()]
    rest = FACE.head.positions[SKIN.first_source()]
    upper = LIPS.upper & (LIPS.distance < LIPS.width)
    assert upper.sum() > 200
    np.testing.assert_array_equal(posed[upper], rest[upper])
    assert np.abs(posed - rest).max() > 1.0


def test_4_two_muscles_give_the_same_in_either_order() -> None:
    mesh = patch(bulge=0.002)
    pair = (
        linear(origin=np.array([9.0, 0.0, 0.0])),
        linear(origin=np.array([-4.0, -2.0, 1.0]), half_angle=50.0),
    )
    bound = [(muscle.bind(context(mesh)), share) for muscle, share in zip(pair, (1.0, 0.7))]
    forward = combine(bound, mesh.positions)
    backward = combine(bound[::-1], mesh.positions)
    np.testing.assert_allclose(backward, forward, rtol=0.0, atol=1e-12)


def test_4_a_symmetric_pair_gives_a_symmetric_result() -> None:
    partner = mirror_vertices(SKIN.mesh.positions)
    pose = dict.fromkeys(["zygomaticus_major_l", "zygomaticus_major_r", "corrugator_l"], 0.8)
    pose |= {"corrugator_r": 0.8}
    assert mirrored(pose) == pose
    moved = _skin(pose)
    np.testing.assert_allclose(moved[partner] * [-1.0, 1.0, 1.0], moved, atol=1e-9)


def test_4_overlapping_muscles_stay_below_their_sum() -> None:
    mesh = patch()
    pair = [linear(origin=np.array([x, 0.0, 0.0])).bind(context(mesh)) for x in (8.0, -8.0)]
    both = combine([(muscle, 1.0) for muscle in pair], mesh.positions)
    single = [combine([(muscle, 1.0)], mesh.positions) for muscle in pair]
    length = np.linalg.norm(both, axis=1)
    overlap = np.all([np.linalg.norm(one, axis=1) > 0.5 for one in single], axis=0)
    assert overlap.sum() > 100
    total = sum(np.linalg.norm(one, axis=1) for one in single)
    assert (length <= total + 1e-9).all()
    assert (length[overlap] < 0.95 * total[overlap]).all()


@pytest.mark.parametrize("name", ["frontalis_inner_l", "frontalis_outer_l"])
@pytest.mark.parametrize("count", [3, 4])
def test_6_frontalis_wrinkles_a_fine_forehead_and_leaves_it_smooth_at_rest(name, count) -> None:
    frontalis = next(m for m in default_vector_set().muscles if m.name == name)
    frontalis = replace(frontalis, wrinkles=Wrinkles(count=count))
    # A forehead under the muscle: half a millimetre between vertices, curved like a skull.
    mesh = patch(81, 241, step=0.5, bulge=0.004)
    forehead = mesh.positions + frontalis.origin * [1.0, 1.0, 0.0] + np.array([0.0, 20.0, 90.0])
    seen = context(type(mesh)(forehead, mesh.faces))
    bound = bind_wrinkles(frontalis, frontalis.wrinkles, seen, faces=mesh.faces)
    assert isinstance(bound, BoundWrinkles)
    pulled = combine([(frontalis.bind(seen), 1.0)], forehead)
    raised = raise_wrinkles([(bound, 1.0)], len(forehead))
    assert raised is not None
    middle = np.isclose(mesh.positions[:, 0], 0.0)
    height = ((pulled + raised) * seen.normals).sum(axis=1)[middle]
    assert local_maxima(height.round(9)) == count
    assert raise_wrinkles([(bound, 0.0)], len(forehead)) is None
    at_rest = combine([(frontalis.bind(seen), 0.0)], forehead)
    np.testing.assert_array_equal(at_rest, 0.0)
