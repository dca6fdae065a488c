from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from risorius.head.part_geometry import (
    fit_sphere,
    kind_of_component,
    side_of_component,
    upper_or_lower,
)
from tests.synthetic import arch, head_pieces, landmark_points, landmark_set, sphere

MARKS = landmark_set()
PIECES = {name: points for name, (points, _) in head_pieces().items()}


@given(
    st.tuples(*[st.floats(-1e3, 1e3)] * 3),
    st.floats(1e-2, 1e3),
    arrays(float, (30, 3), elements=st.floats(-1.0, 1.0)),
)
def test_points_of_a_sphere_give_it_back(centre, radius: float, directions) -> None:
    length = np.linalg.norm(directions, axis=1)
    unit = directions[length > 0.1] / length[length > 0.1, None]
    if len(unit) < 4 or np.linalg.matrix_rank(unit[1:] - unit[0], tol=0.3) < 3:
        unit = np.concatenate([np.eye(3), -np.eye(3)])
    found, found_radius, residual = fit_sphere(np.asarray(centre) + radius * unit)
    scale = radius + np.abs(centre).max()
    assert np.abs(found - centre).max() < 1e-6 * scale
    assert abs(found_radius - radius) < 1e-6 * scale
    assert residual < 1e-6 * scale


def test_a_flattened_sphere_leaves_a_residual() -> None:
    _, radius, residual = fit_sphere(sphere((0, 0, 0), (10.0, 10.0, 5.0))[0])
    assert residual > 0.1 * radius


def test_points_of_a_plane_do_not_crash() -> None:
    flat = np.random.default_rng(0).normal(size=(20, 3)) * [1.0, 1.0, 0.0]
    _, radius, _ = fit_sphere(flat)
    assert np.isfinite(radius)


@pytest.mark.parametrize(
    ("piece", "kind"),
    [
        ("eye_left", "eye_left"),
        ("eye_right", "eye_right"),
        ("teeth_upper", "teeth_upper"),
        ("teeth_lower", "teeth_lower"),
        ("tongue", "tongue"),
    ],
)
def test_a_nameless_piece_is_known_by_its_shape_and_place(piece: str, kind: str) -> None:
    assert kind_of_component(PIECES[piece], MARKS) == kind


def test_hair_along_a_lid_is_lashes() -> None:
    turn = np.linspace(-1.0, 1.0, 12)
    strip = np.stack([31.5 + 14.0 * turn, 5.0 - 4.0 * turn**2, 66.0 - 4.0 * turn**2], axis=1)
    hair = np.concatenate([strip, strip + np.array([0.0, 3.0, 5.0])])
    assert kind_of_component(hair, MARKS) == "lashes_left"
    assert kind_of_component(hair * [-1.0, 1.0, 1.0], MARKS) == "lashes_right"


@pytest.mark.parametrize(
    "move", [(0.0, 200.0, 0.0), (0.0, 0.0, -200.0), (150.0, 0.0, 0.0), (0.0, -160.0, 0.0)]
)
def test_what_lies_elsewhere_moves_with_the_skull(move) -> None:
    for points in (PIECES["tongue"], PIECES["eye_left"], PIECES["teeth_upper"]):
        assert kind_of_component(points + np.asarray(move), MARKS) == "other"


def test_without_mouth_landmarks_nothing_is_a_tooth() -> None:
    names = {k: v for k, v in landmark_points().items() if not k.startswith("2.")}
    assert kind_of_component(PIECES["teeth_upper"], landmark_set(names)) == "other"


def test_the_nearer_eye_gives_the_side() -> None:
    assert side_of_component(np.array([[3.0, 0.0, 60.0]]), MARKS) == "left"
    assert side_of_component(np.array([[-3.0, 0.0, 60.0]]), MARKS) == "right"


def test_teeth_above_the_mouth_line_are_upper_ones() -> None:
    assert upper_or_lower(arch(height=-66.0)[0], MARKS) == "upper"
    assert upper_or_lower(arch(height=-80.0)[0], MARKS) == "lower"
