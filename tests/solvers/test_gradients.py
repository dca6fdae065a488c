"""Every gradient is the derivative of its value."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from risorius._check import FloatArray
from risorius.mesh.boundary import boundary_loops
from risorius.mesh.volume import capped_volume
from risorius.solvers import gradients
from tests.mesh.shapes import sphere, star_of, without_faces
from tests.solvers.particles import TETRAHEDRON

COUNT = 100
TARGETS = np.random.default_rng(5).normal(size=(COUNT, 3))
NORMALS = np.random.default_rng(6).normal(size=(COUNT, 3))

# Kind: points of one configuration, value, gradient.
KINDS: dict[str, tuple[tuple[int, ...], Callable[..., FloatArray], Callable[..., FloatArray]]] = {
    "distance": ((2, 3), gradients.distance_value, gradients.distance_gradient),
    "area": ((3, 3), gradients.area_value, gradients.area_gradient),
    "bend": ((4, 3), gradients.bend_value, gradients.bend_gradient),
    "hold": (
        (3,),
        lambda points: gradients.hold_value(points, TARGETS),
        lambda points: gradients.hold_gradient(points, TARGETS),
    ),
    "contact": (
        (3,),
        lambda points: gradients.contact_value(points, TARGETS, NORMALS),
        lambda points: gradients.contact_gradient(points, TARGETS, NORMALS),
    ),
}


def _differences(value: Callable[[FloatArray], FloatArray], points: FloatArray) -> FloatArray:
    """Return central differences of 4th order of many configurations at once."""
    step = 1e-3
    result = np.empty_like(points)
    for entry in np.ndindex(points.shape[1:]):
        place = (slice(None), *entry)

        def at(shift: float, place: tuple[slice | int, ...] = place) -> FloatArray:
            moved = points.copy()
            moved[place] += shift
            return value(moved)

        near, far = at(step) - at(-step), at(2 * step) - at(-2 * step)
        # Angles jump by a turn at pi: the difference is what matters.
        if value is gradients.bend_value:
            near, far = (np.angle(np.exp(1j * part)) for part in (near, far))
        result[place] = (8.0 * near - far) / (12.0 * step)
    return result


def _well_shaped(kind: str, generator: np.random.Generator) -> FloatArray:
    """Draw configurations without slivers, for which finite differences mean something."""
    shape = KINDS[kind][0]
    points = generator.normal(size=(40 * COUNT, *shape))
    if kind in ("area", "bend"):
        flap = points if kind == "bend" else points[:, [0, 1, 2, 2]]
        good = (gradients.area_value(flap[:, :3]) > 0.8) & (
            gradients.area_value(flap[:, [0, 1, 3]]) > 0.8
        )
        points = points[good]
    elif kind == "distance":
        points = points[gradients.distance_value(points) > 0.8]
    elif kind == "hold":
        points = points[: 4 * COUNT].reshape(4, COUNT, 3)
        gaps = np.linalg.norm(points - TARGETS, axis=-1)
        return points[gaps.argmax(axis=0), np.arange(COUNT)]
    return points[:COUNT]


@pytest.mark.parametrize("kind", KINDS)
def test_gradient_is_the_finite_difference_of_the_value(kind: str) -> None:
    points = _well_shaped(kind, np.random.default_rng(1))
    assert len(points) == COUNT
    _, value, gradient = KINDS[kind]
    exact = gradient(points)
    scale = np.abs(exact).max(axis=tuple(range(1, exact.ndim)), keepdims=True)
    assert np.abs((_differences(value, points) - exact) / scale).max() < 1e-7


@pytest.mark.parametrize("kind", ["distance", "area", "bend"])
def test_gradients_of_what_rigid_motion_keeps_sum_to_zero(kind: str) -> None:
    points = _well_shaped(kind, np.random.default_rng(2))
    gradient = KINDS[kind][2](points)
    assert np.abs(gradient.sum(axis=1)).max() < 1e-12
    assert np.abs(np.cross(points, gradient).sum(axis=1)).max() < 1e-11


def test_bending_is_finite_and_right_where_exactly_flat() -> None:
    flat = np.array([[(0, 0, 0), (1, 0, 0), (0.4, 1, 0), (0.6, -2, 0)]], float)
    assert gradients.bend_value(flat)[0] == 0.0
    gradient = gradients.bend_gradient(flat)
    # The far corners turn about the edge: one over their distance from it.
    np.testing.assert_allclose(np.linalg.norm(gradient[0, 2:], axis=1), [1.0, 0.5], rtol=1e-15)
    assert np.abs(_differences(gradients.bend_value, flat) - gradient).max() < 1e-7


def test_a_bump_and_the_mirrored_dent_have_opposite_angles() -> None:
    bump = np.array([(0, 0, 0), (1, 0, 0), (0.4, 1, -0.3), (0.6, -1, -0.3)], float)
    angle = gradients.bend_value(bump)
    assert 0.1 < abs(angle) < 1.0
    assert gradients.bend_value(bump * (1, 1, -1)) == pytest.approx(-angle, rel=1e-14)


def test_degenerate_configurations_have_gradient_zero_not_nan() -> None:
    assert (gradients.distance_gradient(np.zeros((1, 2, 3))) == 0.0).all()
    assert (gradients.area_gradient(np.zeros((1, 3, 3))) == 0.0).all()
    assert (gradients.bend_gradient(np.zeros((1, 4, 3))) == 0.0).all()


@pytest.mark.parametrize("is_open", [False, True])
def test_volume_gradient_is_the_finite_difference_of_the_volume(is_open: bool) -> None:
    mesh = sphere(1)
    if is_open:
        mesh = without_faces(mesh, star_of(mesh, 20))
    generator = np.random.default_rng(3)
    positions = mesh.positions + 0.1 * generator.normal(size=mesh.positions.shape)
    holes = tuple(boundary_loops(mesh.faces))
    assert len(holes) == is_open
    exact = gradients.volume_gradient(positions, mesh.faces, holes=holes)
    step = 1e-4
    found = np.empty_like(exact)
    for entry in np.ndindex(exact.shape):
        up, down = positions.copy(), positions.copy()
        up[entry] += step
        down[entry] -= step
        found[entry] = (
            gradients.volume_value(up, mesh.faces, holes=holes)
            - gradients.volume_value(down, mesh.faces, holes=holes)
        ) / (2 * step)
    assert np.abs(found - exact).max() < 1e-7 * np.abs(exact).max()


def test_volume_is_the_one_of_the_mesh_station_wherever_the_origin_is() -> None:
    mesh = without_faces(sphere(2), star_of(sphere(2), 5))
    holes = tuple(boundary_loops(mesh.faces))
    wanted = capped_volume(mesh.positions, mesh.faces)
    for shift in ((0, 0, 0), (5, -3, 8)):
        found = gradients.volume_value(mesh.positions + shift, mesh.faces, holes=holes)
        assert found == pytest.approx(wanted, rel=1e-12)


def test_volume_of_a_corner_tetrahedron_is_a_sixth() -> None:
    points = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], float)
    assert gradients.volume_value(points, TETRAHEDRON) == pytest.approx(1.0 / 6.0, rel=1e-15)
