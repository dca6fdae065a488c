"""Radial kernels."""

from __future__ import annotations

import numpy as np
import pytest

from risorius.warp.kernels import KERNELS, blocks, squared_distances


@pytest.mark.parametrize("name", KERNELS)
def test_kernel_is_conditionally_positive_definite(name: str):
    kernel = KERNELS[name]
    generator = np.random.default_rng(0)
    for _ in range(50):
        points = generator.normal(size=(12, 3))
        radii = np.full(12, generator.uniform(0.1, 2.0))
        matrix = kernel.value(squared_distances(points, points), radii)
        powers = np.ones((12, 1)) if kernel.order == 1 else np.column_stack([points, np.ones(12)])
        rest = np.linalg.qr(powers, mode="complete")[0][:, powers.shape[1] :]
        assert np.linalg.eigvalsh(rest.T @ matrix @ rest).min() > 0.0


@pytest.mark.parametrize("name", KERNELS)
def test_slope_is_the_derivative(name: str):
    kernel = KERNELS[name]
    squared = np.linspace(0.1, 4.0, 20)
    radii, step = np.full(20, 0.7), 1e-6
    numeric = (kernel.value(squared + step, radii) - kernel.value(squared - step, radii)) / step
    np.testing.assert_allclose(kernel.slope(squared, radii), numeric, rtol=1e-7, atol=1e-7)


@pytest.mark.parametrize("name", KERNELS)
def test_kernels_are_finite_at_their_centre(name: str):
    kernel, zero = KERNELS[name], np.zeros(1)
    assert kernel.value(zero, zero)[0] == 0.0
    assert kernel.slope(zero, zero)[0] == 0.0


def test_radii_belong_to_the_columns():
    value = KERNELS["multiquadric"].value(np.ones((2, 2)), np.array([0.0, np.sqrt(3.0)]))
    np.testing.assert_allclose(value, [[-1, -2], [-1, -2]])


def test_blocks_cover_every_row_once():
    for points, centres in ((0, 5), (1, 1), (100, 30_000), (7, 1 << 22)):
        rows = [row for block in blocks(points, centres) for row in range(points)[block]]
        assert rows == list(range(points))
        assert all(
            len(range(points)[b]) * centres <= max(1 << 20, centres)
            for b in blocks(points, centres)
        )
