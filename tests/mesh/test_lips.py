from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from risorius.errors import MeshError
from risorius.mesh.core import TriMesh
from risorius.mesh.lips import LipSides, find_lips
from tests.face_fixtures import builtin_face, mirror_vertices
from tests.synthetic import SlitSheet, slit_sheet


def _lips(sheet: SlitSheet, mesh: TriMesh | None = None) -> LipSides:
    upper, lower = sheet.middles
    return find_lips(
        mesh or sheet.mesh,
        corners=sheet.corners,
        upper=upper,
        lower=lower,
        outer=(sheet.nearest(0.0, 10.0), sheet.nearest(0.0, -10.0)),
    )


@pytest.mark.parametrize("kind", ["slit", "bag"])
def test_every_vertex_is_labelled_as_built(kind) -> None:
    sheet = slit_sheet(kind)
    lips = _lips(sheet)
    off_border = np.abs(sheet.mesh.positions[:, 1]) > 1e-9
    np.testing.assert_array_equal(lips.upper[off_border], sheet.above[off_border])
    np.testing.assert_array_equal(lips.lower[off_border], ~sheet.above[off_border])
    np.testing.assert_array_equal(lips.inside, sheet.inside)


def test_the_bag_has_a_roof_and_a_floor() -> None:
    lips = _lips(slit_sheet("bag"))
    assert (lips.inside & lips.upper).sum() >= 20
    assert (lips.inside & lips.lower).sum() >= 20


@pytest.mark.parametrize("kind", ["slit", "bag"])
def test_the_share_is_0_on_the_upper_lip_half_in_the_corners_and_1_on_the_lower(kind) -> None:
    sheet = slit_sheet(kind)
    share = _lips(sheet).share()
    np.testing.assert_array_equal(share[sheet.upper[1:-1]], 0.0)
    np.testing.assert_array_equal(share[sheet.lower[1:-1]], 1.0)
    np.testing.assert_allclose(share[list(sheet.corners)], 0.5)
    assert (share[sheet.above] < 0.5).all()


def test_pieces_that_are_not_connected_are_neither_side() -> None:
    sheet = slit_sheet("slit")
    loose = TriMesh(
        np.concatenate([sheet.mesh.positions, 200.0 + np.eye(3)]),
        np.concatenate([sheet.mesh.faces, [[534, 535, 536]]]),
    )
    lips = _lips(sheet, loose)
    assert np.isinf(lips.distance[534:]).all()
    assert not (lips.upper | lips.lower)[534:].any()
    np.testing.assert_array_equal(lips.share()[534:], 0.5)


def test_seam_pairs_stand_opposite_each_other_and_leave_the_corners_out() -> None:
    sheet = slit_sheet("bag")
    lips = _lips(sheet)
    pairs = lips.pairs(sheet.mesh.positions)
    np.testing.assert_array_equal(pairs, np.stack([sheet.upper, sheet.lower], axis=1)[1:-1])
    assert not lips.corner[pairs].any()
    assert lips.corner[list(sheet.corners)].all()


def test_the_width_is_the_distance_of_the_corners() -> None:
    lips = _lips(slit_sheet("slit"))
    assert lips.width == pytest.approx(50.0)
    np.testing.assert_array_equal(lips.to_corner[list(lips.slit.corners)], 0.0)


def test_labels_survive_a_tilt_and_a_change_of_size() -> None:
    sheet = slit_sheet("bag")
    turn = Rotation.from_euler("xyz", [6, -7, 5], degrees=True).as_matrix()
    moved = TriMesh(7.0 * sheet.mesh.positions @ turn.T + (5.0, 6.0, 7.0), sheet.mesh.faces)
    before, after = _lips(sheet), _lips(sheet, moved)
    np.testing.assert_array_equal(after.slit.upper, before.slit.upper)
    np.testing.assert_array_equal(after.slit.lower, before.slit.lower)
    np.testing.assert_allclose(after.distance, 7.0 * before.distance)


def test_welded_lips_are_refused() -> None:
    sheet = slit_sheet("welded")
    with pytest.raises(MeshError, match=r"10 mm of skin join the upper and the lower .* welded"):
        find_lips(
            sheet.mesh,
            corners=sheet.corners,
            upper=sheet.nearest(0.0, 5.0),
            lower=sheet.nearest(0.0, -5.0),
            outer=(sheet.nearest(0.0, 10.0), sheet.nearest(0.0, -10.0)),
        )


def test_the_built_in_lips_part_in_their_sculpted_corners() -> None:
    head = builtin_face().head
    slit = builtin_face().mechanics.lips.slit
    assert slit.corners == (head.skin_vertex("2.4"), head.skin_vertex("2.5"))
    assert slit.opened_share > 0.7


def test_the_built_in_lips_are_labelled_alike_on_both_sides() -> None:
    head, lips = builtin_face().head, builtin_face().mechanics.lips
    partner = mirror_vertices(head.skin.mesh.positions)
    share = lips.share()
    near = lips.distance < lips.width
    np.testing.assert_allclose(share[partner][near], share[near], atol=1e-9)
    np.testing.assert_array_equal(lips.inside[partner], lips.inside)
    for line in (lips.slit.upper, lips.slit.lower):
        np.testing.assert_array_equal(partner[line][::-1], line)


def test_the_built_in_red_of_the_lips_carries_its_side() -> None:
    head, lips = builtin_face().head, builtin_face().mechanics.lips
    for group, mine, other in (
        ("vermilion_upper", lips.upper, lips.lower),
        ("vermilion_lower", lips.lower, lips.upper),
    ):
        polygons = head.source.groups.polygons(group)
        assert len(polygons) > 50
        chosen = np.isin(head.source.triangle_polygon, polygons)
        vertices = head.skin.from_source(
            np.unique(head.source.triangles[chosen]), vertex_count=head.vertex_count
        )
        clear = vertices[lips.to_corner[vertices] > 0.12 * lips.width]
        assert mine[clear].mean() > 0.97
        assert not (other & lips.corner)[clear].any()
