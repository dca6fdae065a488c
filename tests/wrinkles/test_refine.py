"""Patches that are cut finely."""

from __future__ import annotations

import numpy as np
import pytest

from risorius.mesh.connectivity import edges
from risorius.mesh.normals import face_areas
from risorius.wrinkles.refine import refine
from tests.wrinkles.sheets import sheet


@pytest.mark.parametrize("length", [4.0, 1.5, 0.6])
def test_a_patch_covers_its_faces_with_edges_as_short_as_wanted(length: float) -> None:
    mesh = sheet(12.0, 3.0)
    chosen = np.arange(mesh.face_count) % 3 == 0
    patch = refine(mesh, chosen, length)
    pairs = edges(patch.mesh.faces)
    sizes = np.linalg.norm(np.subtract(*patch.mesh.positions[pairs.T]), axis=1)
    assert sizes.mean() <= length
    fine = face_areas(patch.mesh.positions, patch.mesh.faces)
    assert fine.sum() == pytest.approx(face_areas(mesh.positions, mesh.faces[chosen]).sum())
    assert set(patch.coarse_face.tolist()) == set(np.flatnonzero(chosen).tolist())


def test_values_are_carried_linearly_and_corners_lie_where_they_say() -> None:
    mesh = sheet(12.0, 3.0)
    patch = refine(mesh, np.ones(mesh.face_count, bool), 1.0)
    np.testing.assert_allclose(patch.carry(mesh.positions), patch.mesh.positions, atol=1e-12)
    corners = mesh.positions[mesh.faces[patch.coarse_face]]
    placed = np.einsum("mck,mkd->mcd", patch.corner_shares, corners)
    np.testing.assert_allclose(placed, patch.mesh.positions[patch.mesh.faces], atol=1e-12)


def test_a_patch_has_no_cracks() -> None:
    mesh = sheet(9.0, 3.0)
    patch = refine(mesh, np.ones(mesh.face_count, bool), 1.0)
    distinct = np.unique(patch.mesh.positions.round(9), axis=0)
    assert len(distinct) == patch.mesh.vertex_count
