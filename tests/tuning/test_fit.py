"""Fitting a shape by least squares, and the gallery that makes the faces."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pytest

from risorius._check import FloatArray
from risorius.tuning import FunctionCandidates, Genome, MuscleCandidates, Parameter
from risorius.tuning.candidates import Gallery
from risorius.tuning.fit import fit_shape
from tests.face_fixtures import builtin_face

REST = np.random.default_rng(2).normal(size=(40, 3))
PUSH, TURN = np.random.default_rng(3).normal(size=(2, 40, 3))
GENOME = Genome(
    (
        Parameter("push", -2.0, 4.0, 0.5),
        Parameter("turn", 0.0, 1.0, 1.0),
        Parameter("idle", -1.0, 1.0, 0.25),
    )
)


def _made(values: Mapping[str, float]) -> FloatArray:
    return REST + values["push"] * PUSH + np.sin(values["turn"]) * TURN


CANDIDATES = FunctionCandidates(GENOME, _made)


def test_a_shape_that_can_be_made_is_found_and_what_does_not_matter_stays() -> None:
    target = _made({"push": 3.2, "turn": 0.2, "idle": 0.0})
    found = fit_shape(CANDIDATES, target)
    assert found.after < 0.02 * found.before
    assert found.values["push"] == pytest.approx(3.2, abs=0.1)
    assert found.values["turn"] == pytest.approx(0.2, abs=0.05)
    assert found.values["idle"] == 0.25


def test_a_shape_out_of_reach_is_approached_at_the_bounds() -> None:
    found = fit_shape(CANDIDATES, _made({"push": 9.0, "turn": 0.5, "idle": 0.0}))
    assert found.values["push"] == pytest.approx(4.0)
    assert found.after < found.before
    low, high = GENOME.low, GENOME.high
    assert ((GENOME.values(found.values) >= low) & (GENOME.values(found.values) <= high)).all()


def test_what_is_met_already_is_left_alone() -> None:
    found = fit_shape(CANDIDATES, CANDIDATES.positions(GENOME.named(GENOME.start)))
    assert (found.before, found.after, found.iterations) == (0.0, 0.0, 0)
    assert found.values == GENOME.named(GENOME.start)


def test_a_fit_begins_where_it_is_told_and_tells_how_far_it_is() -> None:
    told: list[tuple[int, int]] = []
    start = np.array([3.0, 0.5, -0.5])
    target = _made({"push": 3.2, "turn": 0.4, "idle": 0.0})
    found = fit_shape(
        CANDIDATES, target, start=start, iterations=3, progress=lambda a, b, _: told.append((a, b))
    )
    assert found.values["idle"] == -0.5
    assert told[0] == (0, 3) and len(told) == found.iterations


def test_muscles_are_fitted_to_a_face_that_they_can_make() -> None:
    face = builtin_face()
    names = ("zygomaticus_major_l", "zygomaticus_major_r")
    candidates = MuscleCandidates(face, names, dict.fromkeys(names, 1.0), 130.0)
    genome = candidates.genome
    share = np.random.default_rng(4).uniform(0.2, 0.8, len(genome))
    wish = genome.low + share * (genome.high - genome.low)
    found = fit_shape(candidates, candidates.positions(genome.named(wish)), iterations=8)
    assert found.after < 0.3 * found.before


def test_the_gallery_makes_each_face_once_and_keeps_the_order() -> None:
    asked: list[float] = []

    def make(values: Mapping[str, float]) -> FloatArray:
        asked.append(values["push"])
        return _made(values)

    gallery = Gallery(FunctionCandidates(GENOME, make))
    rows = np.array([[0.5, 1.0, 0.0], [1.0, 0.0, 0.0], [0.5, 1.0, 0.0]])
    first = gallery.faces(rows)
    assert sorted(asked) == [0.5, 1.0]
    second = gallery.faces(np.array([[2.0, 0.0, 0.0], rows[1]]))
    assert sorted(asked) == [0.5, 1.0, 2.0]
    assert (second[1] == first[1]).all() and (first[0] == first[2]).all()
    assert (second[0] == _made(GENOME.named([2.0, 0.0, 0.0]))).all()
