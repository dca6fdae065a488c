"""Fibres lie on the skull and shorten along themselves."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from risorius.anatomy.skull import builtin_skull
from risorius.layered.fibres import contract, lay_fibres, refine
from risorius.layered.muscle_map import default_muscle_map
from risorius.spatial import closest_points


def _curve() -> np.ndarray:
    t = np.linspace(0.0, 1.0, 41)
    return np.stack([40.0 * t, 10.0 * np.sin(3.0 * t), 0.0 * t], axis=1)[:, None]


@given(st.floats(0.0, 0.9), st.floats(0.0, 1.0))
def test_length_shrinks_by_the_contraction(contraction: float, fixed: float) -> None:
    rest = _curve()
    short = contract(rest, contraction, fixed_point=fixed)

    def length(line: np.ndarray) -> float:
        return float(np.linalg.norm(np.diff(line, axis=0), axis=2).sum())

    assert length(short) == pytest.approx((1.0 - contraction) * length(rest), rel=0.01)


def test_no_contraction_is_the_identity() -> None:
    np.testing.assert_allclose(contract(_curve(), 0.0, fixed_point=0.3), _curve(), atol=1e-12)


def test_a_fixed_point_inside_draws_both_ends_to_it() -> None:
    moved = contract(_curve(), 0.3, fixed_point=0.5) - _curve()
    assert moved[0, 0, 0] > 1.0 > -1.0 > moved[-1, 0, 0]
    assert np.abs(moved[20]).max() < 0.5


def test_refining_keeps_corners_and_runs_straight_between() -> None:
    grid = np.random.default_rng(0).standard_normal((4, 3, 3))
    fine = refine(grid, 4)
    assert fine.shape == (13, 9, 3)
    np.testing.assert_allclose(fine[::4, ::4], grid)
    np.testing.assert_allclose(fine[2, 0], 0.5 * (grid[0, 0] + grid[1, 0]))


def test_frontalis_lies_on_the_frontal_bone() -> None:
    skull = builtin_skull()
    fibres = lay_fibres(default_muscle_map(), skull)["frontalis"]
    upper = fibres[: len(fibres) // 2].reshape(-1, 3)
    assert closest_points(skull.cranium, upper).distance.max() < 1.0


def test_muscles_lie_outside_those_beneath() -> None:
    laid = lay_fibres(default_muscle_map(), builtin_skull())
    deep = laid["frontalis"].reshape(-1, 3)
    above = laid["frontalis_inner"][2:6].reshape(-1, 3)
    near = np.linalg.norm(above[:, None] - deep[None], axis=2).argmin(axis=1)
    assert np.median((above - deep[near])[:, 2]) > 0.5
