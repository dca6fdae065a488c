"""The most probable point that comparisons point to, and the faces that are shown for it."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property

import numpy as np
import pytest

from risorius.tuning import Genome, Parameter, Session
from risorius.tuning.looks import Looks
from risorius.tuning.objective import MadeUpUser
from risorius.tuning.preference import most_probable


def _compared(
    wish: np.ndarray, count: int, seed: int, *, noise: float = 0.1
) -> tuple[np.ndarray, np.ndarray]:
    """Return half spaces that the wish, a point around the middle of the range, speaks for."""
    pairs = np.random.default_rng(seed).uniform(-0.5, 0.5, size=(count, 2, len(wish)))
    nearer = np.linalg.norm(pairs - wish, axis=2).argmin(axis=1)
    rows = np.arange(count)
    better, worse = pairs[rows, nearer], pairs[rows, 1 - nearer]
    apart = better - worse
    power = noise * (apart**2).sum(axis=1)
    offset = (apart * 0.5 * (better + worse)).sum(axis=1)
    return apart / power[:, None], offset / power


def test_without_comparisons_the_middle_is_the_most_probable() -> None:
    point, factor = most_probable(np.zeros((0, 3)), np.zeros(0))
    assert not point.any()
    assert np.allclose(factor @ factor.T, 12.0 * np.eye(3))


@pytest.mark.parametrize("lapse", [0.0, 0.1])
def test_many_comparisons_find_the_wish(lapse: float) -> None:
    wish = np.array([0.3, -0.2, 0.05])
    point, _ = most_probable(*_compared(wish, 300, 0), lapse=lapse)
    assert np.abs(point - wish).max() < 0.08


def test_the_point_is_a_minimum() -> None:
    slope, offset = _compared(np.array([0.3, -0.2]), 12, 1, noise=0.25)

    def cost(u: np.ndarray) -> float:
        return float(np.log1p(np.exp(offset - slope @ u)).sum() + 6.0 * (u**2).sum())

    point, _ = most_probable(slope, offset)
    step = 1e-5
    for axis in np.eye(2):
        assert abs(cost(point + step * axis) - cost(point - step * axis)) < 2.0 * step * 1e-5


def test_lapses_are_forgiven() -> None:
    wish = np.array([0.3, -0.2, 0.05])
    slope, offset = _compared(wish, 200, 2)
    wrong = np.where(np.arange(200) % 5 == 0, -1.0, 1.0)
    errors = [
        np.linalg.norm(most_probable(wrong[:, None] * slope, wrong * offset, lapse=lapse)[0] - wish)
        for lapse in (0.0, 0.2)
    ]
    assert errors[1] < errors[0]


class _Curve:
    """Two numbers bend a row of vertices; a third moves nothing."""

    genome = Genome(
        (
            Parameter("bend", -1.0, 1.0, 0.0),
            Parameter("turn", -1.0, 1.0, 0.2),
            Parameter("idle", -1.0, 1.0, 0.0),
        )
    )

    @cached_property
    def made(self) -> list[float]:
        return []

    def positions(self, values: Mapping[str, float]) -> np.ndarray:
        self.made.append(values["bend"])
        x = np.linspace(-1.0, 1.0, 40)
        y = values["bend"] * (1.0 + values["turn"]) * x**2 + values["turn"] * x
        return 10.0 * np.stack([x, y, 0.0 * x], axis=1)


def _face(values: list[float]) -> np.ndarray:
    return Looks(_Curve()).face(np.array(values))


def test_slopes_are_those_of_the_face_wherever_they_are_asked_for() -> None:
    looks, step = Looks(_Curve()), 1e-4
    for here in (np.array([0.3, -0.4, 0.0]), np.array([1.0, 1.0, 1.0])):
        slopes = looks.slopes(here)
        for row in range(3):
            other = here.copy()
            other[row] -= step
            change = (looks.face(here) - looks.face(other)) / step * 2.0
            assert np.abs(slopes[:, row] - change).max() < 0.15 * (1.0 + np.abs(change).max())
        assert not slopes[:, 2].any()


def test_no_face_is_made_twice() -> None:
    curve = _Curve()
    looks = Looks(curve)
    here = np.array([0.2, 0.1, 0.0])
    looks.slopes(here)
    made = len(curve.made)
    looks.slopes(here)
    looks.face(here)
    looks.positions(curve.genome.named(here))
    assert len(curve.made) == made


def test_the_first_faces_are_pairs_around_the_start_equally_far_from_it() -> None:
    session = Session(_Curve.genome, strategy="preference", looks=Looks(_Curve()))
    made = session.generation.candidates
    np.testing.assert_array_equal(made[0], _Curve.genome.start)
    np.testing.assert_allclose(made[1::2] + made[2::2], 2.0 * np.tile(made[0], (4, 1)), atol=1e-12)
    far = [np.linalg.norm(_face(list(each))) for each in made[1:]]
    assert max(far) < 2.0 * min(far)


@pytest.mark.parametrize("error", [0.0, 0.2])
def test_a_user_who_sees_faces_finds_the_wish_though_effects_depend_on_each_other(
    error: float,
) -> None:
    wish = _face([-0.7, 0.9, 0.0])

    def distance(values: np.ndarray) -> float:
        return float(np.linalg.norm(_face(values.tolist()) - wish))

    left: list[float] = []
    for seed in range(8):
        session = Session(_Curve.genome, strategy="preference", seed=seed, looks=Looks(_Curve()))
        user = MadeUpUser(distance, error=error, seed=seed)
        first = distance(_Curve.genome.start)
        for _ in range(10):
            session.pick(user(session.generation))
        # Where people err the best pick may be wrong; the most probable face stands second.
        left.append(distance(session.generation.candidates[1]) / first)
    assert np.median(left) < 0.25


def test_nothing_that_may_not_be_shown_is_shown() -> None:
    def admit(values: np.ndarray) -> bool:
        return abs(values[0]) < 0.05

    session = Session(_Curve.genome, strategy="genetic", looks=Looks(_Curve()), admit=admit)
    for _ in range(3):
        assert np.abs(session.generation.candidates[:, 0]).max() < 0.05
        assert np.ptp(session.generation.candidates[:, 1]) > 0.0
        session.pick([0, 3])
