"""Consistent, outward faces."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from risorius.errors import MeshError
from risorius.mesh.core import TriMesh
from risorius.mesh.topology import orient, report
from tests.mesh.shapes import cube, grid, joined, sphere, star_of, torus, without_faces


@given(st.integers(0, 2**32 - 1), st.floats(0.0, 1.0))
def test_any_set_of_flipped_faces_is_found(seed: int, share: float):
    parts = (torus(), sphere(1), without_faces(sphere(2), [0, 1, 5]))
    mesh = joined(*(p.at(p.positions + np.array([9.0 * i, 0, 0])) for i, p in enumerate(parts)))
    flip = np.random.default_rng(seed).random(mesh.face_count) < share
    faces = mesh.faces.copy()
    faces[flip] = faces[flip][:, [0, 2, 1]]
    result = orient(mesh.positions, faces)
    np.testing.assert_array_equal(result.flipped, flip)
    np.testing.assert_array_equal(result.faces, mesh.faces)


def test_neighbours_agree_afterwards():
    mesh = torus()
    faces = mesh.faces.copy()
    faces[::3] = faces[::3][:, ::-1]
    assert len(report(TriMesh(mesh.positions, faces)).inconsistent_edges) > 0
    turned = orient(mesh.positions, faces)
    assert len(report(TriMesh(mesh.positions, turned.faces)).inconsistent_edges) == 0


def test_a_flat_sheet_keeps_the_side_of_its_majority():
    mesh = grid(4, 4)
    faces = mesh.faces.copy()
    faces[:5] = faces[:5][:, [0, 2, 1]]
    result = orient(mesh.positions, faces)
    np.testing.assert_array_equal(result.faces, mesh.faces)
    back = mesh.faces[:, [0, 2, 1]]
    np.testing.assert_array_equal(orient(mesh.positions, back).faces, back)


def test_a_curled_sheet_is_no_solid_and_stays():
    mesh = grid(6, 2, width=3.0)
    height = 0.02 * mesh.positions[:, 0] ** 2
    bent = mesh.positions + height[:, None] * np.array([0.0, 0.0, 1.0])
    for faces in (mesh.faces, mesh.faces[:, [0, 2, 1]]):
        assert not orient(bent, faces).flipped.any()


def test_a_thin_closed_solid_looks_outwards():
    box = cube().positions * [1.0, 1.0, 1e-4]
    assert orient(box, cube().faces[:, [0, 2, 1]]).flipped.all()
    assert not orient(box, cube().faces).flipped.any()


def test_a_mask_with_holes_looks_outwards():
    mesh = sphere(3)
    holes = np.concatenate([star_of(mesh, v) for v in (0, 3, 7)])
    mask = without_faces(
        mesh,
        np.unique(
            np.concatenate(
                [holes, np.flatnonzero(mesh.positions[mesh.faces].mean(axis=1)[:, 2] < -0.2)]
            )
        ),
    )
    inward = mask.faces[:, [0, 2, 1]]
    assert orient(mask.positions, inward).flipped.all()


def test_a_moebius_strip_is_refused():
    turns = np.linspace(0.0, 2 * np.pi, 12, endpoint=False)
    rim = []
    for angle in turns:
        out = np.array([np.cos(angle), np.sin(angle), 0.0])
        across = 0.3 * (np.cos(angle / 2) * out + np.sin(angle / 2) * np.array([0, 0, 1.0]))
        rim += [out + across, out - across]
    faces = []
    for i in range(12):
        a, b = 2 * i, 2 * i + 1
        c, d = (2 * i + 2, 2 * i + 3) if i < 11 else (1, 0)
        faces += [[a, b, c], [c, b, d]]
    with pytest.raises(MeshError, match="only one side, like a Moebius strip; cut it open"):
        orient(np.array(rim), np.array(faces, np.int32))


def test_nothing_to_orient_is_fine():
    assert orient(np.zeros((0, 3)), np.zeros((0, 3), np.int32)).faces.shape == (0, 3)
