"""Laplacians, smooth fields, harmonic fills."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from risorius.errors import MeshError, ParameterError, ShapeError
from risorius.mesh.core import TriMesh
from risorius.mesh.laplacian import (
    SmoothField,
    cotangent_laplacian,
    harmonic,
    mass,
    smooth,
    uniform_laplacian,
)
from tests.mesh.shapes import cube, grid, joined, rotation, sphere, torus, triangle_soups


def test_laplacian_of_a_right_triangle_by_hand():
    # Angles 90, 45, 45 degrees: half cotangents 0, 1/2, 1/2 on the sides facing them.
    points = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], float)
    expected = [[1.0, -0.5, -0.5], [-0.5, 0.5, 0.0], [-0.5, 0.0, 0.5]]
    matrix = cotangent_laplacian(points, np.array([[0, 1, 2]])).toarray()
    np.testing.assert_allclose(matrix, expected, atol=1e-15)


@given(triangle_soups(), st.floats(0.0, 1.0))
def test_laplacian_is_symmetric_semidefinite_and_kills_constants(mesh: TriMesh, flat: float):
    points = mesh.positions * [1.0, flat, flat**3]
    points[0] = points[1]
    matrix = cotangent_laplacian(points, mesh.faces).toarray()
    size = max(np.abs(matrix).max(), 1.0)
    np.testing.assert_allclose(matrix, matrix.T, atol=1e-14 * size)
    np.testing.assert_allclose(matrix.sum(axis=1), 0.0, atol=1e-12 * size)
    assert np.linalg.eigvalsh(matrix).min() > -1e-12 * size


def test_linear_functions_are_harmonic_inside_a_sheet():
    mesh = grid(8, 6, width=2.0)
    points = mesh.positions.copy()
    points[:, :2] += 0.03 * np.random.default_rng(0).normal(size=(len(points), 2))
    inner = (mesh.positions[:, :2] > 1e-9).all(axis=1)
    inner &= (mesh.positions[:, 0] < 2 - 1e-9) & (mesh.positions[:, 1] < 1 - 1e-9)
    product = cotangent_laplacian(points, mesh.faces) @ (points @ [2.0, -3.0, 0.0])
    np.testing.assert_allclose(product[inner], 0.0, atol=1e-12)


def test_dirichlet_energy_is_that_of_the_gradient():
    mesh = grid(9, 5, width=3.0, height=2.0)
    u = mesh.positions @ [1.5, 2.0, 0.0]
    energy = u @ (cotangent_laplacian(mesh.positions, mesh.faces) @ u)
    assert energy == pytest.approx((1.5**2 + 2.0**2) * 6.0)


def test_energy_of_the_coordinates_is_twice_the_area():
    mesh = torus()
    points = mesh.positions + 0.1 * np.random.default_rng(0).normal(size=mesh.positions.shape)
    energy = np.einsum("ij,ij->", points, cotangent_laplacian(points, mesh.faces) @ points)
    assert energy == pytest.approx(2.0 * mass(points, mesh.faces).sum(), rel=1e-12)


def test_second_harmonics_of_the_sphere_approach_eigenvalue_six():
    errors: list[float] = []
    for levels in (2, 3, 4):
        mesh = sphere(levels)
        u = mesh.positions[:, 0] * mesh.positions[:, 1]
        bent = cotangent_laplacian(mesh.positions, mesh.faces) @ u
        weight = mass(mesh.positions, mesh.faces) * u
        errors.append(abs(float(u @ bent) / float(u @ weight) - 6.0))
    assert errors[2] < 0.02
    assert errors[0] / errors[1] > 3.0
    assert errors[1] / errors[2] > 3.0


def test_laplacian_does_not_change_with_place_turn_and_scale():
    mesh = torus(8, 6)
    moved = 7.0 * mesh.positions @ rotation(np.random.default_rng(0)).T + 100.0
    np.testing.assert_allclose(
        cotangent_laplacian(moved, mesh.faces).toarray(),
        cotangent_laplacian(mesh.positions, mesh.faces).toarray(),
        atol=1e-11,
    )


def test_a_sliver_cannot_dominate():
    points = np.array([[0, 0, 0], [1, 0, 0], [0.5, 1e-9, 0], [0.5, -1, 0]], float)
    matrix = cotangent_laplacian(points, np.array([[0, 1, 2], [1, 0, 3]]))
    assert np.isfinite(matrix.toarray()).all()
    assert np.abs(matrix.toarray()).max() < 200.0


def test_graph_laplacian_counts_neighbours():
    mesh = cube()
    matrix = uniform_laplacian(mesh.faces, 9).toarray()
    assert matrix[8].tolist() == [0.0] * 9
    np.testing.assert_array_equal(matrix.sum(axis=1), 0.0)
    assert set(matrix[:8, :8][~np.eye(8, dtype=bool)]) == {0.0, -1.0}
    assert matrix.trace() == 2 * 18


def test_masses_are_positive_where_a_face_is():
    points = np.vstack([grid(1, 1).positions, [[5, 5, 5], [0.5, 0, 0]]])
    faces = np.vstack([grid(1, 1).faces, [[0, 5, 1]]])
    areas = mass(points, faces)
    assert areas[4] == 0.0
    assert areas[5] > 0.0
    assert areas.sum() == pytest.approx(1.0, rel=1e-5)


# Smooth fields


def test_constant_targets_give_the_constant():
    mesh = sphere(3, radius=90.0)
    stiffness = np.random.default_rng(0).random(mesh.vertex_count)
    field = SmoothField(mesh, stiffness, length=20.0, bend=10.0)
    np.testing.assert_allclose(field.solve(np.full(mesh.vertex_count, 3.0)), 3.0, rtol=1e-10)


def test_field_solves_its_equation():
    mesh = torus()
    generator = np.random.default_rng(0)
    k, t = generator.random(mesh.vertex_count), generator.normal(size=(mesh.vertex_count, 3))
    u = SmoothField(mesh, k, length=0.7, bend=0.4).solve(t)
    matrix = cotangent_laplacian(mesh.positions, mesh.faces).toarray()
    m = mass(mesh.positions, mesh.faces)
    left = np.diag(m * k) + 0.7**2 * matrix + 0.4**4 * matrix @ np.diag(1 / m) @ matrix
    np.testing.assert_allclose(left @ u, (m * k)[:, None] * t, atol=1e-12)


def test_field_minimises_its_energy():
    mesh = torus(8, 6)
    generator = np.random.default_rng(0)
    k, t = generator.random(mesh.vertex_count), generator.normal(size=mesh.vertex_count)
    u = SmoothField(mesh, k, length=0.7, bend=0.4).solve(t)
    matrix = cotangent_laplacian(mesh.positions, mesh.faces)
    m = mass(mesh.positions, mesh.faces)

    def energy(field: np.ndarray) -> float:
        bent = matrix @ field
        follow = (k * m * (field - t) ** 2).sum()
        return follow + 0.7**2 * field @ bent + 0.4**4 * (bent**2 / m).sum()

    for _ in range(5):
        step = 1e-3 * generator.normal(size=len(u))
        assert energy(u + step) > energy(u)
        assert energy(u + step) - energy(u) == pytest.approx(energy(u - step) - energy(u), rel=1e-6)


def test_several_targets_at_once_equal_each_for_itself():
    mesh = sphere(2)
    generator = np.random.default_rng(0)
    field = SmoothField(mesh, generator.random(mesh.vertex_count), length=0.3)
    t = generator.normal(size=(mesh.vertex_count, 4))
    together = field.solve(t)
    for column in range(4):
        np.testing.assert_allclose(together[:, column], field.solve(t[:, column]), atol=1e-13)


def test_step_spreads_over_the_given_length():
    # On a long strip held by k = 1 the field of a step is exp(-|x| / length) / 2 either side.
    mesh = grid(400, 1, width=40.0, height=0.1)
    x = mesh.positions[:, 0] - 20.0
    u = SmoothField(mesh, np.ones(len(x)), length=2.0).solve(np.sign(x))
    expected = np.sign(x) * (1.0 - np.exp(-np.abs(x) / 2.0))
    np.testing.assert_allclose(u, expected, atol=2e-3)


def test_without_length_the_field_is_its_targets():
    mesh = sphere(1)
    k = np.ones(mesh.vertex_count)
    k[3] = 0.0
    t = np.random.default_rng(0).normal(size=mesh.vertex_count)
    u = SmoothField(mesh, k, length=0.0).solve(t)
    np.testing.assert_allclose(np.delete(u, 3), np.delete(t, 3), rtol=1e-12)
    assert u[3] == 0.0


def test_pieces_without_stiffness_and_loose_vertices_are_handled():
    mesh = joined(sphere(1), cube(), TriMesh(np.ones((2, 3)), np.zeros((0, 3), np.int32)))
    n = mesh.vertex_count
    k = np.zeros(n)
    k[0], k[n - 1] = 1.0, 1.0
    u = SmoothField(mesh, k, length=1.0, bend=1.0).solve(np.full(n, 5.0))
    np.testing.assert_allclose(u[:42], 5.0, rtol=1e-9)
    np.testing.assert_array_equal(u[42:50], 0.0)
    assert u[n - 2 :].tolist() == [0.0, 5.0]


def test_field_turns_with_the_mesh_and_scales_with_lengths():
    mesh = torus(8, 6)
    generator = np.random.default_rng(0)
    k, t = generator.random(mesh.vertex_count), generator.normal(size=mesh.vertex_count)
    moved = mesh.at(1000.0 * mesh.positions @ rotation(generator).T + 5.0)
    np.testing.assert_allclose(
        SmoothField(moved, k, length=700.0, bend=400.0).solve(t),
        SmoothField(mesh, k, length=0.7, bend=0.4).solve(t),
        atol=1e-10,
    )


@pytest.mark.parametrize("bad", [-1.0, np.nan])
def test_bad_stiffness_is_refused(bad: float):
    k = np.ones(8)
    k[5] = bad
    with pytest.raises(ParameterError, match=r"stiffness: entry 5 is .* at least 0"):
        SmoothField(cube(), k, length=1.0)


def test_wrong_shapes_are_refused():
    with pytest.raises(ShapeError, match=r"stiffness: expected shape \(8,\)"):
        SmoothField(cube(), np.ones(7), length=1.0)
    with pytest.raises(ShapeError, match=r"targets: expected shape \(8,\) or \(8, d\)"):
        SmoothField(cube(), np.ones(8), length=1.0).solve(np.ones(7))


# Harmonic fills


def test_harmonic_fill_reproduces_linear_functions():
    mesh = grid(6, 5)
    rim = np.flatnonzero(
        ((mesh.positions[:, :2] < 1e-9) | (mesh.positions[:, :2] > 1 - 1e-9)).any(axis=1)
    )
    u = np.stack([mesh.positions @ [1, 2, 0], mesh.positions @ [-3, 1, 0]], axis=1)
    np.testing.assert_allclose(harmonic(mesh, rim, u[rim]), u, atol=1e-12)


@given(st.integers(0, 2**32 - 1))
def test_harmonic_fill_stays_between_the_fixed_values(seed: int):
    generator = np.random.default_rng(seed)
    mesh = torus(10, 6)
    rough = mesh.at(mesh.positions + 0.4 * generator.normal(size=mesh.positions.shape))
    fixed = generator.choice(mesh.vertex_count, 5, replace=False)
    values = generator.normal(size=5)
    u = harmonic(rough, fixed, values)
    np.testing.assert_array_equal(u[fixed], values)
    assert u.min() >= values.min() - 1e-9
    assert u.max() <= values.max() + 1e-9


def test_harmonic_fill_needs_a_value_in_every_piece():
    mesh = joined(cube(), sphere(0))
    with pytest.raises(MeshError, match="the piece of vertex 8 holds no fixed vertex"):
        harmonic(mesh, [0, 1], [1.0, 2.0])
    with pytest.raises(ParameterError, match="a vertex is listed twice"):
        harmonic(cube(), [0, 0], [1.0, 2.0])
    with pytest.raises(ShapeError, match="expected 2 rows"):
        harmonic(cube(), [0, 1], [1.0])


# Averaging


def test_averaging_by_hand():
    faces = np.array([[0, 1, 2]], np.int32)
    np.testing.assert_allclose(smooth([0.0, 3.0, 6.0, 9.0], faces, 1), [3.0, 3.0, 3.0, 9.0])


def test_averaging_keeps_constants_and_calms_noise():
    mesh = sphere(3)
    np.testing.assert_allclose(smooth(np.full(mesh.vertex_count, 2.0), mesh.faces, 7), 2.0)
    noise = np.random.default_rng(0).normal(size=mesh.vertex_count)
    spread = [float(smooth(noise, mesh.faces, passes).std()) for passes in (0, 1, 5, 20)]
    assert spread == sorted(spread, reverse=True)
    np.testing.assert_array_equal(smooth(noise, mesh.faces, 0), noise)
