"""Ellipsoids: inside, normal, closest point, rays."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from risorius.errors import ParameterError, ShapeError
from risorius.springmuscle.ellipsoid import Ellipsoids

COUNT = 300


def _random(seed: int, count: int = COUNT) -> Ellipsoids:
    rng = np.random.default_rng(seed)
    frames = np.linalg.qr(rng.normal(size=(count, 3, 3)))[0]
    return Ellipsoids(
        rng.normal(size=(count, 3)) * 20.0, frames, np.exp(rng.uniform(-1.5, 2.0, (count, 3)))
    )


def _own(solids: Ellipsoids) -> np.ndarray:
    return np.arange(solids.count, dtype=np.int32)


@given(seed=st.integers(0, 10_000))
@settings(max_examples=15)
def test_the_closest_point_lies_on_the_surface_below_the_query_along_the_normal(seed) -> None:
    solids, rng = _random(seed), np.random.default_rng(seed + 1)
    points = solids.centres + rng.normal(size=(COUNT, 3)) * 6.0
    feet = solids.closest(points, _own(solids))
    unit = solids.local(feet, _own(solids)) / solids.half_axes
    assert np.abs((unit**2).sum(axis=1) - 1.0).max() < 1e-9
    normals, way = solids.normals(feet, _own(solids)), points - feet
    distance = np.linalg.norm(way, axis=1)
    across = np.linalg.norm(np.cross(way, normals), axis=1)
    assert (across < 1e-6 * (distance + solids.half_axes.max(axis=1))).all()
    outside = ~solids.inside(points, _own(solids))
    assert ((way * normals).sum(axis=1)[outside] > 0.0).all()


def test_no_surface_point_is_nearer_than_the_closest_one() -> None:
    solids, rng = _random(5, 40), np.random.default_rng(8)
    points = solids.centres + rng.normal(size=(40, 3)) * 4.0
    distance = np.linalg.norm(points - solids.closest(points, _own(solids)), axis=1)
    sphere = rng.normal(size=(20_000, 3))
    sphere /= np.linalg.norm(sphere, axis=1, keepdims=True)
    for row in range(40):
        surface = solids.centres[row] + (sphere * solids.half_axes[row]) @ solids.frames[row].T
        assert np.linalg.norm(surface - points[row], axis=1).min() >= distance[row] - 1e-9


def test_from_the_middle_the_flat_side_is_nearest() -> None:
    solid = Ellipsoids(np.zeros((1, 3)), np.eye(3)[None], np.array([[5.0, 3.0, 1.0]]))
    assert np.abs(solid.closest([[0.0, 0.0, 0.0]], [0]) - [0.0, 0.0, 1.0]).max() < 1e-12
    # In the middle plane, far inside: a foot on the rim would be farther away.
    foot = solid.closest([[0.5, 0.0, 0.0]], [0])[0]
    assert abs((foot**2 / [25.0, 9.0, 1.0]).sum() - 1.0) < 1e-12
    assert foot[2] > 0.9
    assert np.abs(solid.closest([[9.0, 0.0, 0.0]], [0]) - [5.0, 0.0, 0.0]).max() < 1e-12


def test_rays_hit_the_near_side_from_outside_and_the_far_side_from_inside() -> None:
    solid = Ellipsoids(np.array([[1.0, 2.0, 3.0]]), np.eye(3)[None], np.array([[4.0, 3.0, 2.0]]))
    start = [[11.0, 2.0, 3.0], [1.0, 2.0, 3.0], [11.0, 2.0, 3.0], [11.0, 9.0, 3.0]]
    way = [[-2.0, 0.0, 0.0], [0.0, 0.0, 7.0], [1.0, 0.0, 0.0], [-1.0, 0.0, 0.0]]
    distance, hit = solid.cast(start, way)
    assert np.abs(distance[:2] - [6.0, 2.0]).max() < 1e-12
    assert np.isinf(distance[2:]).all()
    assert hit.tolist() == [0, 0, -1, -1]


def test_rays_name_the_nearest_of_many_ellipsoids() -> None:
    solids, rng = _random(2, 60), np.random.default_rng(1)
    start = rng.normal(size=(200, 3)) * 60.0
    way = solids.centres[rng.integers(0, 60, 200)] - start
    way /= np.linalg.norm(way, axis=1, keepdims=True)
    distance, hit = solids.cast(start, way)
    assert (hit >= 0).all()
    places = start + distance[:, None] * way
    unit = solids.local(places, hit) / solids.half_axes[hit]
    assert np.abs((unit**2).sum(axis=1) - 1.0).max() < 1e-8
    # No other ellipsoid lies on the way.
    for share in np.linspace(0.0, 0.999, 25):
        before = start + share * distance[:, None] * way
        for row in range(0, 200, 20):
            inside = solids.inside(np.tile(before[row], (60, 1)), _own(solids))
            started = solids.inside(np.tile(start[row], (60, 1)), _own(solids))
            assert not (inside & ~started).any()


def test_bad_queries_are_refused() -> None:
    solid = _random(0, 2)
    with pytest.raises(ShapeError, match="segments: expected 1 numbers"):
        solid.inside([[0.0, 0.0, 0.0]], [0, 1])
    with pytest.raises(ShapeError, match="indices must lie in"):
        solid.inside([[0.0, 0.0, 0.0]], [2])
    with pytest.raises(ParameterError, match="directions: row 0 is zero"):
        solid.cast([[0.0, 0.0, 0.0]], [[0.0, 0.0, 0.0]])
    with pytest.raises(ShapeError, match="directions: expected 1 rows"):
        solid.cast([[0.0, 0.0, 0.0]], np.eye(3))
