"""Normals and areas."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from risorius.errors import ParameterError
from risorius.mesh.core import TriMesh
from risorius.mesh.normals import (
    NormalsOperator,
    face_areas,
    face_normals,
    vertex_areas,
    vertex_normals,
)
from tests.mesh.shapes import cube, grid, rotation, sphere, torus, triangle_soups

WEIGHTINGS = ("angle", "area", "uniform")


@pytest.mark.parametrize("weighting", WEIGHTINGS)
def test_normals_of_a_sphere_point_away_from_its_centre(weighting: str):
    mesh = sphere(4, radius=90.0)
    normals = vertex_normals(mesh.positions, mesh.faces, weighting=weighting)
    cosine = np.einsum("ij,ij->i", normals, mesh.positions) / 90.0
    assert cosine.min() > 0.999


def test_corner_normals_of_a_cube_do_not_depend_on_its_diagonals():
    normals = vertex_normals(cube().positions, cube().faces, weighting="angle")
    expected = (2.0 * cube().positions - 1.0) / np.sqrt(3.0)
    np.testing.assert_allclose(normals, expected, atol=1e-15)
    uniform = vertex_normals(cube().positions, cube().faces, weighting="uniform")
    assert np.abs(uniform - expected).max() > 0.1


def test_weightings_follow_their_formulas():
    # Three faces around vertex 0, of different area and angle.
    points = np.array([[0, 0, 0], [2, 0, 0], [0, 1, 0], [0, 0, 3], [2, 1, 0]], float)
    faces = np.array([[0, 1, 4], [0, 4, 2], [0, 2, 3]], np.int32)
    units = np.array([[0, 0, 1], [0, 0, 1], [1, 0, 0]], float)
    beta = np.arctan2(1, 2)
    weights = {
        "area": (1.0, 1.0, 1.5),
        "uniform": (1, 1, 1),
        "angle": (beta, np.pi / 2 - beta, np.pi / 2),
    }
    for weighting in WEIGHTINGS:
        total = np.array(weights[weighting]) @ units
        normal = vertex_normals(points, faces, weighting=weighting)[0]
        np.testing.assert_allclose(normal, total / np.linalg.norm(total), atol=1e-15)


@given(st.integers(0, 2**32 - 1), st.floats(1e-3, 1e3), st.sampled_from(WEIGHTINGS))
def test_normals_turn_with_the_mesh_and_ignore_scale_and_place(seed: int, scale: float, w: str):
    generator = np.random.default_rng(seed)
    turn = rotation(generator)
    mesh = torus(9, 7)
    points = mesh.positions + 0.1 * generator.normal(size=mesh.positions.shape)
    normals = vertex_normals(points, mesh.faces, weighting=w)
    moved = scale * points @ turn.T + scale * generator.normal(size=3)
    np.testing.assert_allclose(
        vertex_normals(moved, mesh.faces, weighting=w), normals @ turn.T, atol=1e-10
    )


def test_turning_the_faces_turns_the_normals():
    mesh = torus()
    normals = vertex_normals(mesh.positions, mesh.faces)
    np.testing.assert_allclose(
        vertex_normals(mesh.positions, mesh.faces[:, [0, 2, 1]]), -normals, atol=1e-14
    )


@given(triangle_soups(), st.sampled_from(WEIGHTINGS))
def test_normals_are_unit_or_zero_whatever_the_mesh(mesh: TriMesh, weighting: str):
    points = mesh.positions.copy()
    points[0] = points[-1]
    length = np.linalg.norm(vertex_normals(points, mesh.faces, weighting=weighting), axis=1)
    assert (np.isclose(length, 1.0) | (length == 0.0)).all()
    faces = np.linalg.norm(face_normals(points, mesh.faces), axis=1)
    assert (np.isclose(faces, 1.0) | (faces == 0.0)).all()


@pytest.mark.parametrize("unit", [1e-60, 1e60])
def test_extreme_units_keep_their_directions(unit: float):
    mesh = sphere(1)
    expected = vertex_normals(mesh.positions, mesh.faces)
    np.testing.assert_allclose(
        vertex_normals(unit * mesh.positions, mesh.faces), expected, atol=1e-12
    )


def test_unused_vertices_have_no_normal():
    mesh = TriMesh(np.vstack([grid(2, 2).positions, [[5, 5, 5]]]), grid(2, 2).faces)
    normals = vertex_normals(mesh.positions, mesh.faces)
    np.testing.assert_array_equal(normals[-1], 0.0)
    np.testing.assert_allclose(normals[:-1], [[0, 0, 1]] * 9)


@pytest.mark.parametrize("weighting", WEIGHTINGS)
def test_updated_normals_equal_the_whole_computation_bit_by_bit(weighting: str):
    mesh = torus()
    generator = np.random.default_rng(1)
    operator = NormalsOperator(mesh.faces, mesh.vertex_count, weighting=weighting)
    before = operator(mesh.positions)
    moved = np.array([3, 40, 41, 100], np.int32)
    points = mesh.positions.copy()
    points[moved] += 0.2 * generator.normal(size=(4, 3))
    whole = operator(points)
    assert np.abs(whole - before).max() > 0.01
    np.testing.assert_array_equal(operator.update(before, points, moved), whole)
    mask = np.zeros(mesh.vertex_count, bool)
    mask[moved] = True
    np.testing.assert_array_equal(operator.update(before, points, mask), whole)
    np.testing.assert_array_equal(operator.update(before, mesh.positions, moved[:0]), before)


def test_several_shapes_at_once_equal_each_for_itself():
    mesh = sphere(2)
    shapes = np.stack([mesh.positions, mesh.positions * [1, 2, 3]])
    operator = NormalsOperator(mesh.faces, mesh.vertex_count)
    both = operator(shapes)
    np.testing.assert_array_equal(both[1], operator(shapes[1]))
    assert operator(shapes[:0]).shape == (0, mesh.vertex_count, 3)


def test_areas_add_up():
    mesh = grid(7, 3, width=2.0, height=0.5)
    assert face_areas(mesh.positions, mesh.faces).sum() == pytest.approx(1.0)
    areas = vertex_areas(mesh.positions, mesh.faces)
    assert areas.sum() == pytest.approx(1.0)
    inner = 9
    assert areas[inner] == pytest.approx(1.0 / 21)
    ball = sphere(4)
    assert face_areas(ball.positions, ball.faces).sum() == pytest.approx(4 * np.pi, rel=0.005)


def test_no_face_no_normal():
    none = np.zeros((0, 3), np.int32)
    np.testing.assert_array_equal(vertex_normals(np.eye(3), none), np.zeros((3, 3)))
    np.testing.assert_array_equal(vertex_areas(np.eye(3), none), np.zeros(3))
    assert face_normals(np.eye(3), none).shape == (0, 3)


def test_an_unknown_weighting_is_refused():
    with pytest.raises(
        ParameterError, match="weighting: 'mass' is not one of angle, area, uniform"
    ):
        vertex_normals(np.eye(3), np.array([[0, 1, 2]]), weighting="mass")
