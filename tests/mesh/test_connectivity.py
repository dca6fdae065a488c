"""Edges, neighbours and loose pieces."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given

from risorius.mesh.connectivity import (
    components,
    edge_faces,
    edges,
    opposite_corners,
    vertex_neighbours,
)
from risorius.mesh.core import TriMesh
from tests.mesh.shapes import cube, grid, joined, sphere, torus, triangle_soups


def plain_edges(mesh: TriMesh) -> dict[tuple[int, int], list[int]]:
    """Return the faces of every edge, the slow way."""
    table: dict[tuple[int, int], list[int]] = {}
    for number, face in enumerate(mesh.faces.tolist()):
        if len(set(face)) == 3:
            for a, b in ((0, 1), (1, 2), (2, 0)):
                key = (min(face[a], face[b]), max(face[a], face[b]))
                table.setdefault(key, []).append(number)
    return dict(sorted(table.items()))


@given(triangle_soups())
def test_edge_table_equals_the_plain_one(mesh: TriMesh):
    table, plain = edge_faces(mesh.faces), plain_edges(mesh)
    assert [tuple(edge) for edge in table.edges.tolist()] == list(plain)
    assert table.counts.tolist() == [len(faces) for faces in plain.values()]
    for row, faces in zip(table.faces.tolist(), plain.values()):
        assert row == [*faces, -1][:2]


@given(triangle_soups())
def test_every_face_knows_its_edges(mesh: TriMesh):
    table = edge_faces(mesh.faces)
    for face, sides in zip(mesh.faces.tolist(), table.face_edges.tolist()):
        for corner, edge in enumerate(sides):
            ends = {face[corner], face[(corner + 1) % 3]}
            if len(set(face)) < 3:
                assert edge == -1
            else:
                assert set(table.edges[edge].tolist()) == ends


@pytest.mark.parametrize("mesh", [sphere(2), cube(), torus()])
def test_every_edge_of_a_closed_surface_has_two_faces(mesh: TriMesh):
    table = edge_faces(mesh.faces)
    assert (table.counts == 2).all()
    assert 2 * len(table.edges) == 3 * mesh.face_count


@given(triangle_soups())
def test_opposite_corner_and_edge_make_the_face(mesh: TriMesh):
    table = edge_faces(mesh.faces)
    opposite = opposite_corners(mesh.faces, table)
    for edge, corners, faces in zip(table.edges, opposite, table.faces):
        for corner, face in zip(corners, faces):
            assert (corner < 0) == (face < 0)
            if face >= 0:
                assert sorted([*edge, corner]) == sorted(mesh.faces[face])


@given(triangle_soups())
def test_neighbours_are_sorted_and_mutual(mesh: TriMesh):
    ring = vertex_neighbours(mesh.faces, mesh.vertex_count)
    pairs = {tuple(edge) for edge in edges(mesh.faces).tolist()}
    for vertex in range(mesh.vertex_count):
        others = ring.of(vertex).tolist()
        assert others == sorted(set(others))
        assert {(min(vertex, o), max(vertex, o)) for o in others} <= pairs
    assert ring.indptr[-1] == 2 * len(pairs)


def test_pieces_are_numbered_by_their_smallest_vertex():
    mesh = joined(cube(), grid(2, 2), sphere(0))
    turned = TriMesh(np.vstack([[[9, 9, 9]], mesh.positions]), (mesh.faces + 1)[::-1])
    pieces = components(turned.faces, turned.vertex_count)
    assert pieces.of_vertex.tolist() == [-1] + [0] * 8 + [1] * 9 + [2] * 12
    assert pieces.of_face.tolist() == [2] * 20 + [1] * 8 + [0] * 12
    assert pieces.piece_count == 3


def test_an_empty_mesh_has_nothing():
    none = np.zeros((0, 3), np.int32)
    assert edges(none).shape == (0, 2)
    assert components(none, 2).of_vertex.tolist() == [-1, -1]
    assert components(none, 2).piece_count == 0
    assert vertex_neighbours(none, 2).indptr.tolist() == [0, 0, 0]


def test_a_collapsed_face_neither_borders_nor_doubles_an_edge():
    faces = np.array([[0, 1, 2], [1, 1, 2], [2, 1, 3]], np.int32)
    table = edge_faces(faces)
    assert table.counts[table.edges.tolist().index([1, 2])] == 2
    assert table.face_edges[1].tolist() == [-1, -1, -1]
