"""Strain of a surface."""

from __future__ import annotations

import numpy as np
import pytest

from risorius.mesh.core import TriMesh
from risorius.mesh.normals import vertex_normals
from risorius.wrinkles.strain import principal, surface_strain
from tests.wrinkles.sheets import sheet, turned


def test_a_sheet_that_is_pressed_along_x_is_strained_by_what_it_loses() -> None:
    mesh = sheet(30.0, 1.5)
    moved = mesh.positions * [-0.2, 0.0, 0.0]
    strain = surface_strain(mesh, moved)
    pressed, direction, pulled = principal(strain, vertex_normals(mesh.positions, mesh.faces))
    # Green strain of a stretch s is (s^2 - 1) / 2.
    np.testing.assert_allclose(pressed, 0.5 * (0.8**2 - 1.0), atol=1e-9)
    np.testing.assert_allclose(pulled, 0.0, atol=1e-9)
    np.testing.assert_allclose(np.abs(direction[:, 0]), 1.0, atol=1e-9)


def test_rigid_motion_strains_nothing() -> None:
    mesh = sheet(20.0, 2.0)
    rotation = turned(0.7)
    moved = mesh.positions @ rotation.T + [3.0, -2.0, 8.0] - mesh.positions
    np.testing.assert_allclose(surface_strain(mesh, moved), 0.0, atol=1e-12)


def test_a_turned_sheet_has_the_turned_strain() -> None:
    mesh, rotation = sheet(20.0, 2.0), turned(1.1)
    wave = np.sin(mesh.positions[:, [1, 0, 0]] / 4.0) * [1.0, 0.5, 0.7]
    straight = surface_strain(mesh, wave)
    other = TriMesh(mesh.positions @ rotation.T, mesh.faces)
    both = surface_strain(other, wave @ rotation.T)
    np.testing.assert_allclose(both, rotation @ straight @ rotation.T, atol=1e-10)


def test_a_collapsed_triangle_spoils_nothing() -> None:
    mesh = sheet(10.0, 2.0)
    faces = np.concatenate([mesh.faces, [[0, 0, 1]]]).astype(np.int32)
    strain = surface_strain(TriMesh(mesh.positions, faces), 0.1 * mesh.positions)
    assert np.isfinite(strain).all()
    assert strain[:, 0, 0] == pytest.approx(0.5 * (1.1**2 - 1.0))
