from __future__ import annotations

import numpy as np
import pytest

from risorius.errors import MeshError
from risorius.mesh.core import TriMesh
from risorius.mesh.slit import edge_graph, find_slit, line_lengths, opened_vertices
from tests.synthetic import slit_sheet

STAR = np.array([[0, 0, 0], [-1, 1, 0], [1, 1, 0], [1, -1, 0], [-1, -1, 0]], float)


@pytest.mark.parametrize(
    ("faces", "opened"),
    [
        ([[0, 2, 1]], (False, True)),
        ([[0, 4, 3]], (True, False)),
        ([[0, 3, 2]], (True, True)),
        ([[0, 2, 1], [0, 4, 3]], (False, False)),
    ],
)
def test_a_vertex_is_opened_where_no_triangle_of_its_star_lies(faces, opened) -> None:
    up, down = opened_vertices(TriMesh(STAR, np.array(faces)))
    assert (bool(up[0]), bool(down[0])) == opened


def test_turning_the_face_over_exchanges_upper_and_lower_opened() -> None:
    sheet = slit_sheet("bag").mesh
    up, down = opened_vertices(sheet)
    flipped = TriMesh(sheet.positions * [1.0, -1.0, 1.0], sheet.faces[:, ::-1])
    down_again, up_again = opened_vertices(flipped)
    np.testing.assert_array_equal(up_again, up)
    np.testing.assert_array_equal(down_again, down)


def test_unused_vertices_are_not_opened() -> None:
    up, down = opened_vertices(TriMesh(STAR, np.array([[0, 2, 1]])))
    assert not up[4]
    assert not down[4]


@pytest.mark.parametrize("kind", ["slit", "bag"])
def test_both_lines_are_found_vertex_for_vertex(kind) -> None:
    sheet = slit_sheet(kind)
    upper, lower = sheet.middles
    slit = find_slit(sheet.mesh, corners=sheet.corners, upper=[upper], lower=[lower])
    assert slit.corners == sheet.corners
    np.testing.assert_array_equal(slit.upper, sheet.upper)
    np.testing.assert_array_equal(slit.lower, sheet.lower)
    np.testing.assert_array_equal(slit.inside, sheet.inside)


@pytest.mark.parametrize("kind", ["slit", "bag"])
def test_poor_corner_landmarks_do_not_move_the_commissures(kind) -> None:
    sheet = slit_sheet(kind)
    upper, lower = sheet.middles
    near = (sheet.nearest(29.0, 4.0), sheet.nearest(-31.0, -5.0))
    assert near != sheet.corners
    slit = find_slit(sheet.mesh, corners=near, upper=[upper], lower=[lower])
    assert slit.corners == sheet.corners


@pytest.mark.parametrize("kind", ["slit", "bag"])
def test_exact_corners_are_taken_as_they_are(kind) -> None:
    sheet = slit_sheet(kind)
    upper, lower = sheet.middles
    slit = find_slit(
        sheet.mesh, corners=sheet.corners, upper=[upper], lower=[lower], exact_corners=True
    )
    np.testing.assert_array_equal(slit.upper, sheet.upper)
    np.testing.assert_array_equal(slit.lower, sheet.lower)


def test_the_frontal_test_confirms_all_of_the_lines_but_the_corners() -> None:
    sheet = slit_sheet("bag")
    upper, lower = sheet.middles
    slit = find_slit(sheet.mesh, corners=sheet.corners, upper=[upper], lower=[lower])
    assert slit.opened_share == pytest.approx(1.0 - 4.0 / (len(slit.upper) + len(slit.lower)))


def test_the_size_of_the_head_does_not_matter() -> None:
    sheet = slit_sheet("bag")
    upper, lower = sheet.middles
    large = TriMesh(1000.0 * sheet.mesh.positions, sheet.mesh.faces)
    slit = find_slit(large, corners=sheet.corners, upper=[upper], lower=[lower])
    np.testing.assert_array_equal(slit.upper, sheet.upper)
    np.testing.assert_array_equal(slit.lower, sheet.lower)


def test_welded_lips_are_refused_with_the_way_out() -> None:
    sheet = slit_sheet("welded")
    with pytest.raises(MeshError, match="they are welded, cut the mesh open between them"):
        find_slit(
            sheet.mesh,
            corners=sheet.corners,
            upper=[sheet.nearest(0.0, 5.0)],
            lower=[sheet.nearest(0.0, -5.0)],
        )


def test_lines_that_share_a_vertex_are_refused() -> None:
    # Two diamonds that hang together at one vertex: both lines must pass it.
    plane = 10.0 * np.array([[0, 0], [1, 1], [1, -1], [2, 0], [3, 1], [3, -1], [4, 0]], float)
    mesh = TriMesh(
        np.column_stack([plane, np.zeros(7)]),
        np.array([[0, 2, 1], [1, 2, 3], [3, 5, 4], [4, 5, 6]]),
    )
    with pytest.raises(MeshError, match=r"share vertex 3; they are welded, cut the mesh open"):
        find_slit(mesh, corners=(0, 6), upper=[1], lower=[2], exact_corners=True)


@pytest.mark.parametrize("turn", [0, 1, 2])
def test_lines_do_not_depend_on_the_corner_that_a_face_starts_with(turn: int) -> None:
    sheet = slit_sheet("slit")
    turned = TriMesh(sheet.mesh.positions, np.roll(sheet.mesh.faces, turn, axis=1))
    hints = {"upper": [sheet.nearest(0.0, 5.0)], "lower": [sheet.nearest(0.0, -5.0)]}
    slit = find_slit(turned, corners=sheet.corners, exact_corners=True, **hints)
    assert not np.intersect1d(slit.upper[1:-1], slit.lower[1:-1]).size


def test_corners_at_one_point_are_refused() -> None:
    sheet = slit_sheet("slit")
    with pytest.raises(MeshError, match="its two corners are one point; check the landmarks"):
        find_slit(sheet.mesh, corners=(3, 3), upper=[5], lower=[6])


def test_landmarks_on_another_piece_of_skin_are_refused() -> None:
    sheet = slit_sheet("slit")
    count = sheet.mesh.vertex_count
    behind = sheet.mesh.positions - np.array([0.0, 0.0, 300.0])
    two = TriMesh(
        np.concatenate([sheet.mesh.positions, behind]),
        np.concatenate([sheet.mesh.faces, sheet.mesh.faces + count]),
    )
    upper, lower = sheet.middles
    with pytest.raises(MeshError, match=r"vertices \d+ and \d+ are not connected on the skin"):
        find_slit(two, corners=sheet.corners, upper=[upper + count], lower=[lower])


def test_edges_weigh_their_length_and_count_once() -> None:
    positions = np.array([[0, 0, 0], [3, 0, 0], [3, 4, 0], [0, 4, 0]], float)
    graph = edge_graph(TriMesh(positions, np.array([[0, 1, 2], [0, 2, 3]])))
    expected = np.zeros((4, 4))
    for a, b, length in ((0, 1, 3), (1, 2, 4), (0, 2, 5), (2, 3, 3), (3, 0, 4)):
        expected[a, b] = expected[b, a] = length
    np.testing.assert_array_equal(graph.toarray(), expected)


def test_an_edge_without_length_stays_an_edge() -> None:
    positions = np.array([[0, 0, 0], [0, 0, 0], [3, 4, 0]], float)
    graph = edge_graph(TriMesh(positions, np.array([[0, 1, 2]])))
    assert graph.nnz == 6
    assert graph[0, 1] > 0.0


def test_places_along_a_line_are_shares_of_its_length() -> None:
    positions = np.array([[0, 0, 0], [1, 0, 0], [1, 3, 0], [1, 3, 4]], float)
    np.testing.assert_allclose(line_lengths(positions, np.arange(4)), [0.0, 0.125, 0.5, 1.0])


def test_a_line_without_length_is_spread_evenly() -> None:
    np.testing.assert_array_equal(line_lengths(np.zeros((3, 3)), np.arange(3)), [0.0, 0.5, 1.0])
