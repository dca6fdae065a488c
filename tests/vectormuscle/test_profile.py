from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from risorius.vectormuscle.profile import angular_factor, fold_limit, radial_factor

starts = st.floats(0.1, 100.0)
gaps = st.floats(0.1, 100.0)


def _radial(distance, start: float = 30.0, finish: float = 50.0) -> np.ndarray:
    return radial_factor(distance, start_radius=start, finish_radius=finish)


@given(starts, gaps)
def test_the_effect_is_0_at_the_origin_1_at_the_start_and_0_at_the_finish(start, gap) -> None:
    values = _radial([0.0, start, start + gap, start + 2.0 * gap], start, start + gap)
    np.testing.assert_allclose(values, [0.0, 1.0, 0.0, 0.0], atol=1e-12)


@given(starts, gaps)
def test_the_effect_rises_to_the_start_and_falls_behind_it(start: float, gap: float) -> None:
    inner = _radial(np.linspace(0.0, start, 50), start, start + gap)
    outer = _radial(np.linspace(start, start + gap, 50), start, start + gap)
    assert (np.diff(inner) >= -1e-12).all()
    assert (np.diff(outer) <= 1e-12).all()


def test_the_effect_runs_smoothly_through_the_start() -> None:
    h = 1e-4
    before, at, after = _radial([30.0 - h, 30.0, 30.0 + h])
    assert (at - before) / h == pytest.approx(0.0, abs=1e-5)
    assert (after - at) / h == pytest.approx(0.0, abs=1e-5)


def test_without_the_half_turn_of_erratum_e1_the_rim_would_jump() -> None:
    printed_at_origin = np.cos(1.0)
    assert printed_at_origin == pytest.approx(0.54, abs=0.01)
    assert _radial([0.0])[0] == pytest.approx(0.0, abs=1e-12)


@given(st.floats(0.02, 1.5))
def test_the_smooth_profile_vanishes_at_the_side_and_the_published_one_jumps(half) -> None:
    rim = [0.0, half * (1 - 1e-9), half, half * 1.1]
    smooth = angular_factor(rim, half_angle=half)
    published = angular_factor(rim, half_angle=half, profile="published")
    np.testing.assert_allclose(smooth, [1.0, 0.0, 0.0, 0.0], atol=1e-8)
    np.testing.assert_allclose(published, [1.0, np.cos(half), 0.0, 0.0], atol=1e-8)


@given(st.floats(-0.6, 0.6))
def test_both_sides_of_the_muscle_are_alike(angle: float) -> None:
    for profile in ("smooth", "published"):
        left, right = angular_factor([angle, -angle], half_angle=0.6, profile=profile)
        assert left == right


@given(starts, gaps, st.floats(0.0, 0.999))
def test_below_the_fold_limit_points_keep_their_order(start, gap, share: float) -> None:
    pull = share * fold_limit(start_radius=start, finish_radius=start + gap)
    distance = np.linspace(0.0, 1.2 * (start + gap), 400)
    moved = distance - pull * _radial(distance, start, start + gap)
    assert (np.diff(moved) > 0.0).all()


def test_above_the_fold_limit_a_short_rise_folds() -> None:
    pull = 1.1 * fold_limit(start_radius=20.0, finish_radius=50.0)
    distance = np.linspace(0.0, 60.0, 2000)
    assert (np.diff(distance - pull * _radial(distance, 20.0)) < 0.0).any()
