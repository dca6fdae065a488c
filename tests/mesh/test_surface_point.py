"""Points that follow a surface."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from risorius.errors import ParameterError, ShapeError
from risorius.mesh.core import TriMesh
from risorius.mesh.surface_point import SurfacePoints
from tests.mesh.shapes import grid, rotation, sphere


def some_points(mesh: TriMesh, count: int, seed: int = 0) -> SurfacePoints:
    generator = np.random.default_rng(seed)
    bary = generator.dirichlet([1, 1, 1], count)
    return SurfacePoints(generator.integers(0, mesh.face_count, count), bary)


def test_position_is_the_weighted_mean_of_the_corners():
    mesh = grid(1, 1)
    points = SurfacePoints([0, 1], [[0.5, 0.25, 0.25], [0, 0, 1]])
    np.testing.assert_allclose(points.positions(mesh), [[0.5, 0.25, 0], [0, 1, 0]])


@given(st.integers(0, 2**32 - 1))
def test_points_follow_affine_motion_exactly(seed: int):
    generator = np.random.default_rng(seed)
    mesh, points = sphere(2), some_points(sphere(2), 20, seed)
    linear, shift = generator.normal(size=(3, 3)), generator.normal(size=3)
    moved = mesh.at(mesh.positions @ linear.T + shift)
    np.testing.assert_allclose(
        points.positions(moved), points.positions(mesh) @ linear.T + shift, atol=1e-12
    )


def test_coordinates_stay_while_the_mesh_deforms():
    mesh, points = sphere(2), some_points(sphere(2), 20)
    before = points.bary.copy()
    bent = mesh.at(np.sin(2.0 * mesh.positions))
    gap = points.positions(bent)[:, None] - bent.positions[bent.faces[points.faces]]
    np.testing.assert_allclose(np.einsum("kc,kcj->kj", points.bary, gap), 0.0, atol=1e-14)
    np.testing.assert_array_equal(points.bary, before)


def test_normals_are_renormalised_and_turn_with_the_mesh():
    mesh, points = sphere(2), some_points(sphere(2), 50)
    normals = points.normals(mesh)
    np.testing.assert_allclose(np.linalg.norm(normals, axis=1), 1.0, rtol=1e-14)
    turn = rotation(np.random.default_rng(3))
    np.testing.assert_allclose(
        points.normals(mesh.at(mesh.positions @ turn.T)), normals @ turn.T, atol=1e-13
    )
    up = np.tile([0.0, 0.0, 5.0], (mesh.vertex_count, 1))
    np.testing.assert_allclose(points.normals(mesh, up), [[0, 0, 1]] * 50)


def test_values_of_any_shape_are_interpolated():
    mesh, points = grid(3, 3), some_points(grid(3, 3), 9)
    height = mesh.positions @ [1.0, 2.0, 0.0]
    expected = points.positions(mesh) @ [1.0, 2.0, 0.0]
    np.testing.assert_allclose(points.interpolate(height, mesh.faces), expected)
    both = np.stack([height, -height], axis=1)
    assert points.interpolate(both, mesh.faces).shape == (9, 2)


def test_vertices_become_points_in_their_first_face():
    mesh = sphere(1)
    wanted = np.array([5, 0, 41])
    points = SurfacePoints.from_vertices(wanted, mesh.faces, surface=2)
    np.testing.assert_array_equal(points.positions(mesh), mesh.positions[wanted])
    first = [int(np.flatnonzero((mesh.faces == v).any(axis=1))[0]) for v in wanted]
    assert points.faces.tolist() == first
    assert points.surfaces.tolist() == [2, 2, 2]


def test_a_vertex_without_face_is_refused():
    with pytest.raises(ParameterError, match="vertex 7 belongs to no face"):
        SurfacePoints.from_vertices([0, 7], grid(1, 1).faces)


def test_points_can_be_chosen():
    points = SurfacePoints([0, 1, 1], np.eye(3), [4, 5, 6])
    chosen = points.take([2, 0])
    assert (chosen.faces.tolist(), chosen.surfaces.tolist()) == ([1, 0], [6, 4])
    assert len(points.take(np.array([True, False, False]))) == 1
    assert len(points) == 3


@pytest.mark.parametrize(
    ("faces", "bary", "error", "message"),
    [
        ([0], [[0.5, 0.5, 0.5]], ParameterError, "row 0 is .* its sum must be 1"),
        ([0], [[np.nan, 0.5, 0.5]], ParameterError, "its sum must be 1"),
        ([0, -1], [[1, 0, 0], [1, 0, 0]], ParameterError, "point 1 has face -1; it hit nothing"),
        ([0, 1], [[1, 0, 0]], ShapeError, r"bary: expected shape \(2, 3\)"),
    ],
)
def test_bad_points_are_refused(faces: list, bary: list, error: type[Exception], message: str):
    with pytest.raises(error, match=message):
        SurfacePoints(faces, bary)
