"""Triangles painted into a texture."""

from __future__ import annotations

import numpy as np

from risorius.wrinkles.kernels.paint import paint

# One triangle over the lower left half of a square of 8 texels.
PLACES = np.array([[[0.0, 0.0], [0.0, 8.0], [8.0, 8.0]]])


def painted(places: np.ndarray, values: np.ndarray, size: int = 8, *, compiled: bool = True):
    image, count = np.zeros((size, size, values.shape[2])), np.zeros((size, size), np.int32)
    (paint if compiled else paint.py_func)(places, values, image, count)
    return image, count


def test_values_are_linear_at_the_middles_of_texels() -> None:
    values = 2.0 * PLACES[..., :1] + 3.0 * PLACES[..., 1:] + 1.0
    image, count = painted(PLACES, values)
    row, column = np.nonzero(count)
    wanted = 2.0 * (column + 0.5) + 3.0 * (row + 0.5) + 1.0
    np.testing.assert_allclose(image[row, column, 0], wanted)
    assert set(zip(row.tolist(), column.tolist())) == {
        (r, c) for r in range(8) for c in range(8) if c <= r
    }


def test_both_windings_paint_the_same_and_nothing_outside_is_touched() -> None:
    values = np.random.default_rng(1).normal(size=(1, 3, 2))
    straight = painted(PLACES + 3.0, values)
    reversed_ = painted((PLACES + 3.0)[:, ::-1], values[:, ::-1].copy())
    np.testing.assert_allclose(straight[0], reversed_[0], atol=1e-12)
    assert straight[1][:3].sum() == 0


def test_the_compiled_kernel_agrees_with_the_plain_one() -> None:
    rng = np.random.default_rng(2)
    places, values = rng.uniform(-4.0, 20.0, (40, 3, 2)), rng.normal(size=(40, 3, 2))
    for fast, slow in zip(painted(places, values, 16), painted(places, values, 16, compiled=False)):
        np.testing.assert_allclose(fast, slow, rtol=1e-9, atol=1e-12)


def test_a_collapsed_triangle_paints_nothing() -> None:
    _, count = painted(np.zeros((1, 3, 2)) + 4.0, np.ones((1, 3, 1)))
    assert not count.any()
