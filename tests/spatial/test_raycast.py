"""Ray casting against single triangles, closed meshes and several meshes."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from risorius.errors import MeshError, ParameterError, ShapeError
from risorius.mesh.connectivity import edge_faces, edges
from risorius.mesh.core import TriMesh
from risorius.spatial.raycast import Scene
from tests.mesh.shapes import cube, grid, rotation, sphere, torus
from tests.spatial.brute_force import first_hit


@given(st.integers(0, 2**32 - 1))
def test_hits_equal_brute_force(seed: int):
    generator = np.random.default_rng(seed)
    points = generator.normal(size=(30, 3))
    soup = TriMesh(points, generator.integers(0, 30, (25, 3)))
    origins, directions = generator.normal(size=(40, 3)), generator.normal(size=(40, 3))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    hits = Scene([soup]).cast(origins, 3.0 * directions)
    corners = soup.positions[soup.faces]
    for ray in range(40):
        distance, face, bary = first_hit(origins[ray], directions[ray], corners)
        margin = np.min(bary) if face >= 0 else 1.0
        if hits.face[ray] != face and margin > 1e-4:
            # Only a ray along an edge may be judged differently.
            np.testing.assert_allclose(hits.distance[ray], distance, atol=1e-5)
        if hits.face[ray] == face >= 0:
            assert hits.distance[ray] == pytest.approx(distance, rel=1e-9, abs=1e-9)
            np.testing.assert_allclose(hits.bary[ray], bary, atol=1e-7)
    assert (hits.hit == (hits.face >= 0)).all()


@given(st.integers(0, 2**32 - 1))
def test_rays_through_edges_and_corners_never_slip_out_of_a_closed_mesh(seed: int):
    generator = np.random.default_rng(seed)
    mesh = sphere(2, radius=100.0)
    pairs = edges(mesh.faces)
    share = generator.random((len(pairs), 1))
    on_edges = share * mesh.positions[pairs[:, 0]] + (1 - share) * mesh.positions[pairs[:, 1]]
    goals = np.concatenate([on_edges, mesh.positions, mesh.positions[pairs].mean(axis=1)])
    place = generator.normal(size=3) * 1e3
    origin = 20.0 * generator.normal(size=3).clip(-2, 2)
    moved = mesh.at(mesh.positions + place)
    hits = Scene([moved]).cast(np.tile(origin + place, (len(goals), 1)), goals - origin)
    assert hits.hit.all()
    expected = np.linalg.norm(goals - origin, axis=1)
    np.testing.assert_allclose(hits.distance, expected, rtol=2e-5)


def test_answers_are_exact_in_double_precision():
    generator = np.random.default_rng(0)
    mesh = torus(40, 30, radius=70.0, tube=30.0)
    origins, directions = 60.0 * generator.normal(size=(500, 3)), generator.normal(size=(500, 3))
    hits = Scene([mesh]).cast(origins, directions)
    rows = np.flatnonzero(hits.hit)
    assert len(rows) > 100
    unit = directions / np.linalg.norm(directions, axis=1, keepdims=True)
    on_ray = origins + hits.distance[:, None] * unit
    on_face = np.einsum("kc,kcj->kj", hits.bary[rows], mesh.positions[mesh.faces[hits.face[rows]]])
    np.testing.assert_array_equal(hits.positions[rows], on_face)
    # A hit at the very rim is held inside its face, which costs single precision.
    rim = hits.bary[rows].min(axis=1) < 1e-6
    np.testing.assert_allclose(on_ray[rows[~rim]], on_face[~rim], atol=1e-9)
    np.testing.assert_allclose(on_ray[rows], on_face, atol=1e-3)
    assert (hits.bary[rows] >= 0.0).all()
    np.testing.assert_allclose(hits.bary[rows].sum(axis=1), 1.0, rtol=1e-14)


def test_misses_are_marked():
    hits = Scene([grid(1, 1)]).cast([[5, 5, 1], [0.5, 0.4, 1]], [0, 0, -1])
    assert hits.hit.tolist() == [False, True]
    assert np.isinf(hits.distance[0])
    assert (hits.mesh[0], hits.face[0]) == (-1, -1)
    assert np.isnan(hits.bary[0]).all()
    assert np.isnan(hits.positions[0]).all()
    assert np.isnan(hits.normals[0]).all()
    np.testing.assert_allclose(hits.positions[1], [0.5, 0.4, 0])
    np.testing.assert_allclose(hits.normals[1], [0, 0, 1])


def test_the_nearest_of_several_meshes_counts():
    near, far = grid(1, 1), grid(1, 1).at(grid(1, 1).positions - [0, 0, 3])
    scene = Scene([far, TriMesh(np.zeros((2, 3)), np.zeros((0, 3))), near])
    down = scene.cast([[0.7, 0.2, 1]], [0, 0, -1])
    assert (down.mesh[0], down.face[0], down.distance[0]) == (2, 0, 1.0)
    up = scene.cast([[0.2, 0.7, -5]], [0, 0, 1])
    assert (up.mesh[0], up.face[0], up.distance[0]) == (0, 1, 2.0)
    points = down.surface_points()
    assert (points.surfaces.tolist(), points.faces.tolist()) == ([2], [0])


def test_masked_faces_are_transparent():
    near, far = grid(1, 1), grid(1, 1).at(grid(1, 1).positions - [0, 0, 3])
    scene = Scene([near, far])
    origin = [[0.7, 0.2, 1]]
    assert scene.cast(origin, [0, 0, -1], face_mask=scene.mask_of([1])).mesh[0] == 1
    only_other_half = np.array([False, True, False, True])
    assert not scene.cast(origin, [0, 0, -1], face_mask=only_other_half).hit.any()
    assert not scene.cast(origin, [0, 0, -1], face_mask=np.zeros(4, bool)).hit.any()
    for turn in range(20):
        mask = np.array([True, False, turn % 2 == 0, turn % 3 == 0])
        assert scene.cast(origin, [0, 0, -1], face_mask=mask).face[0] == 0


def test_far_hits_are_misses():
    scene = Scene([grid(1, 1)])
    origin = [[0.4, 0.5, 1.0]]
    assert scene.cast(origin, [0, 0, -2], max_distance=1.0).hit[0]
    assert not scene.cast(origin, [0, 0, -2], max_distance=0.999).hit[0]


def test_both_directions_find_the_nearer_side():
    ball = Scene([sphere(3)])
    hits = ball.cast([[0, 0, 0.4], [0, 0, -0.4], [0, 0, 3]], [0, 0, 1], both_directions=True)
    np.testing.assert_allclose(hits.distance, [0.6, -0.6, -2.0], atol=0.01)
    np.testing.assert_allclose(hits.positions[:, 2], [1, -1, 1], atol=0.01)


def test_culled_sides_are_passed_through():
    ball = Scene([sphere(3), sphere(3, radius=3.0)])
    origin, direction = [[0.01, 0.02, -5]], [0, 0, 1]
    plain = ball.cast(origin, direction)
    front_only = ball.cast(origin, direction, cull="back")
    back_only = ball.cast(origin, direction, cull="front")
    np.testing.assert_allclose(plain.distance, 2.0, atol=0.02)
    np.testing.assert_array_equal(front_only.distance, plain.distance)
    np.testing.assert_allclose(back_only.distance, 6.0, atol=0.02)
    assert back_only.mesh[0] == 0
    inside = ball.cast([[0.01, 0.02, 0]], direction, cull="back")
    assert not inside.hit.any()


@given(st.integers(0, 2**32 - 1))
def test_culling_leaves_only_faces_of_the_right_side(seed: int):
    generator = np.random.default_rng(seed)
    scene = Scene([torus(12, 9)])
    origins, directions = 3.0 * generator.normal(size=(30, 3)), generator.normal(size=(30, 3))
    plain = scene.cast(origins, directions)
    for cull, sign in (("back", -1.0), ("front", 1.0)):
        hits = scene.cast(origins, directions, cull=cull)
        facing = np.einsum("ij,ij->i", hits.normals[hits.hit], directions[hits.hit])
        assert (sign * facing >= 0.0).all()
        facing = np.einsum("ij,ij->i", plain.normals, directions)
        right = plain.hit & (sign * facing > 0.0)
        np.testing.assert_array_equal(hits.distance[right], plain.distance[right])
        assert (hits.distance >= plain.distance - 1e-9).all()


@given(st.integers(0, 2**32 - 1), st.sampled_from([1e-3, 1.0, 1e3]))
def test_casting_turns_scales_and_moves_with_the_scene(seed: int, scale: float):
    generator = np.random.default_rng(seed)
    mesh, turn, shift = torus(12, 9), rotation(generator), generator.normal(size=3)
    origins, directions = generator.normal(size=(20, 3)), generator.normal(size=(20, 3))
    rest = Scene([mesh]).cast(origins, directions)
    moved = Scene([mesh.at(scale * (mesh.positions @ turn.T + 30 * shift))]).cast(
        scale * (origins @ turn.T + 30 * shift), directions @ turn.T
    )
    safe = rest.hit & (np.nan_to_num(rest.bary).min(axis=1) > 1e-3)
    assert safe.any()
    np.testing.assert_array_equal(moved.face[safe], rest.face[safe])
    np.testing.assert_allclose(moved.distance[safe], scale * rest.distance[safe], rtol=1e-7)


def test_rays_from_very_far_hit_the_same_place():
    mesh = sphere(3, radius=90.0)
    towards = np.array([1.0, 0.7, -0.4]) / np.linalg.norm([1.0, 0.7, -0.4])
    goals = np.random.default_rng(0).normal(size=(50, 3)) * 30.0
    near = Scene([mesh]).cast(goals - 300.0 * towards, towards)
    far = Scene([mesh]).cast(goals - 1e7 * towards, towards)
    np.testing.assert_array_equal(far.face, near.face)
    np.testing.assert_allclose(far.positions, near.positions, atol=1e-6)


def test_the_same_rays_give_the_same_bytes():
    generator = np.random.default_rng(0)
    origins, directions = generator.normal(size=(300, 3)), generator.normal(size=(300, 3))
    first = Scene([sphere(3)]).cast(origins, directions)
    second = Scene([sphere(3)]).cast(origins, directions)
    for name in ("distance", "face", "bary", "positions", "normals"):
        assert getattr(first, name).tobytes() == getattr(second, name).tobytes()


def test_bad_input_is_refused():
    scene = Scene([cube()])
    with pytest.raises(MeshError, match="they have no face"):
        Scene([])
    with pytest.raises(ParameterError, match="directions: row 1 is zero"):
        scene.cast(np.zeros((2, 3)), [[1, 0, 0], [0, 0, 0]])
    with pytest.raises(ShapeError, match="expected 2 rows, one per origin, got 3"):
        scene.cast(np.zeros((2, 3)), np.ones((3, 3)))
    with pytest.raises(ShapeError, match=r"face_mask: expected \(12,\) bool"):
        scene.cast(np.zeros((1, 3)), [1, 0, 0], face_mask=[0, 1])
    with pytest.raises(ParameterError, match="max_distance: nan must be at least 0"):
        scene.cast(np.zeros((1, 3)), [1, 0, 0], max_distance=np.nan)
    with pytest.raises(ParameterError, match="cull: 'sideways' is not one of"):
        scene.cast(np.zeros((1, 3)), [1, 0, 0], cull="sideways")
    with pytest.raises(ParameterError, match=r"meshes: 3 is not in 0\.\.0"):
        scene.mask_of([3])


def test_no_rays_no_hits():
    assert len(Scene([cube()]).cast(np.zeros((0, 3)), [0, 0, 1]).distance) == 0


@pytest.mark.real
def test_every_ray_from_inside_an_eyeball_hits_it(real_data: Path):
    arrays = np.load(real_data / "ict_facekit" / "ict_facekit.npz")
    quads = arrays["polygons"]
    eye = quads[((quads >= 21451) & (quads <= 23020)).all(axis=1)]
    faces = np.concatenate([eye[:, [0, 1, 2]], eye[:, [0, 2, 3]]])
    mesh = TriMesh(arrays["vertices"].astype(float), faces)
    middle = mesh.positions[np.unique(faces)].mean(axis=0)
    # Aim at every vertex and every middle of an edge, except on the border.
    table = edge_faces(mesh.faces)
    inner = np.setdiff1d(faces, table.edges[table.counts == 1])
    sides = mesh.positions[table.edges[table.counts == 2]]
    goals = np.concatenate([mesh.positions[inner], sides.mean(axis=1)])
    hits = Scene([mesh]).cast(np.tile(middle, (len(goals), 1)), goals - middle)
    assert hits.hit.all()
    assert len(goals) > 6000
