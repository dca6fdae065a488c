"""Boundary loops."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import assume, given

from risorius.mesh.boundary import boundary_loops
from risorius.mesh.connectivity import edge_faces
from risorius.mesh.core import TriMesh
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


@pytest.mark.parametrize("mesh", [sphere(2), cube(), torus()])
def test_closed_mesh_has_no_boundary_loop(mesh: TriMesh):
    assert boundary_loops(mesh.faces) == []


def test_loop_runs_around_a_sheet_with_the_surface_on_its_left():
    (loop,) = boundary_loops(grid(3, 2).faces)
    assert loop.tolist() == [0, 1, 2, 3, 7, 11, 10, 9, 8, 4]


def test_punctured_sphere_has_one_loop_per_puncture():
    mesh = sphere(3)
    first = star_of(mesh, 0)
    far = int(np.argmin(mesh.positions @ mesh.positions[0]))
    punctured = without_faces(mesh, np.concatenate([first, star_of(mesh, far)]))
    loops = boundary_loops(punctured.faces)
    assert [len(loop) for loop in loops] == [5, 5]
    rings = {frozenset(mesh.faces[star_of(mesh, v)].ravel().tolist()) - {v} for v in (0, far)}
    assert {frozenset(loop.tolist()) for loop in loops} == rings


def test_loop_around_a_hole_turns_against_its_sides():
    mesh = sphere(3)
    (loop,) = boundary_loops(without_faces(mesh, star_of(mesh, 0)).faces)
    ring = mesh.positions[loop]
    turning = np.cross(ring, np.roll(ring, -1, axis=0)).sum(axis=0)
    assert turning @ mesh.positions[0] < 0.0


def test_two_holes_that_touch_in_one_vertex_are_two_loops():
    def quad(row: int, column: int) -> list[int]:
        return [5 * row + column, 20 + 5 * row + column]

    apart = without_faces(grid(5, 4), quad(1, 1) + quad(2, 3))
    assert sorted(len(loop) for loop in boundary_loops(apart.faces)) == [4, 4, 18]
    touching = without_faces(grid(5, 4), quad(1, 1) + quad(2, 2))
    loops = boundary_loops(touching.faces)
    assert sorted(len(loop) for loop in loops) == [4, 4, 18]
    # Quads (1, 1) and (2, 2) share the vertex of row 2 and column 2.
    assert set(loops[1].tolist()) & set(loops[2].tolist()) == {14}


def test_two_sheets_that_touch_in_one_vertex_are_two_loops():
    faces = np.array([[0, 1, 2], [0, 3, 4]], np.int32)
    assert [loop.tolist() for loop in boundary_loops(faces)] == [[0, 1, 2], [0, 3, 4]]


def test_two_sheets_that_touch_in_two_vertices_keep_their_own_loops():
    # Vertices 0 and 2 belong to both; any other pairing of their border edges mixes the sheets.
    first = [[0, 1, 2], [0, 2, 5]]
    second = [[0, 3, 6], [3, 2, 6], [2, 4, 6], [4, 0, 6]]
    loops = boundary_loops(np.array(first + second, np.int32))
    assert [loop.tolist() for loop in loops] == [[0, 1, 2, 5], [0, 3, 2, 4]]


def test_loops_survive_inconsistent_faces():
    mesh = grid(3, 3)
    faces = mesh.faces.copy()
    faces[[2, 5]] = faces[[2, 5]][:, ::-1]
    (plain,), (mixed,) = boundary_loops(mesh.faces), boundary_loops(faces)
    assert mixed.tolist() in (plain.tolist(), np.roll(plain[::-1], 1).tolist())


def test_a_non_manifold_edge_harms_no_loop_elsewhere():
    # Three sheets on one edge: its ends have an odd number of border edges.
    book = np.array([[0, 1, 2], [0, 1, 3], [0, 1, 4]], np.int32)
    loops = boundary_loops(np.concatenate([book, [[5, 6, 7]]]))
    assert [5, 6, 7] in [loop.tolist() for loop in loops]
    assert len(loops) == 2, "of the three sheets two make a loop, the third is an open chain"


@given(triangle_soups())
def test_loops_of_any_soup_are_simple_and_use_border_edges_once(mesh: TriMesh):
    table = edge_faces(mesh.faces)
    border = {tuple(e) for e, count in zip(table.edges.tolist(), table.counts) if count == 1}
    used: set[tuple[int, int]] = set()
    for loop in boundary_loops(mesh.faces):
        vertices = loop.tolist()
        assert len(set(vertices)) == len(vertices) >= 3
        assert vertices[0] == min(vertices)
        for a, b in zip(vertices, vertices[1:] + vertices[:1]):
            edge = (min(a, b), max(a, b))
            assert edge in border
            assert edge not in used
            used.add(edge)


@given(triangle_soups(faces=6))
def test_loops_use_every_border_edge_where_edges_are_manifold(mesh: TriMesh):
    table = edge_faces(mesh.faces)
    assume((table.counts <= 2).all())
    assert sum(len(loop) for loop in boundary_loops(mesh.faces)) == int((table.counts == 1).sum())


def test_loops_of_loose_pieces_are_in_order():
    loops = boundary_loops(joined(grid(1, 1), cube(), grid(2, 1)).faces)
    assert [int(loop[0]) for loop in loops] == [0, 12]
