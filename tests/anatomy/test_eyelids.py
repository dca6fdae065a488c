from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from risorius.anatomy.eyelids import Eyelids, LidParameters, build_eyelids
from risorius.head.eyes import EYE_LANDMARKS
from risorius.mesh.core import TriMesh
from risorius.mesh.lids import LidMargins, find_lids
from tests.face_fixtures import builtin_face, mirror_vertices
from tests.synthetic import SlitSheet, slit_sheet, sphere

SHEET = slit_sheet("bag", half_width=14.0, opening=10.0)


def _margins(sheet: SlitSheet = SHEET) -> LidMargins:
    upper, lower = sheet.middles
    outer, inner = sheet.corners
    return find_lids(sheet.mesh, inner=inner, outer=outer, upper=upper, lower=lower)


def _lids(parameters: LidParameters | None = None) -> Eyelids:
    return build_eyelids(SHEET.mesh, _margins(), None, None, parameters=parameters)


def _pitch(lids: Eyelids, points: np.ndarray) -> np.ndarray:
    up = np.cross([0.0, 0.0, 1.0], lids.axis)
    arm = points - lids.centre
    return np.arctan2(arm @ up, arm[..., 2])


LIDS = _lids()
REST = SHEET.mesh.positions


def test_open_lids_are_the_skin_itself() -> None:
    assert LIDS.move(REST, upper=0.0, lower=0.0) is REST


def test_closed_margins_meet_all_along_the_eye() -> None:
    moved = LIDS.move(REST, upper=1.0, lower=1.0)
    opening = _pitch(LIDS, REST[SHEET.upper]) - _pitch(LIDS, REST[SHEET.lower])
    gap = _pitch(LIDS, moved[SHEET.upper]) - _pitch(LIDS, moved[SHEET.lower])
    assert np.abs(gap).max() < 0.03 * opening.max()


def test_the_upper_lid_makes_most_of_the_way() -> None:
    moved = LIDS.move(REST, upper=1.0, lower=1.0)
    upper, lower = SHEET.middles
    opening = _pitch(LIDS, REST[upper]) - _pitch(LIDS, REST[lower])
    assert _pitch(LIDS, REST[upper]) - _pitch(LIDS, moved[upper]) == pytest.approx(
        0.85 * opening, rel=0.02
    )
    assert _pitch(LIDS, moved[lower]) - _pitch(LIDS, REST[lower]) == pytest.approx(
        0.15 * opening, rel=0.02
    )


def test_each_lid_moves_alone() -> None:
    only_upper = LIDS.move(REST, upper=1.0, lower=0.0)
    only_lower = LIDS.move(REST, upper=0.0, lower=1.0)
    both = LIDS.move(REST, upper=1.0, lower=1.0)
    lower_side = ~SHEET.above & (np.abs(REST[:, 1]) > 1e-9)
    np.testing.assert_array_equal(only_upper[lower_side], REST[lower_side])
    np.testing.assert_array_equal(both[lower_side], only_lower[lower_side])
    np.testing.assert_array_equal(both[SHEET.above], only_upper[SHEET.above])


@given(st.floats(-1.0, 1.0), st.floats(-1.0, 1.0))
def test_corners_stay_and_lids_keep_their_distance_from_the_axis(upper, lower) -> None:
    moved = LIDS.move(REST, upper=upper, lower=lower)
    np.testing.assert_allclose(moved[list(SHEET.corners)], REST[list(SHEET.corners)], atol=1e-9)
    for points in (moved, REST):
        assert np.isfinite(points).all()
    across = np.eye(3) - np.outer(LIDS.axis, LIDS.axis)
    before, after = (np.linalg.norm((p - LIDS.centre) @ across, axis=1) for p in (REST, moved))
    np.testing.assert_allclose(after, before, atol=1e-9)


def test_the_lid_angle_grows_with_the_control() -> None:
    upper = SHEET.middles[0]
    pitch = [
        _pitch(LIDS, LIDS.move(REST, upper=u, lower=0.0)[upper]) for u in np.linspace(-1, 1, 9)
    ]
    assert (np.diff(pitch) < 0.0).all()


def test_a_wide_eye_opens_upwards_and_downwards() -> None:
    moved = LIDS.move(REST, upper=-1.0, lower=-1.0)
    upper, lower = SHEET.middles
    assert moved[upper, 1] > REST[upper, 1] + 0.5
    assert moved[lower, 1] < REST[lower, 1] - 0.5


def test_an_opening_upper_lid_rises_as_one_plate_and_a_closing_one_stretches() -> None:
    margins, p = _margins(), LIDS.parameters
    away = margins.distance[LIDS.vertices] / margins.height
    middle = LIDS.upper & ~SHEET.inside[LIDS.vertices] & (np.abs(LIDS.place - 0.5) < 0.35)
    plate, beyond = middle & (away < p.plate), middle & (away > 1.001 * p.crease)
    width = np.maximum(LIDS.opening, 1e-9)
    opened = LIDS.angles(upper=-1.0, lower=0.0) / width
    closed = LIDS.angles(upper=1.0, lower=0.0) / width
    assert plate.sum() > 10
    np.testing.assert_allclose(opened[plate], -p.wide, rtol=1e-9)
    assert np.ptp(closed[plate]) > 0.1 * closed[plate].max()
    assert not opened[beyond].any()


def test_skin_beyond_the_band_keeps_still() -> None:
    parameters = LidParameters(upper_band=0.6, lower_band=0.4)
    narrow = _lids(parameters)
    moved = narrow.move(REST, upper=1.0, lower=1.0) - REST
    distance = _margins().distance
    front = ~SHEET.inside
    still = front & (distance > np.where(SHEET.above, 6.0, 4.0) * 1.0001)
    assert still.sum() > 100
    np.testing.assert_array_equal(moved[still], 0.0)
    assert len(narrow.vertices) < len(LIDS.vertices)


def test_a_closed_eye_has_nothing_to_close_and_still_opens() -> None:
    sheet = slit_sheet("bag", half_width=14.0, opening=0.0)
    lids = build_eyelids(sheet.mesh, _margins(sheet), None, None)
    closed = lids.move(sheet.mesh.positions, upper=1.0, lower=1.0)
    np.testing.assert_allclose(closed, sheet.mesh.positions, atol=1e-6)


def test_lids_slide_over_the_eyeball_and_never_through_it() -> None:
    points, polygons = sphere((0.0, 0.0, 76.5), (12.4, 12.4, 12.4), rows=24, columns=36)
    faces = [(p[0], p[k], p[k + 1]) for p in polygons for k in range(1, len(p) - 1)]
    centre = np.array([0.0, 0.0, 76.5])
    lids = build_eyelids(SHEET.mesh, _margins(), TriMesh(points, np.array(faces)), centre)
    for upper in np.linspace(0.1, 1.0, 10):
        moved = lids.move(REST, upper=upper, lower=upper)
        turned = lids.vertices[lids.angles(upper=upper, lower=upper) != 0.0]
        outside = np.linalg.norm(REST[turned] - centre, axis=1) > 12.65
        assert outside.sum() > 40
        assert np.linalg.norm(moved[turned[outside]] - centre, axis=1).min() > 12.4


def test_a_ball_far_away_is_not_taken_as_the_eye() -> None:
    points, polygons = sphere((200.0, 0.0, 60.0), (12.0,) * 3)
    faces = [(p[0], p[k], p[k + 1]) for p in polygons for k in range(1, len(p) - 1)]
    ball = TriMesh(points, np.array(faces))
    lids = build_eyelids(SHEET.mesh, _margins(), ball, np.array([200.0, 0.0, 60.0]))
    assert lids.surface is None
    np.testing.assert_array_equal(lids.centre, LIDS.centre)


def test_lids_ride_over_the_cornea_of_an_eye_that_looks_aside() -> None:
    points, polygons = sphere((0.0, 0.0, 0.0), (12.0,) * 3, rows=40, columns=60)
    faces = [(p[0], p[k], p[k + 1]) for p in polygons for k in range(1, len(p) - 1)]
    arm = points / 12.0
    points = points + 1.5 * np.clip((arm[:, 2:] - 0.85) / 0.15, 0.0, 1.0) * arm
    eye = TriMesh(points + LIDS.centre, np.array(faces))
    lids = build_eyelids(SHEET.mesh, _margins(), eye, LIDS.centre)
    skin = REST.copy()
    aside = 12.3 * np.array([np.sin(0.7), 0.0, np.cos(0.7)])
    nearest = lids.vertices[
        np.linalg.norm(REST[lids.vertices] - lids.centre - aside, axis=1).argmin()
    ]
    skin[nearest] = lids.centre + aside
    looking = lids.move(skin, upper=0.0, lower=0.0, gaze=(np.degrees(0.7), 0.0))
    assert np.linalg.norm(looking[nearest] - lids.centre) > 13.0
    away = lids.move(skin, upper=0.0, lower=0.0, gaze=(-np.degrees(0.7), 0.0))
    np.testing.assert_array_equal(away[nearest], skin[nearest])
    assert lids.move(skin, upper=0.0, lower=0.0, gaze=(0.0, 0.0)) is skin


@pytest.mark.parametrize("side", ["l", "r"])
def test_the_built_in_eye_closes_within_5_percent_at_its_landmarks(side: str) -> None:
    face = builtin_face()
    head, lids = face.head, face.mechanics.lids[side]
    inner, outer, upper, lower = (head.skin_vertex(name) for name in EYE_LANDMARKS[side])
    rest = head.skin.mesh.positions
    pose = {f"lid_upper_{side}": 1.0, f"lid_lower_{side}": 1.0}
    moved = face.pose(pose)[head.skin.first_source()]
    opening = _pitch(lids, rest[upper]) - _pitch(lids, rest[lower])
    gap = _pitch(lids, moved[upper]) - _pitch(lids, moved[lower])
    assert opening > 0.3
    assert abs(gap) < 0.05 * opening
    for corner in (inner, outer):
        height = face.mechanics.margins[side].height
        assert np.linalg.norm(moved[corner] - rest[corner]) < 0.01 * height


def test_a_wink_leaves_the_other_eye_open() -> None:
    face = builtin_face()
    moved = face.displace({"lid_upper_l": 1.0, "lid_lower_l": 1.0})
    right = face.head.positions[:, 0] < -1.0
    np.testing.assert_array_equal(moved[right], 0.0)
    assert np.abs(moved[~right]).max() > 5.0


def test_both_built_in_lids_move_alike() -> None:
    face = builtin_face()
    part = face.head.skin
    partner = mirror_vertices(part.mesh.positions)
    left = face.displace({"lid_upper_l": 0.7, "lid_lower_l": -0.5})[part.first_source()]
    right = face.displace({"lid_upper_r": 0.7, "lid_lower_r": -0.5})[part.first_source()]
    np.testing.assert_allclose(right[partner] * [-1.0, 1.0, 1.0], left, atol=1e-6)
