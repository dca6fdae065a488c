"""Volume of closed and of open meshes."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from risorius.mesh.core import TriMesh
from risorius.mesh.volume import capped_volume
from tests.mesh.shapes import cube, joined, rotation, sphere, star_of, torus, without_faces


def test_a_cube_holds_its_volume():
    assert capped_volume(cube().positions, cube().faces) == pytest.approx(1.0, rel=1e-14)


def test_a_fine_sphere_approaches_the_true_volume():
    errors = []
    for levels in (2, 3, 4):
        mesh = sphere(levels, radius=2.0)
        errors.append(1.0 - capped_volume(mesh.positions, mesh.faces) / (32.0 / 3.0 * np.pi))
    assert 0.0 < errors[2] < 0.005
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.1)


def open_head() -> TriMesh:
    mesh = sphere(3)
    return without_faces(mesh, np.concatenate([star_of(mesh, v) for v in (0, 5, 9)]))


@given(st.integers(0, 2**32 - 1), st.floats(-1e3, 1e3))
def test_volume_of_an_open_mesh_does_not_depend_on_origin_or_turn(seed: int, away: float):
    mesh = open_head()
    rest = capped_volume(mesh.positions, mesh.faces)
    moved = mesh.positions @ rotation(np.random.default_rng(seed)).T + [away, -away, 2 * away]
    assert capped_volume(moved, mesh.faces) == pytest.approx(rest, rel=1e-9)


def test_a_planar_hole_is_capped_flat():
    box = cube()
    # Without its lid (two faces at y = 1) the cube still holds one unit.
    lid = np.flatnonzero((box.positions[box.faces][:, :, 1] == 1.0).all(axis=1))
    assert len(lid) == 2
    open_box = without_faces(box, lid)
    assert capped_volume(open_box.positions, open_box.faces) == pytest.approx(1.0, rel=1e-14)


def test_inward_faces_have_negative_volume():
    mesh = torus()
    inward = capped_volume(mesh.positions, mesh.faces[:, [0, 2, 1]])
    assert inward == pytest.approx(-capped_volume(mesh.positions, mesh.faces))
    assert inward < 0.0


def test_pieces_add_up():
    apart = cube().at(cube().positions + 10.0)
    mesh = joined(cube(), apart)
    assert capped_volume(mesh.positions, mesh.faces) == pytest.approx(2.0, rel=1e-12)


def test_no_face_no_volume():
    assert capped_volume(np.zeros((3, 3)), np.zeros((0, 3), np.int32)) == 0.0
