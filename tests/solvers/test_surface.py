"""Constraints of surfaces: how many, of what rest, and what is left out."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given

from risorius.errors import MeshError, RisoriusWarning
from risorius.mesh.connectivity import edge_faces
from risorius.mesh.core import TriMesh
from risorius.solvers.gradients import bend_value
from risorius.solvers.surface import (
    SurfaceStiffness,
    flaps,
    surface_bends,
    surface_constraints,
    surface_volume,
)
from tests.mesh.shapes import cube, grid, sphere, star_of, triangle_soups, without_faces
from tests.solvers.particles import meshes


@given(meshes())
def test_a_skin_has_e_plus_two_inner_e_plus_f_plus_one_constraints(mesh: TriMesh) -> None:
    table = edge_faces(mesh.faces)
    inner = int((table.counts == 2).sum())
    found = surface_constraints(mesh)
    assert found.count == len(table.edges) + 2 * inner + mesh.face_count + 1
    assert len(found.distances.particles) == len(table.edges) + inner
    assert len(found.bends.particles) == inner


def test_rest_is_a_zero_of_every_constraint_and_stiffness_is_by_kind() -> None:
    mesh = sphere(1, 50.0)
    found = surface_constraints(mesh, SurfaceStiffness(0.1, 0.2, 0.3, 0.4))
    assert np.unique(found.distances.stiffness).tolist() == [0.1]
    assert np.unique(found.bends.stiffness).tolist() == [0.2]
    assert np.unique(found.areas.stiffness).tolist() == [0.3]
    assert found.volumes[0].stiffness == 0.4
    sides = mesh.positions[found.distances.particles]
    np.testing.assert_array_equal(
        np.linalg.norm(sides[:, 0] - sides[:, 1], axis=1), found.distances.rest
    )
    assert found.volumes[0].rest == pytest.approx(4 / 3 * np.pi * 50.0**3, rel=0.3)


def test_all_edges_of_a_convex_surface_bend_the_same_way() -> None:
    found = surface_bends(cube(), 1.0)
    sharp = np.abs(found.rest) > 1e-12
    assert sharp.sum() == 12
    np.testing.assert_allclose(found.rest[sharp], np.pi / 2, rtol=1e-12)


def test_a_surface_turned_inside_out_bends_the_other_way() -> None:
    mesh = sphere(1)
    inside_out = TriMesh(mesh.positions, mesh.faces[:, ::-1])
    assert (surface_bends(mesh, 1.0).rest > 0.0).all()
    assert (surface_bends(inside_out, 1.0).rest < 0.0).all()


def test_flaps_name_the_edge_and_the_corners_of_its_two_faces() -> None:
    mesh = TriMesh([(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0)], [(0, 1, 2), (2, 1, 3)])
    assert flaps(mesh).tolist() in ([[1, 2, 0, 3]], [[2, 1, 3, 0]])
    assert bend_value(mesh.positions[flaps(mesh)])[0] == 0.0


def test_holes_are_capped() -> None:
    whole = sphere(3, 10.0)
    mesh = without_faces(whole, star_of(whole, 7))
    volume = surface_volume(mesh, 1.0)
    assert len(volume.holes) == 1
    assert volume.rest == pytest.approx(surface_volume(whole, 1.0).rest, rel=1e-2)


def test_a_flat_sheet_encloses_nothing_and_is_refused() -> None:
    with pytest.raises(MeshError, match=r"encloses .* nothing to keep; orient its faces"):
        surface_constraints(grid(3, 3))
    assert surface_constraints(grid(3, 3), with_volume=False).volumes == ()


def test_faces_without_area_are_left_out_and_counted() -> None:
    mesh = sphere(1)
    positions = mesh.positions.copy()
    a, b, c = mesh.faces[0]
    positions[c] = (positions[a] + positions[b]) / 2
    with pytest.warns(RisoriusWarning, match="1 edges and faces"):
        found = surface_constraints(mesh.at(positions))
    assert len(found.areas.particles) == mesh.face_count - 1
    assert np.isfinite(found.bends.rest).all()


def test_an_edge_of_three_faces_keeps_two_with_a_warning() -> None:
    points = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1)]
    mesh = TriMesh(points, [(0, 1, 2), (1, 0, 3), (0, 1, 4)])
    with pytest.warns(RisoriusWarning, match="1 edges have more than two faces"):
        assert len(flaps(mesh)) == 1


@given(triangle_soups())
@pytest.mark.filterwarnings("ignore::risorius.errors.RisoriusWarning")
def test_no_mesh_crashes_the_builders(mesh: TriMesh) -> None:
    found = surface_constraints(mesh, with_volume=False)
    for rest in (found.distances.rest, found.areas.rest, found.bends.rest):
        assert np.isfinite(rest).all()
    assert (found.areas.rest > 0.0).all()
