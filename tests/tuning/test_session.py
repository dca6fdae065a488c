"""Sessions: picks, undo, locks, and every strategy behind the same interface."""

from __future__ import annotations

import sys

import numpy as np
import pytest

from risorius.errors import ParameterError
from risorius.tuning import STRATEGIES, Genome, Parameter, Session, tune
from risorius.tuning.objective import MadeUpUser

GENOME = Genome(tuple(Parameter(f"gene{row}", -1.0, 3.0, 0.5) for row in range(6)))
STRATEGY = pytest.mark.parametrize("strategy", sorted(STRATEGIES))


def _session(strategy: str, seed: int = 3) -> Session:
    if strategy == "cma":
        pytest.importorskip("cma")
    return Session(GENOME, strategy=strategy, seed=seed)


def test_the_three_strategies_are_registered() -> None:
    assert sorted(STRATEGIES) == ["cma", "genetic", "preference"]


@STRATEGY
def test_nine_candidates_start_with_the_proposal_and_stay_in_bounds(strategy: str) -> None:
    session = _session(strategy)
    assert (session.generation.candidates[0] == GENOME.start).all()
    for picks in ([0, 3, 8], [2], [5, 1], []):
        shown = session.generation.candidates
        assert shown.shape == (9, 6)
        assert ((shown >= GENOME.low) & (shown <= GENOME.high)).all()
        assert len(np.unique(shown, axis=0)) > 5
        session.pick(picks)


@STRATEGY
def test_same_seed_and_picks_show_the_same_faces_and_another_seed_others(strategy: str) -> None:
    first, again, other = _session(strategy), _session(strategy), _session(strategy, seed=4)
    for session in (first, again, other):
        session.pick([1, 2, 3])
        session.pick([4])
    assert (first.generation.candidates == again.generation.candidates).all()
    assert (first.generation.candidates != other.generation.candidates).any()


@STRATEGY
def test_the_best_pick_is_shown_again(strategy: str) -> None:
    session = _session(strategy)
    liked = session.generation.candidates[5].copy()
    assert (session.pick([5, 1]).candidates == liked).all(axis=1).any()
    assert session.best == GENOME.named(liked)


@STRATEGY
def test_undo_brings_back_the_faces_and_a_reroll_shows_others(strategy: str) -> None:
    session = _session(strategy)
    before = session.generation.candidates.copy()
    after = session.pick([2, 7]).candidates.copy()
    assert (session.undo().candidates == before).all()
    assert (session.pick([2, 7]).candidates == after).all()
    assert (session.reroll().candidates != after).any()
    assert len(session.rounds) == 1


@STRATEGY
def test_a_locked_parameter_stays_where_it_was_liked(strategy: str) -> None:
    session = _session(strategy)
    session.pick([4])
    value = session.best["gene2"]
    session.lock(["gene2"])
    for _ in range(3):
        assert (session.generation.candidates[:, 2] == value).all()
        session.pick([1, 3])
    assert session.locked == ("gene2",)
    session.unlock(["gene2"])
    assert np.ptp(session.pick([1, 3]).candidates[:, 2]) > 0.0


@STRATEGY
def test_a_user_with_a_wish_comes_nearer_to_it(strategy: str) -> None:
    wish = np.array([2.0, -0.4, 1.4, 0.0, 2.6, 0.3])

    def distance(values: np.ndarray) -> float:
        return float(np.linalg.norm(values - wish))

    gains = []
    for seed in range(5):
        found = tune(_session(strategy, seed), MadeUpUser(distance, seed=seed), generations=12)
        gains.append(distance(GENOME.values(found)) / distance(GENOME.start))
    assert np.median(gains) < 0.6


def test_learning_from_picks_needs_fewer_generations_than_breeding() -> None:
    rng = np.random.default_rng(0)
    wishes = rng.uniform(GENOME.low, GENOME.high, size=(8, 6))

    def error(strategy: str) -> float:
        result = []
        for seed, wish in enumerate(wishes):
            user = MadeUpUser(lambda values, wish=wish: float(np.linalg.norm(values - wish)))
            found = tune(_session(strategy, seed), user, generations=8)
            result.append(np.linalg.norm(GENOME.values(found) - wish))
        return float(np.median(result))

    assert error("preference") < 0.6 * error("genetic")


def test_nine_equal_faces_open_the_ranges_again() -> None:
    session = Session(GENOME, seed=1)
    session.lock(GENOME.names)
    session.pick([0])
    session.unlock(GENOME.names)
    assert np.median(np.ptp(session.pick([0]).candidates, axis=0)) > 1.0


def test_ranges_shrink_and_stay_inside_the_bounds() -> None:
    session = Session(GENOME, seed=1)
    widths = []
    for _ in range(5):
        generation = session.pick([8, 1])
        assert (generation.low >= GENOME.low - 1e-12).all()
        assert (generation.high <= GENOME.high + 1e-12).all()
        widths.append(float((generation.high - generation.low).max()))
    assert np.allclose(np.array(widths[1:]) / widths[:-1], 0.85)


def test_an_erring_user_picks_other_faces_now_and_then() -> None:
    generation = Session(GENOME).generation
    surely = MadeUpUser(lambda values: float(values[0]))(generation)
    erring = MadeUpUser(lambda values: float(values[0]), error=1.0)(generation)
    assert len(set(surely)) == len(set(erring)) == 3
    assert not set(erring) <= set(surely)


def test_asking_ends_when_the_answer_is_none() -> None:
    answers = iter([[3], None, [1]])
    session = Session(GENOME)
    wanted = GENOME.named(session.generation.candidates[3])
    assert tune(session, lambda _: next(answers)) == wanted
    assert session.accept(0) == GENOME.named(session.generation.candidates[0])


@pytest.mark.parametrize("picks", [[9], [-1], [1, 1]])
def test_senseless_picks_are_refused(picks: list[int]) -> None:
    with pytest.raises(ParameterError, match="give different numbers from 1 to 9"):
        Session(GENOME).pick(picks)


def test_other_senseless_wishes_are_refused(monkeypatch) -> None:
    with pytest.raises(ParameterError, match="'luck' is not one of cma, genetic, preference"):
        Session(GENOME, strategy="luck")
    with pytest.raises(ParameterError, match="nothing was picked yet"):
        Session(GENOME).undo()
    with pytest.raises(ParameterError, match="there is no nose"):
        Session(GENOME).lock(["nose"])
    monkeypatch.setitem(sys.modules, "cma", None)
    with pytest.raises(ImportError, match=r"pip install risorius\[tuning\]"):
        Session(GENOME, strategy="cma")
