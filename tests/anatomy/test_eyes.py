from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from risorius.anatomy.eyes import Eyeball, fit_eyeball, texture_shift, turn_back
from risorius.mesh.core import TriMesh
from tests.face_fixtures import builtin_face
from tests.synthetic import Piece, sphere

CENTRE = (31.0, 0.0, -11.0)
EYE = Eyeball(np.array(CENTRE), 12.0, True)
PUPIL = np.array([31.0, 0.0, 1.0])


def _mesh(piece: Piece) -> TriMesh:
    points, polygons = piece
    faces = [(p[0], p[k], p[k + 1]) for p in polygons for k in range(1, len(p) - 1)]
    return TriMesh(points, np.array(faces))


def test_a_round_eye_is_measured_exactly() -> None:
    eye = fit_eyeball(_mesh(sphere(CENTRE, (12.0, 12.0, 12.0))))
    np.testing.assert_allclose(eye.centre, CENTRE, atol=1e-9)
    assert eye.radius == pytest.approx(12.0, rel=1e-12)
    assert eye.is_round


def test_the_front_half_of_an_eye_is_enough() -> None:
    whole = _mesh(sphere(CENTRE, (12.0, 12.0, 12.0), rows=14, columns=20))
    front = whole.positions[whole.positions[:, 2] > -8.0]
    eye = fit_eyeball(TriMesh(front, np.array([[0, 1, 2]])))
    np.testing.assert_allclose(eye.centre, CENTRE, atol=1e-9)


def test_a_flat_eye_is_not_round() -> None:
    assert not fit_eyeball(_mesh(sphere(CENTRE, (16.0, 16.0, 5.0)))).is_round


def test_positive_yaw_looks_left_and_positive_pitch_up() -> None:
    left = EYE.turn([PUPIL], yaw=20.0, pitch=0.0)[0] - PUPIL
    up = EYE.turn([PUPIL], yaw=0.0, pitch=20.0)[0] - PUPIL
    np.testing.assert_allclose(
        left, [12 * np.sin(0.349066), 0, 12 * np.cos(0.349066) - 12], atol=1e-5
    )
    np.testing.assert_allclose(
        up, [0, 12 * np.sin(0.349066), 12 * np.cos(0.349066) - 12], atol=1e-5
    )


@given(st.floats(-40, 40), st.floats(-35, 30))
def test_the_line_of_sight_reaches_the_angles_asked_for(yaw: float, pitch: float) -> None:
    sight = (EYE.turn([PUPIL], yaw=yaw, pitch=pitch)[0] - EYE.centre) / 12.0
    assert np.degrees(np.arctan2(sight[0], sight[2])) == pytest.approx(yaw, abs=1e-9)
    assert np.degrees(np.arcsin(sight[1])) == pytest.approx(pitch, abs=1e-9)


def test_a_turning_eye_stays_in_its_socket() -> None:
    face = builtin_face()
    part = face.head.parts["eye_left"]
    eye = face.mechanics.eyes["l"]
    moved = face.pose({"gaze_yaw_l": 30.0, "gaze_pitch_l": -20.0})[part.source]
    before = np.linalg.norm(face.head.positions[part.source] - eye.centre, axis=1)
    np.testing.assert_allclose(np.linalg.norm(moved - eye.centre, axis=1), before, atol=1e-9)


def test_one_eye_turns_alone_and_its_lids_ride_over_the_cornea() -> None:
    face = builtin_face()
    moved = np.linalg.norm(face.displace({"gaze_yaw_l": 30.0}), axis=1)
    head = face.head
    assert moved[head.parts["eye_left"].source].max() > 3.0
    near = np.linalg.norm(head.positions - face.mechanics.eyes["l"].centre, axis=1) < 25.0
    np.testing.assert_array_equal(moved[~near], 0.0)
    assert moved[head.parts["skin"].source].max() < 1.5


def test_the_texture_shifts_against_the_gaze_as_published() -> None:
    assert texture_shift(yaw=18.0, pitch=9.0) == pytest.approx((-0.1, 0.05))
    assert texture_shift(yaw=18.0, pitch=9.0, uv_width=0.5, view_degrees=90.0) == pytest.approx(
        (-0.1, 0.05)
    )


def test_the_iris_stays_on_the_texture() -> None:
    assert texture_shift(yaw=-170.0, pitch=-170.0) == (0.25, -0.25)
    assert texture_shift(yaw=170.0, pitch=170.0, uv_width=0.4) == pytest.approx((-0.1, 0.1))


@given(st.floats(-40, 40), st.floats(-35, 30))
def test_turning_back_undoes_a_turn(yaw: float, pitch: float) -> None:
    eye = Eyeball(np.zeros(3), 12.0, True)
    arms = np.random.default_rng(2).normal(size=(20, 3))
    turned = eye.turn(arms, yaw=yaw, pitch=pitch)
    np.testing.assert_allclose(turn_back(turned, yaw=yaw, pitch=pitch), arms, atol=1e-12)
