from __future__ import annotations

import numpy as np
import pytest

from risorius.errors import MeshError
from risorius.mesh.core import TriMesh
from risorius.mesh.lids import LidMargins, find_lids
from tests.face_fixtures import builtin_face, mirror_vertices
from tests.synthetic import SlitSheet, slit_sheet

# An eye: 28 mm wide, open by 10.
EYE = {"half_width": 14.0, "opening": 10.0}


def _lids(sheet: SlitSheet, mesh: TriMesh | None = None, **options: float) -> LidMargins:
    upper, lower = sheet.middles
    outer, inner = sheet.corners
    return find_lids(
        mesh or sheet.mesh, inner=inner, outer=outer, upper=upper, lower=lower, **options
    )


@pytest.mark.parametrize("kind", ["slit", "bag"])
def test_margins_run_from_the_inner_to_the_outer_corner(kind) -> None:
    sheet = slit_sheet(kind, **EYE)
    margins = _lids(sheet)
    np.testing.assert_array_equal(margins.slit.upper, sheet.upper[::-1])
    np.testing.assert_array_equal(margins.slit.lower, sheet.lower[::-1])
    np.testing.assert_array_equal(margins.slit.inside, sheet.inside)


@pytest.mark.parametrize("kind", ["slit", "bag"])
def test_width_and_height_are_those_of_the_opening(kind) -> None:
    margins = _lids(slit_sheet(kind, **EYE))
    assert margins.width == pytest.approx(28.0)
    assert margins.height == pytest.approx(10.0)


def test_upper_and_lower_lid_are_told_apart_within_reach() -> None:
    sheet = slit_sheet("bag", **EYE)
    margins = _lids(sheet, reach=0.5)
    # Beside the corners, which belong to both margins, neither lid is nearer.
    x, y = np.abs(sheet.mesh.positions[:, :2]).T
    reached = np.isfinite(margins.distance) & (y > 1e-9) & (x < 13.9)
    assert 100 < reached.sum() < len(reached) / 2
    np.testing.assert_array_equal(margins.upper[reached], sheet.above[reached])
    np.testing.assert_array_equal(margins.lower[reached], ~sheet.above[reached])
    assert margins.distance[reached].max() <= 0.5 * margins.width


def test_beyond_the_reach_there_is_no_lid() -> None:
    margins = _lids(slit_sheet("bag", **EYE), reach=0.5)
    far = ~np.isfinite(margins.distance)
    assert far.any()
    assert not (margins.upper | margins.lower)[far].any()


def test_a_tilted_eye_is_as_high_as_a_level_one() -> None:
    sheet = slit_sheet("slit", **EYE)
    c, s = np.cos(0.2), np.sin(0.2)
    turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    tilted = TriMesh(sheet.mesh.positions @ turn.T, sheet.mesh.faces)
    assert _lids(sheet, tilted).height == pytest.approx(10.0)


def test_lids_that_are_welded_are_refused() -> None:
    sheet = slit_sheet("welded", half_width=14.0, opening=0.0)
    with pytest.raises(MeshError, match="they are welded, cut the mesh open between them"):
        find_lids(
            sheet.mesh,
            inner=sheet.corners[1],
            outer=sheet.corners[0],
            upper=sheet.nearest(0.0, 2.8),
            lower=sheet.nearest(0.0, -2.8),
        )


def test_the_built_in_eyes_are_mirror_images() -> None:
    face = builtin_face()
    partner = mirror_vertices(face.head.skin.mesh.positions)
    left, right = face.mechanics.margins["l"], face.mechanics.margins["r"]
    np.testing.assert_array_equal(partner[left.slit.upper], right.slit.upper)
    np.testing.assert_array_equal(partner[left.slit.lower], right.slit.lower)
    assert left.height == pytest.approx(right.height, rel=1e-12)
    assert 0.25 < left.height / left.width < 0.5
