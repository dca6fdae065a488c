from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from risorius.errors import ShapeError
from risorius.mesh.polygon_mesh import Labels, PolygonMesh
from tests.synthetic import quad_mesh

MESH = quad_mesh()
EMPTY = np.zeros(0, np.int32)


def _int(*values: int) -> np.ndarray:
    return np.array(values, np.int32)


def _area(positions: np.ndarray, faces: np.ndarray) -> float:
    a, b, c = (positions[faces[:, i]] for i in range(3))
    return float(0.5 * np.cross(b - a, c - a)[:, 2].sum())


def test_counts_are_those_of_the_polygons() -> None:
    assert (MESH.vertex_count, MESH.polygon_count, len(MESH.corners)) == (8, 3, 12)


def test_polygons_become_fans_from_their_first_corner_in_order() -> None:
    np.testing.assert_array_equal(
        MESH.triangles,
        [[0, 1, 2], [0, 2, 3], [3, 2, 4], [1, 5, 6], [1, 6, 7], [1, 7, 2]],
    )
    np.testing.assert_array_equal(MESH.triangle_polygon, [0, 0, 1, 2, 2, 2])
    np.testing.assert_array_equal(MESH.corners[MESH.triangle_corners], MESH.triangles)


def test_triangulation_keeps_area_and_winding() -> None:
    assert _area(MESH.positions, MESH.triangles) == pytest.approx(1.0 + 0.5 + 2.5)


def test_polygons_of_fewer_than_three_corners_make_no_triangles() -> None:
    mesh = PolygonMesh.from_polygons(MESH.positions, [[0], [0, 1], [0, 1, 2], []])
    assert mesh.polygon_count == 4
    np.testing.assert_array_equal(mesh.triangles, [[0, 1, 2]])
    np.testing.assert_array_equal(mesh.triangle_polygon, [2])


def test_a_mesh_without_polygons_has_no_triangles() -> None:
    mesh = PolygonMesh.from_polygons(MESH.positions, [])
    assert mesh.polygon_count == 0
    assert mesh.triangles.shape == (0, 3)
    assert mesh.tri_mesh().face_count == 0


@given(
    st.lists(
        st.integers(0, 9).flatmap(lambda n: st.lists(st.integers(0, 7), min_size=n, max_size=n))
    )
)
def test_any_polygons_are_kept_and_triangulated_like_a_plain_loop(polygons) -> None:
    mesh = PolygonMesh.from_polygons(MESH.positions, polygons)
    kept = [mesh.corners[a:b].tolist() for a, b in zip(mesh.offsets, mesh.offsets[1:])]
    assert kept == polygons
    fans = [[p[0], p[i], p[i + 1]] for p in polygons for i in range(1, len(p) - 1)]
    assert mesh.triangles.tolist() == fans


def test_the_triangle_mesh_has_the_same_vertices() -> None:
    mesh = MESH.tri_mesh()
    np.testing.assert_array_equal(mesh.positions, MESH.positions)
    np.testing.assert_array_equal(mesh.faces, MESH.triangles)


def test_positions_are_kept_bit_for_bit() -> None:
    positions = np.random.default_rng(1).normal(size=(8, 3)) * 1e5
    mesh = PolygonMesh(positions, MESH.corners, MESH.offsets)
    assert mesh.positions.tobytes() == positions.tobytes()


def test_labels_list_the_polygons_of_a_name() -> None:
    labels = Labels(("skin", "teeth"), _int(0, -1, 0))
    np.testing.assert_array_equal(labels.polygons("skin"), [0, 2])
    assert len(labels.polygons("teeth")) == 0
    assert len(labels.polygons("hair")) == 0
    assert len(Labels().polygons("skin")) == 0


def test_uv_corners_and_labels_and_targets_are_accepted_when_they_fit() -> None:
    uv_corners = np.full(12, -1, np.int32)
    uv_corners[:3] = (0, 1, 2)
    mesh = PolygonMesh(
        MESH.positions,
        MESH.corners,
        MESH.offsets,
        uvs=np.eye(3)[:, :2],
        uv_corners=uv_corners,
        groups=Labels(("a", "b"), _int(1, 0, -1)),
        targets={"jawOpen": np.ones((8, 3))},
    )
    assert mesh.groups.polygons("a").tolist() == [1]


def _refused(**changes: object) -> str:
    fields = {"positions": MESH.positions, "corners": MESH.corners, "offsets": MESH.offsets}
    with pytest.raises(ShapeError) as caught:
        PolygonMesh(**(fields | changes))  # pyright: ignore
    return str(caught.value)


def test_positions_of_a_wrong_shape_are_refused() -> None:
    assert _refused(positions=np.zeros((8, 2))) == "positions: expected shape (n, 3), got (8, 2)"


def test_a_position_that_is_not_finite_is_refused_by_row() -> None:
    positions = MESH.positions.copy()
    positions[5, 1] = np.nan
    assert "positions: row 5 is [2.0, nan, 0.0]" in _refused(positions=positions)


@pytest.mark.parametrize("offsets", [_int(), _int(1, 4, 7, 12), _int(0, 4, 7, 11)])
def test_offsets_that_do_not_span_the_corners_are_refused(offsets: np.ndarray) -> None:
    message = "offsets: must start at 0 and end at the number of corners"
    assert _refused(offsets=offsets) == message


def test_offsets_that_go_back_are_refused() -> None:
    assert _refused(offsets=_int(0, 7, 4, 12)) == "offsets: must not decrease"


@pytest.mark.parametrize("bad", [-1, 8])
def test_a_corner_without_a_vertex_is_refused_by_place(bad: int) -> None:
    corners = MESH.corners.copy()
    corners[6] = bad
    assert _refused(corners=corners) == f"corners: entry 6 is {bad}, indices must lie in 0..7"


def test_texture_corners_must_match_in_number_and_range() -> None:
    uvs = np.zeros((3, 2))
    assert _refused(uvs=uvs, uv_corners=_int(0, 1)) == "uv_corners: expected 12 entries or none"
    corners = np.zeros(12, np.int32)
    corners[4] = 3
    message = "uv_corners: entry 4 is 3, indices must lie in -1..2"
    assert _refused(uvs=uvs, uv_corners=corners) == message


@pytest.mark.parametrize("kind", ["objects", "groups", "materials"])
def test_labels_must_match_in_number_and_range(kind: str) -> None:
    assert _refused(**{kind: Labels(("a",), _int(0, 0))}) == f"{kind}: expected 3 entries or none"
    message = f"{kind}: entry 1 is 1, indices must lie in -1..0"
    assert _refused(**{kind: Labels(("a",), _int(0, 1, 0))}) == message


def test_a_target_of_another_size_is_refused_by_name() -> None:
    message = _refused(targets={"jawOpen": np.zeros((7, 3))})
    assert message == "target 'jawOpen': expected shape (8, 3)"
