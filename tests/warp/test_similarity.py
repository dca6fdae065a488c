"""Best similarity and affine map."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from risorius.errors import ParameterError, ShapeError
from risorius.warp.similarity import fit_affine, fit_similarity
from tests.mesh.shapes import rotation

SEEDS = st.integers(0, 2**32 - 1)


@given(SEEDS, st.floats(1e-3, 1e3), st.integers(3, 30))
def test_a_similarity_is_found_again(seed: int, scale: float, count: int):
    generator = np.random.default_rng(seed)
    turn, shift = rotation(generator), 100.0 * generator.normal(size=3)
    source = generator.normal(size=(count, 3))
    target = scale * source @ turn.T + shift
    found = fit_similarity(source, target)
    assert found.scale == pytest.approx(scale, rel=1e-9)
    np.testing.assert_allclose(found.rotation, turn, atol=1e-7)
    np.testing.assert_allclose(found.apply(source), target, atol=1e-9 * max(scale, 100.0))
    np.testing.assert_allclose(found.inverse().apply(target), source, atol=1e-9 * (1 + 100 / scale))
    assert not found.reflected


def test_no_nearby_similarity_fits_better():
    generator = np.random.default_rng(0)
    p, q, w = generator.normal(size=(9, 3)), generator.normal(size=(9, 3)), generator.random(9)
    best = fit_similarity(p, q, weights=w)

    def error(scale: float, turn: np.ndarray, shift: np.ndarray) -> float:
        return float(w @ ((scale * p @ turn.T + shift - q) ** 2).sum(axis=1))

    least = error(best.scale, best.rotation, best.translation)
    for _ in range(30):
        skew = np.cross(np.eye(3), 1e-3 * generator.normal(size=3))
        turn = np.linalg.qr(best.rotation + best.rotation @ skew)[0]
        turn = turn * np.sign(np.einsum("ij,ij->j", turn, best.rotation))
        scale = best.scale + 1e-3 * generator.normal()
        assert error(scale, turn, best.translation + 1e-3 * generator.normal(size=3)) > least


def test_swapped_sides_are_noticed():
    source = np.random.default_rng(0).normal(size=(10, 3))
    mirrored = source * [-1, 1, 1]
    plain = fit_similarity(source, mirrored)
    assert plain.reflected
    assert np.linalg.det(plain.rotation) == pytest.approx(1.0)
    allowed = fit_similarity(source, mirrored, allow_reflection=True)
    assert allowed.reflected
    assert np.linalg.det(allowed.rotation) == pytest.approx(-1.0)
    np.testing.assert_allclose(allowed.apply(source), mirrored, atol=1e-12)
    np.testing.assert_allclose(allowed.inverse().apply(mirrored), source, atol=1e-12)


@given(SEEDS)
def test_points_in_a_plane_are_never_called_reflected(seed: int):
    generator = np.random.default_rng(seed)
    flat = generator.normal(size=(8, 3)) * [1, 1, 0]
    first, second = rotation(generator), rotation(generator)
    found = fit_similarity(flat @ first.T, flat @ second.T * [1, 1, 1])
    assert not found.reflected
    np.testing.assert_allclose(found.rotation, second @ first.T, atol=1e-7)


def test_lengths_are_kept_on_request():
    source = np.random.default_rng(0).normal(size=(10, 3))
    found = fit_similarity(source, 3.0 * source, allow_scale=False)
    assert found.scale == 1.0
    np.testing.assert_allclose(found.rotation, np.eye(3), atol=1e-12)


def test_points_without_weight_do_not_count():
    generator = np.random.default_rng(0)
    source, turn = generator.normal(size=(10, 3)), rotation(generator)
    target = source @ turn.T
    target[3] += 50.0
    weights = np.ones(10)
    weights[3] = 0.0
    np.testing.assert_allclose(
        fit_similarity(source, target, weights=weights).rotation, turn, atol=1e-12
    )
    np.testing.assert_allclose(fit_affine(source, target, weights=weights).linear, turn, atol=1e-12)


def test_few_points_turn_as_little_as_possible():
    one = fit_similarity([[1, 2, 3]], [[4, 4, 4]])
    np.testing.assert_array_equal(one.linear, np.eye(3))
    np.testing.assert_array_equal(one.translation, [3, 2, 1])
    two = fit_similarity([[0, 0, 0], [1, 0, 0]], [[5, 5, 5], [5, 7, 5]])
    np.testing.assert_allclose(
        two.linear, 2.0 * np.array([[0, -1, 0], [1, 0, 0], [0, 0, 1]]), atol=1e-12
    )
    half_turn = fit_similarity([[0, 0, 0], [0, 1, 0]], [[0, 0, 0], [0, -1, 0]])
    np.testing.assert_allclose(half_turn.apply([[0, 1, 0]]), [[0, -1, 0]], atol=1e-12)
    assert np.linalg.det(half_turn.rotation) == pytest.approx(1.0)
    line = np.outer([0.0, 1, 2, 5], [1, 1, 0])
    np.testing.assert_allclose(fit_similarity(line, line + 3).rotation, np.eye(3), atol=1e-12)


@given(SEEDS)
def test_an_affine_map_is_found_again(seed: int):
    generator = np.random.default_rng(seed)
    linear, shift = generator.normal(size=(3, 3)), 100.0 * generator.normal(size=3)
    source = generator.normal(size=(12, 3))
    found = fit_affine(source, source @ linear.T + shift)
    np.testing.assert_allclose(found.linear, linear, atol=1e-10)
    np.testing.assert_allclose(found.apply([[1, 2, 3]]), [linear @ [1, 2, 3] + shift], atol=1e-9)


def test_bad_input_is_refused():
    with pytest.raises(ShapeError, match="3 and 2 points do not correspond"):
        fit_similarity(np.eye(3), np.eye(3)[:2])
    with pytest.raises(ParameterError, match="no points"):
        fit_similarity(np.zeros((0, 3)), np.zeros((0, 3)))
    with pytest.raises(ParameterError, match="not all 0"):
        fit_similarity(np.eye(3), np.eye(3), weights=np.zeros(3))
    with pytest.raises(ShapeError, match=r"weights: expected shape \(3,\)"):
        fit_similarity(np.eye(3), np.eye(3), weights=np.ones(2))
    with pytest.raises(ParameterError, match="the 3 points lie in one plane"):
        fit_affine(np.eye(3), np.eye(3))
    with pytest.raises(ParameterError, match="it has no inverse"):
        fit_similarity(np.eye(3), np.ones((3, 3))).inverse()
