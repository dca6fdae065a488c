from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from risorius.layered.faithful.sphincter import constrict, paired


def _rings(columns: int = 24) -> np.ndarray:
    angle = 2.0 * np.pi * np.arange(columns) / columns
    row = np.stack([3.0 * np.cos(angle), np.sin(angle), 0.0 * angle], axis=1)
    return np.stack([row, 2.0 * row])


def _perimeter(row: np.ndarray) -> float:
    return float(np.linalg.norm(row - np.roll(row, -1, axis=0), axis=1).sum())


@pytest.mark.parametrize("contraction", [0.0, 0.25, 0.5, 0.75])
def test_the_inner_line_shortens_by_the_contraction(contraction: float) -> None:
    rest = _rings()
    inner = constrict(rest, contraction)[0]
    assert _perimeter(inner) == pytest.approx((1.0 - contraction) * _perimeter(rest[0]), rel=1e-9)


def test_no_contraction_leaves_the_samples_alone() -> None:
    assert constrict(_rings(), 0.0) is not None
    np.testing.assert_array_equal(constrict(_rings(), 0.0), _rings())


def test_pairs_move_together() -> None:
    rest = _rings()
    moved = constrict(rest, 0.4) - rest
    np.testing.assert_allclose(moved[0], moved[1])


@given(st.floats(0.05, 0.9), st.floats(-0.6, 0.6), st.floats(-0.6, 0.6))
def test_a_tilted_ring_closes_as_a_flat_one(contraction: float, pitch: float, yaw: float) -> None:
    a, b = np.cos(pitch), np.sin(pitch)
    c, d = np.cos(yaw), np.sin(yaw)
    turn = np.array([(1, 0, 0), (0, a, -b), (0, b, a)]) @ [(c, 0, d), (0, 1, 0), (-d, 0, c)]
    rest = _rings()
    tilted = constrict(rest @ turn.T, contraction)
    flat = constrict(rest, contraction)
    assert _perimeter(tilted[0]) == pytest.approx(_perimeter(flat[0]), rel=0.02)


def test_protrusion_moves_the_ring_forward() -> None:
    moved = constrict(_rings(), 0.5, protrusion=2.0) - constrict(_rings(), 0.5)
    assert (moved[..., 2] > 0.0).all()
    np.testing.assert_allclose(moved[..., :2], 0.0, atol=1e-12)


@pytest.mark.parametrize("flip", [False, True])
def test_samples_are_paired_whatever_their_start_and_direction(flip: bool) -> None:
    inner, outer = _rings()
    other = outer[::-1] if flip else outer
    other = np.roll(other, 5, axis=0)
    turn, flipped = paired(inner, other)
    found = np.roll(other, -turn, axis=0)
    found = np.roll(found[::-1], 1, axis=0) if flipped else found
    np.testing.assert_allclose(found, outer)
