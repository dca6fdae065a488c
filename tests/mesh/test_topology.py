"""The topology report and its sentences."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given

from risorius.mesh.core import TriMesh
from risorius.mesh.topology import collapsed_faces, orient, report
from tests.mesh.shapes import (
    cube,
    grid,
    joined,
    sphere,
    star_of,
    torus,
    triangle_soups,
    without_faces,
)


@pytest.mark.parametrize(
    ("mesh", "euler", "genus", "loops"),
    [
        (sphere(2), 2, 0, 0),
        (cube(), 2, 0, 0),
        (torus(), 0, 1, 0),
        (grid(4, 3), 1, 0, 1),
        (without_faces(sphere(2), [0]), 1, 0, 1),
        (without_faces(torus(), [0]), -1, 1, 1),
        (joined(sphere(1), torus(), grid()), 3, 1, 1),
        (joined(torus(), torus()), 0, 2, 0),
    ],
)
def test_euler_number_and_genus_are_right(mesh: TriMesh, euler: int, genus: int, loops: int):
    found = report(mesh)
    assert (found.euler, found.genus, len(found.boundary_loops)) == (euler, genus, loops)
    assert found.is_manifold
    assert found.is_closed == (loops == 0)
    assert len(found.sentences()) == 2


def test_each_puncture_lowers_the_euler_number_by_one():
    mesh = sphere(3)
    # Corners of the icosahedron are far apart.
    cuts = np.concatenate([star_of(mesh, vertex) for vertex in range(4)])
    found = report(without_faces(mesh, cuts))
    assert found.euler == 2 - 4
    assert found.genus == 0
    assert found.unused_vertices.tolist() == [0, 1, 2, 3]


def test_report_names_non_manifold_edges_and_vertices():
    book = np.array([[0, 1, 2], [1, 0, 3], [0, 1, 4]])
    found = report(TriMesh(np.random.default_rng(0).normal(size=(5, 3)), book))
    assert found.non_manifold_edges.tolist() == [[0, 1]]
    assert not found.is_manifold
    assert found.genus is None
    pinched = report(TriMesh(np.random.default_rng(0).normal(size=(5, 3)), [[0, 1, 2], [0, 3, 4]]))
    assert pinched.non_manifold_vertices.tolist() == [0]
    assert "1 vertex where fans meet: 0" in pinched.sentences()


def test_two_spheres_joined_in_one_vertex_pinch_there():
    first, second = sphere(1), sphere(1)
    faces = second.faces + first.vertex_count
    faces[faces == first.vertex_count] = 0
    found = report(
        TriMesh(
            np.concatenate([first.positions, second.positions + 2]),
            np.concatenate([first.faces, faces]),
        )
    )
    assert found.non_manifold_vertices.tolist() == [0]
    assert len(found.non_manifold_edges) == 0
    assert found.boundary_loops == []
    assert not found.is_closed


def test_report_names_flipped_faces_by_their_edges():
    mesh = sphere(1)
    faces = mesh.faces.copy()
    faces[7] = faces[7, ::-1]
    found = report(TriMesh(mesh.positions, faces))
    sides = {tuple(sorted((int(mesh.faces[7, k]), int(mesh.faces[7, k - 1])))) for k in range(3)}
    assert {tuple(edge) for edge in found.inconsistent_edges.tolist()} == sides
    assert found.genus is None


def test_report_names_degenerate_duplicate_and_unused():
    mesh = grid(2, 2)
    points = np.vstack([mesh.positions, [[5, 5, 5], [0.25, 0, 0]]])
    faces = np.vstack([mesh.faces, [[0, 10, 1]], mesh.faces[3:4, [1, 2, 0]], [[4, 4, 5]]])
    found = report(TriMesh(points, faces))
    assert found.degenerate_faces.tolist() == [8, 10]
    assert found.duplicate_faces.tolist() == [9]
    assert found.unused_vertices.tolist() == [9]
    text = "\n".join(found.sentences())
    assert "1 unused vertex: 9" in text
    assert "2 triangles without area: 8, 10" in text


def test_the_smallest_honest_triangle_is_not_degenerate():
    mesh = TriMesh(1e-60 * np.eye(3), [[0, 1, 2]])
    assert report(mesh).degenerate_faces.tolist() == []


def test_long_lists_are_cut_in_sentences():
    found = report(TriMesh(np.zeros((9, 3)), np.zeros((0, 3), np.int32)))
    assert found.sentences()[-1] == "9 unused vertices: 0, 1, 2, 3, 4, ..."
    assert not found.is_closed


@given(triangle_soups())
def test_any_soup_gets_a_report(mesh: TriMesh):
    found = report(mesh)
    used = mesh.vertex_count - len(found.unused_vertices)
    whole = mesh.face_count - int(collapsed_faces(mesh.faces).sum())
    assert found.euler == used - found.edge_count + whole
    assert set(np.flatnonzero(collapsed_faces(mesh.faces))) <= set(found.degenerate_faces)
    assert len(found.sentences()) >= 2


@pytest.mark.real
def test_a_real_head_is_understood(real_data: Path):
    arrays = np.load(real_data / "ict_facekit" / "ict_facekit.npz")
    polygons = arrays["polygons"]
    quads = polygons[polygons[:, 3] >= 0]
    mesh = TriMesh(
        arrays["vertices"].astype(float), np.concatenate([polygons[:, :3], quads[:, [0, 2, 3]]])
    )
    found = report(mesh)
    assert found.is_manifold
    assert found.component_count == 56
    assert len(found.boundary_loops) == 23
    assert found.genus == 0
    # Only the lashes are sheets; everything else that is open still has an outside.
    assert not orient(mesh.positions, mesh.faces).flipped.any()
