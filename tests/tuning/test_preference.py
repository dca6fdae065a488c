"""The ideal point that comparisons point to."""

from __future__ import annotations

import numpy as np
import pytest

from risorius.tuning.preference import ideal_point


def _compared(wish: np.ndarray, count: int, seed: int) -> tuple[np.ndarray, np.ndarray]:
    pairs = np.random.default_rng(seed).uniform(size=(count, 2, len(wish)))
    nearer = np.linalg.norm(pairs - wish, axis=2).argmin(axis=1)
    rows = np.arange(count)
    return pairs[rows, nearer], pairs[rows, 1 - nearer]


def test_without_comparisons_the_start_is_the_ideal() -> None:
    none = np.zeros((0, 3))
    start = np.array([0.2, 0.5, 0.9])
    point, factor = ideal_point(none, none, start=start, metric=np.eye(3), noise=0.2)
    assert np.allclose(point, start)
    assert np.allclose(factor @ factor.T, 12.0 * np.eye(3))


@pytest.mark.parametrize("lapse", [0.0, 0.1])
def test_many_comparisons_find_the_wish(lapse: float) -> None:
    wish = np.array([0.8, 0.3, 0.55])
    better, worse = _compared(wish, 300, 0)
    point, _ = ideal_point(
        better, worse, start=np.full(3, 0.5), metric=np.eye(3), noise=0.1, lapse=lapse
    )
    assert np.abs(point - wish).max() < 0.08


def test_the_point_is_a_minimum() -> None:
    better, worse = _compared(np.array([0.8, 0.3]), 12, 1)
    metric, start, noise = np.array([[2.0, 0.3], [0.3, 0.5]]), np.full(2, 0.5), 0.25

    def cost(u: np.ndarray) -> float:
        apart = better - worse
        length = np.einsum("kp,pq,kq->k", apart, metric, apart)
        margin = np.einsum("kp,pq,kq->k", apart, metric, u - 0.5 * (better + worse))
        return float(
            np.log1p(np.exp(-margin / length / noise)).sum() + 6.0 * ((u - start) ** 2).sum()
        )

    point, _ = ideal_point(better, worse, start=start, metric=metric, noise=noise)
    step = 1e-5
    for axis in np.eye(2):
        slope = (cost(point + step * axis) - cost(point - step * axis)) / (2.0 * step)
        assert abs(slope) < 1e-5


def test_lapses_are_forgiven() -> None:
    wish = np.array([0.8, 0.3, 0.55])
    better, worse = _compared(wish, 200, 2)
    wrong = np.arange(200) % 5 == 0
    better, worse = (
        np.where(wrong[:, None], worse, better),
        np.where(wrong[:, None], better, worse),
    )
    errors = [
        np.linalg.norm(
            ideal_point(
                better, worse, start=np.full(3, 0.5), metric=np.eye(3), noise=0.1, lapse=lapse
            )[0]
            - wish
        )
        for lapse in (0.0, 0.2)
    ]
    assert errors[1] < errors[0]
