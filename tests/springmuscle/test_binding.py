"""Skin bound to muscles: the best foot, and never one of the other lip."""

from __future__ import annotations

import numpy as np
import pytest

from risorius.springmuscle.binding import bind_muscle
from risorius.springmuscle.ellipsoid import Ellipsoids
from risorius.springmuscle.muscle_set import MuscleSet
from tests.springmuscle.made_up import fibre, muscle
from tests.springmuscle.skins import builtin_ground, builtin_muscles

UP = (0.0, 0.0, 1.0)


def _strip(radius: float = 8.0) -> MuscleSet:
    points = np.linspace([-20.0, 0, 0], [20.0, 0, 0], 5)
    return MuscleSet((muscle("m", [fibre(points, UP)], radius=radius),))


def _bind(muscles: MuscleSet, points, normals=UP, lips=None, **options):
    points = np.atleast_2d(np.asarray(points, float))
    normals = np.broadcast_to(np.asarray(normals, float), points.shape)
    lips = np.zeros(len(points), np.int8) if lips is None else np.asarray(lips, np.int8)
    return bind_muscle(
        muscles, 0, positions=points, normals=np.ascontiguousarray(normals), lips=lips, **options
    )


def test_a_vertex_above_hangs_on_the_ellipsoid_below_it() -> None:
    found = _bind(_strip(), [[-15.0, 0, 3.0], [5.0, 0, 3.0], [14.0, 0, 3.0]])
    assert found.segments.tolist() == [0, 2, 3]
    assert np.abs(found.distances[[0]] - 2.0).max() < 1e-9
    assert np.abs(found.feet[0] - [0.0, 0.0, 1.0]).max() < 1e-9


def test_only_skin_within_the_radius_and_facing_away_is_bound() -> None:
    points = [[-15.0, 0, 9.1], [-15.0, 0, 8.9], [-15.0, 0, -3.0], [-15.0, 0, 0.2]]
    found = _bind(_strip(), points)
    # Too far; bound; on the other side of the muscle; inside of it.
    assert found.vertices.tolist() == [1]
    assert len(_bind(_strip(radius=3.0), points).vertices) == 0


def test_feet_lie_on_their_ellipsoids_in_local_coordinates() -> None:
    muscles = builtin_muscles()
    ground = builtin_ground()
    surface = ground.surface
    number = [m.name for m in muscles.muscles].index("zygomaticus_major_l")
    found = bind_muscle(
        muscles, number, positions=surface.mesh.positions, normals=surface.normals,
        lips=surface.lips,
    )  # fmt: skip
    assert len(found.vertices) > 100
    assert (muscles.segment_muscle[found.segments] == number).all()
    unit = found.feet / muscles.half_axes[found.segments]
    assert np.abs((unit**2).sum(axis=1) - 1.0).max() < 1e-9
    places = muscles.centres[found.segments] + np.einsum(
        "nij,nj->ni", muscles.frames[found.segments], found.feet
    )
    way = surface.mesh.positions[found.vertices] - places
    assert np.abs(np.linalg.norm(way, axis=1) - found.distances).max() < 1e-9
    closest = Ellipsoids.of(muscles).closest(surface.mesh.positions[found.vertices], found.segments)
    assert np.abs(closest - places).max() < 1e-6
    assert (found.distances <= muscles.muscles[number].action.radius).all()
    assert ((way * surface.normals[found.vertices]).sum(axis=1) > 0.0).all()


def test_dividing_by_the_cosine_prefers_the_foot_below_and_the_product_the_one_beside() -> None:
    """A foot 5 mm below against one 4 mm beside (erratum E5)."""
    below = fibre(np.array([[-3.0, 0, -1.0], [3.0, 0, -1.0]]), UP, width=2.0)
    beside = fibre(np.array([[4.6, -3.0, 4.6], [4.6, 3.0, 4.6]]), UP, width=0.6, height=0.6)
    muscles = MuscleSet((muscle("m", [below, beside], radius=14.0),))
    vertex = [[0.0, 0.0, 5.0]]
    assert _bind(muscles, vertex).segments.tolist() == [0]
    assert _bind(muscles, vertex, weighting="product").segments.tolist() == [1]


@pytest.mark.parametrize("name", ["orbicularis_oris", "orbicularis_oris_funnel"])
def test_closed_lips_bind_to_their_own_half_of_the_ring(name: str) -> None:
    muscles, surface = builtin_muscles(), builtin_ground().surface
    number = [m.name for m in muscles.muscles].index(name)

    def wrong(**options) -> int:
        found = bind_muscle(
            muscles, number, positions=surface.mesh.positions, normals=surface.normals,
            lips=surface.lips, **options,
        )  # fmt: skip
        height = muscles.centres[found.segments, 1]
        line = 0.5 * sum(surface.measure.landmarks[key][1] for key in ("2.2", "2.3"))
        # Cheeks beside the mouth are no lips.
        beside = np.abs(surface.mesh.positions[found.vertices, 0])
        within = beside < surface.measure.landmarks["2.4"][0]
        lips = np.where(within, surface.lips[found.vertices], 0)
        # Clearly below the mouth's line and bound to clearly upper skin, or the other way round.
        return int(
            ((lips > 0) & (height < line - 2.0)).sum() + ((lips < 0) & (height > line + 2.0)).sum()
        )

    assert wrong() == 0
    assert wrong(guard=False, weighting="product") > 50


def test_muscles_of_one_lip_never_take_a_vertex_of_the_other() -> None:
    muscles, surface = builtin_muscles(), builtin_ground().surface
    for number in range(len(muscles.muscles)):
        found = bind_muscle(
            muscles, number, positions=surface.mesh.positions, normals=surface.normals,
            lips=surface.lips,
        )  # fmt: skip
        product = surface.lips[found.vertices] * muscles.lips[found.segments]
        assert (product >= 0).all()
