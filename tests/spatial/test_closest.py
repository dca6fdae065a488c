"""Closest points, signed distances, winding numbers."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from risorius.errors import ParameterError, ShapeError
from risorius.mesh.core import TriMesh
from risorius.mesh.normals import face_normals
from risorius.spatial.closest import closest_points, signed_distance, winding_numbers
from risorius.spatial.raycast import Scene
from tests.mesh.shapes import cube, grid, joined, rotation, sphere, torus
from tests.spatial.brute_force import closest


def soup(generator: np.random.Generator, faces: int = 25) -> TriMesh:
    return TriMesh(generator.normal(size=(20, 3)), generator.integers(0, 20, (faces, 3)))


@given(st.integers(0, 2**32 - 1))
def test_closest_points_equal_brute_force(seed: int):
    generator = np.random.default_rng(seed)
    mesh = soup(generator, 15)
    points = 2.0 * generator.normal(size=(10, 3))
    found = closest_points(mesh, points)
    corners = mesh.positions[mesh.faces]
    everything = np.arange(mesh.face_count)
    expected = [closest(point, corners, everything) for point in points]
    np.testing.assert_allclose(found.distance, expected, atol=1e-9)
    on_face = np.einsum("kc,kcj->kj", found.bary, corners[found.face])
    np.testing.assert_array_equal(found.positions, on_face)
    np.testing.assert_allclose(np.linalg.norm(points - on_face, axis=1), found.distance)


@given(st.integers(0, 2**32 - 1), st.sampled_from([20.0, 60.0, 90.0, 180.0]), st.integers(1, 60))
def test_closest_points_by_normal_equal_brute_force(seed: int, max_angle: float, faces: int):
    generator = np.random.default_rng(seed)
    mesh = soup(generator, faces)
    points, wanted = generator.normal(size=(20, 3)), generator.normal(size=(20, 3))
    mask = generator.random(faces) < 0.8
    found = closest_points(mesh, points, normals=wanted, max_angle=max_angle, face_mask=mask)
    corners, normals = mesh.positions[mesh.faces], face_normals(mesh.positions, mesh.faces)
    unit = wanted / np.linalg.norm(wanted, axis=1, keepdims=True)
    sound = mask & (normals != 0.0).any(axis=1)
    for query, point in enumerate(points):
        agrees = normals @ unit[query] >= np.cos(np.radians(max_angle))
        expected = closest(point, corners, np.flatnonzero(sound & agrees))
        np.testing.assert_allclose(found.distance[query], expected, atol=1e-9)
        assert (found.face[query] < 0) == np.isinf(expected)


def test_the_other_lip_is_not_taken_by_normal():
    upper = grid(4, 4)
    lower = TriMesh(upper.positions - [0, 0, 0.02], upper.faces[:, [0, 2, 1]])
    lips = Scene([upper, lower])
    query = [[0.5, 0.4, -0.015]]
    assert closest_points(lips, query).mesh[0] == 1
    found = closest_points(lips, query, normals=[[0, 0, 1]], max_angle=60.0)
    assert found.mesh[0] == 0
    np.testing.assert_allclose(found.distance, 0.015)
    none = closest_points(lips, query, normals=[[1, 0, 0]], max_angle=60.0)
    assert (none.mesh[0], none.face[0], none.distance[0]) == (-1, -1, np.inf)
    assert len(none.surface_points()) == 0


def test_points_on_the_surface_have_distance_zero():
    mesh = torus()
    found = closest_points(mesh, mesh.positions)
    np.testing.assert_allclose(found.distance, 0.0, atol=1e-12)
    points = found.surface_points()
    np.testing.assert_allclose(points.positions(mesh), mesh.positions, atol=1e-12)


@given(st.integers(0, 2**32 - 1), st.sampled_from([1e-3, 1.0, 1e3]))
def test_closest_points_turn_scale_and_move_with_the_mesh(seed: int, scale: float):
    generator = np.random.default_rng(seed)
    mesh, turn, shift = torus(10, 8), rotation(generator), 50.0 * generator.normal(size=3)
    points = 3.0 * generator.normal(size=(20, 3))
    rest = closest_points(mesh, points)
    moved = closest_points(
        mesh.at(scale * (mesh.positions @ turn.T + shift)), scale * (points @ turn.T + shift)
    )
    np.testing.assert_allclose(moved.distance, scale * rest.distance, rtol=1e-9, atol=1e-11 * scale)


def test_masked_faces_do_not_count():
    mesh = grid(1, 1)
    found = closest_points(mesh, [[0.9, 0.1, 1.0]], face_mask=np.array([False, True]))
    assert found.face[0] == 1
    assert found.distance[0] > 1.0
    none = closest_points(mesh, [[0.9, 0.1, 1.0]], face_mask=np.array([False, False]))
    assert np.isinf(none.distance[0])


def test_bad_input_is_refused():
    with pytest.raises(ShapeError, match="normals: expected 1 rows, one per point, got 2"):
        closest_points(cube(), [[0, 0, 0]], normals=np.eye(3)[:2])
    with pytest.raises(ParameterError, match="max_angle: 200 is above 180"):
        closest_points(cube(), [[0, 0, 0]], normals=[[0, 0, 1]], max_angle=200.0)
    with pytest.raises(ShapeError, match="face_mask"):
        closest_points(cube(), [[0, 0, 0]], face_mask=[True])


def test_signed_distance_of_a_cube_is_exact():
    points = np.array([[0.5, 0.5, 0.5], [0.5, 0.9, 0.5], [2, 0.5, 0.5], [2, 2, 0.5], [-1, -1, -1]])
    expected = [-0.5, -0.1, 1.0, np.sqrt(2.0), np.sqrt(3.0)]
    np.testing.assert_allclose(signed_distance(cube(), points), expected, atol=1e-12)


def test_signed_distance_of_a_sphere_is_near_the_true_one():
    points = 2.0 * np.random.default_rng(0).normal(size=(300, 3))
    found = signed_distance(sphere(4), points)
    true = np.linalg.norm(points, axis=1) - 1.0
    np.testing.assert_allclose(found, true, atol=0.003)


def test_inside_does_not_depend_on_the_sense_of_the_faces():
    mesh = joined(sphere(2), cube().at(cube().positions + 3.0))
    inward = TriMesh(mesh.positions, mesh.faces[:, [0, 2, 1]])
    points = 2.0 * np.random.default_rng(0).normal(size=(200, 3)) + 1.0
    np.testing.assert_allclose(
        signed_distance(mesh, points), signed_distance(inward, points), atol=1e-12
    )
    assert (signed_distance(mesh, points) < 0.0).any()


def test_winding_numbers_count_the_shells():
    shells = joined(sphere(3), sphere(3, radius=3.0))
    points = np.array([[0, 0, 0], [0, 2, 0], [0, 0, 9]])
    np.testing.assert_allclose(winding_numbers(shells, points), [2, 1, 0], atol=0.02)
    assert winding_numbers(shells, np.zeros((0, 3))).shape == (0,)


def test_no_points_no_answers():
    assert closest_points(cube(), np.zeros((0, 3))).distance.shape == (0,)
    assert closest_points(cube(), np.zeros((0, 3)), normals=np.zeros((0, 3))).face.shape == (0,)
