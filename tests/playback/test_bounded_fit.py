from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import lsq_linear

from risorius.playback.bounded_fit import fit_bounded
from risorius.playback.kernels.bounded import finish


@given(seed=st.integers(0, 10_000), count=st.integers(1, 30))
def test_the_answer_is_the_minimum_that_the_conditions_of_kuhn_and_tucker_name(
    seed: int, count: int
) -> None:
    rng = np.random.default_rng(seed)
    rows = rng.normal(size=(count + 3, count)) * rng.choice([1.0, 1e-3], count)
    gram = rows.T @ rows + 1e-9 * np.eye(count)
    linear = rows.T @ rng.normal(size=count + 3) * 3.0
    low, high = rng.choice([-0.5, 0.0], count), rng.choice([0.0, 1.0, 2.0], count)
    x = fit_bounded(gram, linear, low=low, high=high)
    assert (low <= x).all()
    assert (x <= high).all()
    slope = (gram @ x - linear) / np.diag(gram)
    inside = (x > low) & (x < high)
    np.testing.assert_allclose(slope[inside], 0.0, atol=1e-6)
    assert (slope[(x == low) & (low < high)] >= -1e-6).all()
    assert (slope[(x == high) & (low < high)] <= 1e-6).all()


def test_it_agrees_with_bounded_least_squares_of_scipy() -> None:
    rng = np.random.default_rng(3)
    rows, wanted = rng.normal(size=(40, 25)), rng.normal(size=40)
    x = fit_bounded(rows.T @ rows, rows.T @ wanted, low=np.zeros(25), high=np.full(25, 0.1))
    other = lsq_linear(rows, wanted, (0.0, 0.1), tol=1e-12).x
    np.testing.assert_allclose(x, other, atol=1e-6)


@pytest.mark.parametrize("start", [0.0, 0.05, 0.1])
def test_the_active_set_alone_finds_the_minimum_from_anywhere(start: float) -> None:
    rng = np.random.default_rng(8)
    for _ in range(20):
        rows, wanted = rng.normal(size=(30, 20)), rng.normal(size=30)
        low, high = np.zeros(20), np.full(20, 0.1)
        x = np.full(20, start)
        systems = finish(rows.T @ rows, rows.T @ wanted, low, high, 1e-9, x)
        assert systems < 80
        np.testing.assert_allclose(x, lsq_linear(rows, wanted, (0.0, 0.1), tol=1e-12).x, atol=1e-6)


def test_variables_without_curvature_or_room_rest() -> None:
    gram = np.diag([2.0, 0.0, 3.0])
    x = fit_bounded(
        gram, np.array([1.0, 1.0, 9.0]), low=np.zeros(3), high=np.array([1.0, 1.0, 0.0])
    )
    assert x == pytest.approx([0.5, 0.0, 0.0])
