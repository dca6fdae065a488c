"""Motion on finer targets: what is straight stays so, kinks are rounded."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_matrix

from risorius.cloning.fine_field import FineField
from tests.cloning.test_evening import COUNT, sheet

EVERY = np.arange(0, COUNT * COUNT, 3, dtype=np.int32)


def field(bend: float) -> FineField:
    samples = csr_matrix(np.eye(COUNT * COUNT)[EVERY])
    areas = np.full(len(EVERY), 3.0)
    return FineField(
        sheet(), np.ones(COUNT * COUNT), samples, vertices=EVERY, areas=areas, bend=bend
    )


def test_one_motion_of_all_is_kept() -> None:
    moved = np.tile([1.0, -2.0, 3.0], (COUNT * COUNT, 1))
    assert np.abs(field(2.0).rounded(moved, moved) - moved).max() < 1e-9


def test_without_bending_the_motion_stays() -> None:
    moved = np.random.default_rng(3).standard_normal((COUNT * COUNT, 3))
    assert np.abs(field(0.0).rounded(moved, moved) - moved).max() < 1e-9


def test_noise_between_samples_is_rounded_and_samples_are_followed() -> None:
    x = sheet().positions[:, :1]
    smooth = np.sin(0.3 * x)
    noise = 0.2 * np.random.default_rng(4).standard_normal(smooth.shape)
    noise[EVERY] = 0.0
    made = field(1.0).rounded(smooth + noise, smooth)
    assert np.abs(made - smooth).mean() < 0.5 * np.abs(noise).mean()
