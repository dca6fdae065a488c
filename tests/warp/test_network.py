"""The regularised network of Bui et al."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from risorius.errors import ParameterError, RisoriusWarning
from risorius.warp.network import NetworkWarp
from tests.mesh.shapes import rotation


def pairs(count: int = 16) -> tuple[np.ndarray, np.ndarray]:
    generator = np.random.default_rng(0)
    source = 80.0 * generator.uniform(-1, 1, size=(count, 3))
    return source, 1.1 * source + 8.0 * generator.normal(size=source.shape)


@pytest.mark.parametrize("base", ["affine", "similarity", "none"])
def test_without_regularisation_features_are_met(base: str):
    source, target = pairs()
    warp = NetworkWarp.fit(source, target, base=base, regularisation=0.0)
    np.testing.assert_allclose(warp(source), target, atol=1e-9 * 80)
    assert warp.residual < 1e-7


def test_network_follows_the_published_formula():
    source, target = pairs()
    gaps = np.linalg.norm(source[:, None] - source, axis=2)
    s = (gaps + np.diag([np.inf] * len(source))).min(axis=1)
    h = np.sqrt(gaps**2 + s**2)
    strength = 0.01 * np.trace(h.T @ h) / len(source)
    w = np.linalg.solve(h.T @ h + strength * np.eye(len(source)), h.T @ target)
    warp = NetworkWarp.fit(source, target, base="none", regularisation=0.01)
    points = source + 7.0
    kernel = np.sqrt(np.linalg.norm(points[:, None] - source, axis=2) ** 2 + s**2)
    np.testing.assert_allclose(warp(points), kernel @ w, atol=1e-8)


@given(st.integers(0, 2**32 - 1))
def test_affine_maps_are_exact_by_default(seed: int):
    generator = np.random.default_rng(seed)
    source, points = generator.normal(size=(14, 3)), 3.0 * generator.normal(size=(20, 3))
    linear, shift = generator.normal(size=(3, 3)), 10.0 * generator.normal(size=3)
    warp = NetworkWarp.fit(source, source @ linear.T + shift)
    np.testing.assert_allclose(warp(points), points @ linear.T + shift, atol=1e-9)


def test_as_published_identity_is_not_reproduced():
    source, _ = pairs()
    points = source + 20.0
    published = NetworkWarp.fit(source, source, base="none", regularisation=0.0)
    assert np.abs(published(points) - points).max() > 0.1
    np.testing.assert_allclose(NetworkWarp.fit(source, source)(points), points, atol=1e-9)


@pytest.mark.parametrize("base", ["affine", "similarity"])
def test_result_moves_turns_and_scales_with_the_features(base: str):
    source, target = pairs()
    points = source + 9.0
    rest = NetworkWarp.fit(source, target, base=base)(points)
    turn, shift = rotation(np.random.default_rng(1)), np.array([150.0, -20.0, 900.0])
    moved = NetworkWarp.fit(
        1e-3 * (source @ turn.T + shift), 1e-3 * (target @ turn.T + shift), base=base
    )
    np.testing.assert_allclose(
        moved(1e-3 * (points @ turn.T + shift)), 1e-3 * (rest @ turn.T + shift), atol=1e-9
    )


def test_more_regularisation_misses_more():
    source, target = pairs()
    missed = [
        NetworkWarp.fit(source, target, regularisation=share).residual
        for share in (0.0, 1e-6, 1e-4, 1e-2, 1.0, 100.0)
    ]
    assert missed == sorted(missed)
    assert len(set(missed)) == len(missed)


def test_exact_features_are_met_under_regularisation():
    source, target = pairs()
    plain = NetworkWarp.fit(source, target, regularisation=0.1)
    assert np.linalg.norm(plain(source)[[2, 9]] - target[[2, 9]], axis=1).min() > 0.1
    warp = NetworkWarp.fit(source, target, regularisation=0.1, exact=[9, 2])
    np.testing.assert_allclose(warp(source)[[2, 9]], target[[2, 9]], atol=1e-8)
    assert warp.residual > 0.1, "the others are still smoothed"


def test_few_features_have_a_similarity_as_base():
    source, _ = pairs(3)
    linear = 2.0 * rotation(np.random.default_rng(1))
    with pytest.warns(RisoriusWarning, match="3 source point.* without depth"):
        warp = NetworkWarp.fit(source, source @ linear.T)
    np.testing.assert_allclose(warp([[1, 2, 3]]), [linear @ [1, 2, 3]], atol=1e-9)
    with pytest.warns(RisoriusWarning, match="without depth"):
        single = NetworkWarp.fit([[0, 0, 0]], [[1, 0, 0]])
    np.testing.assert_allclose(single([[5, 5, 5]]), [[6, 5, 5]])


def test_repeated_features_count_once_and_keep_their_exactness():
    source, target = pairs()
    with pytest.warns(RisoriusWarning, match="1 source point"):
        warp = NetworkWarp.fit(
            np.concatenate([source, source[:1]]),
            np.concatenate([target, target[:1]]),
            exact=[0],
            regularisation=0.1,
        )
    assert len(warp.centres) == len(source)
    np.testing.assert_allclose(warp(source[:1]), target[:1], atol=1e-8)


def test_contradicting_features_are_named():
    source, target = pairs()
    source[5] = source[1]
    with pytest.raises(ParameterError, match="points 1 and 5 lie at one place"):
        NetworkWarp.fit(source, target)


def test_bad_options_are_refused():
    source, target = pairs()
    with pytest.raises(ParameterError, match="regularisation: -1 is below 0"):
        NetworkWarp.fit(source, target, regularisation=-1.0)
    with pytest.raises(ParameterError, match="base: 'cubic' is not one of"):
        NetworkWarp.fit(source, target, base="cubic")
    with pytest.raises(ParameterError, match=r"exact: pairs must lie in 0\.\.15"):
        NetworkWarp.fit(source, target, exact=[16])
