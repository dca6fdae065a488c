from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from risorius.anatomy.smooth_step import smooth_step
from risorius.anatomy.support import _AXES, support_directions

HINGE = np.array([0.0, -10.0, -20.0])
POINTS = np.random.default_rng(2).normal(scale=50.0, size=(60, 3))


def test_directions_are_unit_and_point_away_from_the_hinge() -> None:
    normal = support_directions(POINTS, hinge=HINGE, face_height=115.0)
    np.testing.assert_allclose(np.linalg.norm(normal, axis=1), 1.0)
    assert ((normal * (POINTS - HINGE)).sum(axis=1) > 0.0).all()


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_on_its_axes_the_support_faces_straight_out(axis: int) -> None:
    out = np.eye(3)[axis]
    normal = support_directions((HINGE + 70.0 * out)[None], hinge=HINGE, face_height=115.0)
    np.testing.assert_allclose(normal[0], out, atol=1e-12)


def test_it_is_mirror_symmetric_and_scales_with_the_head() -> None:
    mirror = np.array([-1.0, 1.0, 1.0])
    normal = support_directions(POINTS, hinge=HINGE, face_height=115.0)
    mirrored = support_directions(POINTS * mirror, hinge=HINGE, face_height=115.0)
    np.testing.assert_array_equal(mirrored, normal * mirror)
    scaled = support_directions(9.0 * POINTS, hinge=9.0 * HINGE, face_height=9.0 * 115.0)
    np.testing.assert_allclose(scaled, normal, atol=1e-12)


def test_the_directions_are_normals_of_one_ellipsoid() -> None:
    axes = 115.0 * np.asarray(_AXES)
    unit = POINTS / np.linalg.norm(POINTS, axis=1, keepdims=True)
    on_it = HINGE + axes * unit
    normal = support_directions(on_it, hinge=HINGE, face_height=115.0)
    # A step along the tangent stays on the surface to first order.
    side = np.cross(normal, [0.3, -0.5, 0.8])
    value = (((on_it + 1e-4 * side - HINGE) / axes) ** 2).sum(axis=1)
    np.testing.assert_allclose(value, 1.0, atol=1e-9)


def test_at_the_hinge_itself_nothing_is_supported() -> None:
    np.testing.assert_array_equal(
        support_directions(HINGE[None], hinge=HINGE, face_height=115.0), 0.0
    )


@given(st.floats(-2.0, 3.0), st.floats(-2.0, 3.0))
def test_the_smooth_step_rises_from_0_to_1(a: float, b: float) -> None:
    low, high = sorted((a, b))
    first, second = float(smooth_step(low)), float(smooth_step(high))
    assert 0.0 <= first <= second <= 1.0
    assert first + float(smooth_step(1.0 - low)) == pytest.approx(1.0)


def test_the_smooth_step_is_flat_at_both_ends() -> None:
    assert smooth_step([-1.0, 0.0, 0.5, 1.0, 9.0]).tolist() == [0.0, 0.0, 0.5, 1.0, 1.0]
    assert float(smooth_step(1e-6)) < 1e-11
