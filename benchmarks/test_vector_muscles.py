"""Speed of the vector muscles: zones computed once against a loop over all vertices.

Every benchmark also checks that the result is right. The ratio is measured in one run, so that a
slow machine is slow in both.
"""

from __future__ import annotations

from collections.abc import Callable
from time import perf_counter

import numpy as np
import pytest

from risorius._check import FloatArray
from risorius.vectormuscle.combine import combine
from risorius.vectormuscle.kinds import LinearMuscle
from risorius.vectormuscle.muscle import FaceContext
from risorius.vectormuscle.reference import combine_reference
from tests.face_fixtures import builtin_face
from tests.vectormuscle.patches import context, linear, patch

# 100 x 100 vertices, 160 mm: about a face, with muscles of the size of the default set.
MESH = patch(100, 100, step=1.6, bulge=0.002)
SEEN: FaceContext = context(MESH)
PLACES = [(x, y) for x in (-55.0, -20.0, 20.0, 55.0) for y in (0.0, -40.0, -80.0)]
MUSCLES = [
    linear(
        name=f"m{number}",
        origin=np.array([x, y, 0.0]),
        insertion=np.array([x, y - 30.0, 0.0]),
        half_angle=30.0,
    )
    for number, (x, y) in enumerate(PLACES)
]
CONTRACTIONS = np.linspace(0.3, 1.0, len(MUSCLES))
STEPS = 8


class _EveryVertex:
    """A muscle without zone: all vertices are tested again in every step."""

    def __init__(self, muscle: LinearMuscle) -> None:
        self._muscle = muscle
        self._effect_at = SEEN.positions
        self.vertices = np.arange(MESH.vertex_count, dtype=np.int32)

    def displace(self, points: FloatArray, contraction: float) -> FloatArray:
        effect = self._muscle.influence(self._effect_at) * SEEN.regions.mobility
        offset = points - self._muscle.origin
        distance = np.linalg.norm(offset, axis=1)
        scale = contraction * self._muscle.pull * effect / np.maximum(distance, 1e-300)
        return -np.where(distance > 0.0, scale, 0.0)[:, None] * offset


def _all(bound: list) -> FloatArray:
    return combine(list(zip(bound, CONTRACTIONS)), MESH.positions, steps=STEPS)


def _seconds(work: Callable[[], object], *, rounds: int = 5) -> float:
    times = []
    for _ in range(rounds):
        start = perf_counter()
        work()
        times.append(perf_counter() - start)
    return min(times)


ZONES = [muscle.bind(SEEN) for muscle in MUSCLES]
EVERYWHERE = [_EveryVertex(muscle) for muscle in MUSCLES]


def test_zones_are_at_least_three_times_as_fast_as_testing_every_vertex() -> None:
    assert MESH.vertex_count == 10_000
    np.testing.assert_allclose(_all(ZONES), _all(EVERYWHERE), atol=1e-12)

    loop = _seconds(lambda: _all(EVERYWHERE), rounds=2)
    zones = _seconds(lambda: _all(ZONES))
    assert loop / zones >= 3.0, f"{loop / zones:.1f} times as fast"


def test_zones_are_far_faster_than_plain_loops() -> None:
    small = patch(40, 40, step=4.0, bulge=0.002)
    seen = context(small)
    pairs = [(muscle, 0.8) for muscle in MUSCLES[:3]]
    bound = [(muscle.bind(seen), share) for muscle, share in pairs]
    fast = combine(bound, small.positions)
    start = perf_counter()
    slow = combine_reference(pairs, seen)
    loop = perf_counter() - start
    np.testing.assert_allclose(fast, slow, atol=1e-12)
    assert loop / _seconds(lambda: combine(bound, small.positions)) > 20.0


def test_pose_with_zones(benchmark) -> None:
    moved = benchmark(_all, ZONES)
    assert 5.0 < np.abs(moved).max() < 20.0


def test_pose_without_zones(benchmark) -> None:
    moved = benchmark.pedantic(_all, (EVERYWHERE,), rounds=3)
    assert 5.0 < np.abs(moved).max() < 20.0


@pytest.mark.parametrize("count", [1, 6])
def test_pose_of_the_built_in_face(benchmark, count: int) -> None:
    face = builtin_face()
    names = [control.name for control in face.controls if control.group == "muscle"]
    pose = dict.fromkeys(names[: 3 * count : 3], 0.8) | {"jaw_pitch": 8.0, "lid_upper_l": 1.0}
    moved = benchmark(face.displace, pose)
    assert np.isfinite(moved).all()
    assert np.abs(moved).max() > 5.0
