from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from risorius.rig.quality.seam import Seam, SeamTest
from tests.rig.quality.made_heads import COLUMNS, mouth

HEAD, LIPS, PLACE, _ = mouth()
TEST = SeamTest(HEAD, LIPS)
UPPER, LOWER = LIPS.slit.upper, LIPS.slit.lower
CHIN = HEAD.vertex_count - 1
DOWN = np.array([0.0, -20.0, 8.0])


def opened() -> np.ndarray:
    """Return a mouth that the jaw opens: halves meet in the corners, as on a face."""
    away = np.clip(np.minimum(PLACE, 1.0 - PLACE) / 0.3, 0.0, 1.0)
    away = away * away * (3.0 - 2.0 * away)
    deltas = np.zeros((HEAD.vertex_count, 3))
    deltas[UPPER] = (0.5 - 0.5 * away)[:, None] * DOWN
    deltas[LOWER] = (0.5 + 0.5 * away)[:, None] * DOWN
    deltas[CHIN] = DOWN
    return deltas


def judged(deltas: np.ndarray) -> Seam:
    return TEST.seams(deltas[None])[0]


def test_a_clean_mouth_has_no_wrong_vertex_and_tells_its_opening() -> None:
    seam = judged(opened())
    assert (seam.lost, seam.invented) == ((), ())
    length = np.linalg.norm(DOWN)
    assert seam.chin == pytest.approx(length, rel=1e-12)
    assert seam.gap == pytest.approx(length, rel=0.01)
    assert seam.opening == pytest.approx(1.0, rel=0.01)


@pytest.mark.parametrize("column", range(6, COLUMNS - 6))
def test_a_lower_vertex_that_stays_with_the_upper_lip_is_lost(column: int) -> None:
    deltas = opened()
    deltas[LOWER[column]] = deltas[UPPER[column]]
    seam = judged(deltas)
    assert seam.lost == (LOWER[column],)
    assert seam.invented == ()


@pytest.mark.parametrize("column", range(6, COLUMNS - 6))
def test_an_upper_vertex_that_goes_with_the_lower_lip_is_invented(column: int) -> None:
    deltas = opened()
    deltas[UPPER[column]] = deltas[LOWER[column]]
    seam = judged(deltas)
    assert seam.invented == (UPPER[column],)
    assert seam.lost == ()


def test_wrong_vertices_are_found_where_the_upper_lip_is_the_one_that_moves() -> None:
    deltas = opened()
    deltas[UPPER], deltas[LOWER] = -deltas[LOWER], -deltas[UPPER]
    deltas[[UPPER[0], UPPER[-1]]] = -0.5 * DOWN
    deltas[CHIN] = 0.0
    swapped = deltas.copy()
    swapped[LOWER[20]] = deltas[UPPER[20]]
    swapped[UPPER[12]] = deltas[LOWER[12]]
    seam = judged(swapped)
    assert seam.invented == (LOWER[20],)
    assert seam.lost == (UPPER[12],)
    assert judged(deltas).opening is None


def test_a_run_of_wrong_vertices_is_found_as_a_whole() -> None:
    deltas = opened()
    deltas[LOWER[14:20]] = deltas[UPPER[14:20]]
    assert judged(deltas).lost == tuple(sorted(LOWER[14:20].tolist()))


def test_a_long_run_of_wrong_vertices_is_found_without_a_jaw() -> None:
    deltas = opened()
    deltas[CHIN] = 0.0
    deltas[LOWER[11:19]] = deltas[UPPER[11:19]]
    assert judged(deltas).lost == tuple(sorted(LOWER[11:19].tolist()))


def test_lips_that_close_have_no_gap() -> None:
    deltas = np.zeros((HEAD.vertex_count, 3))
    deltas[LOWER[1:-1], 1] = 0.05
    assert judged(deltas).gap == pytest.approx(0.0, abs=1e-12)


def test_half_a_lip_that_stays_behind_is_found_by_the_jaw_rule() -> None:
    deltas = opened()
    half = slice(5, 14)
    deltas[LOWER[half]] = deltas[UPPER[half]] * 0.2
    deltas[UPPER[half]] = deltas[UPPER[half]] * 0.2
    assert set(LOWER[half].tolist()) <= set(judged(deltas).lost)


def test_a_muscle_that_lowers_one_side_of_the_lip_is_no_fault() -> None:
    deltas = np.zeros((HEAD.vertex_count, 3))
    deltas[LOWER] = np.exp(-(((PLACE - 0.3) / 0.1) ** 2))[:, None] * DOWN
    deltas[CHIN] = 0.3 * DOWN
    seam = judged(deltas)
    assert (seam.lost, seam.invented) == ((), ())


def test_what_only_the_corners_do_is_no_fault() -> None:
    deltas = np.zeros((HEAD.vertex_count, 3))
    for columns in (np.arange(5), COLUMNS - 1 - np.arange(5)):
        deltas[UPPER[columns], 1] = (-0.5, -1.1, -1.1, -0.4, 0.0)
        deltas[LOWER[columns], 1] = (-0.5, 0.8, 1.0, 0.1, 0.0)
    # A trifle that the line does everywhere: at rest everything would be alike.
    deltas[UPPER[5:-5], 1] = -0.02
    seam = judged(deltas)
    assert (seam.lost, seam.invented) == ((), ())


def test_a_mouth_of_a_few_vertices_is_measured_but_not_judged() -> None:
    head, lips, _, _ = mouth()
    short = np.array([0, 20, COLUMNS - 1], np.int32)
    below = np.array([0, COLUMNS + 19, COLUMNS - 1], np.int32)
    coarse = replace(lips, slit=replace(lips.slit, upper=short, lower=below))
    seam = SeamTest(head, coarse).seams(opened()[None])[0]
    assert (seam.lost, seam.invented) == ((), ())
    assert seam.gap > 20.0


@given(
    st.lists(st.floats(-1.0, 1.0), min_size=24, max_size=24),
    st.floats(0.5, 30.0),
)
def test_smooth_lips_never_have_wrong_vertices(numbers: list[float], size: float) -> None:
    coefficients = np.array(numbers).reshape(2, 4, 3)
    basis = np.polynomial.legendre.legvander(2.0 * PLACE - 1.0, 3)
    deltas = np.zeros((HEAD.vertex_count, 3))
    ends = PLACE * (1.0 - PLACE)
    deltas[UPPER] = size * ends[:, None] * (basis @ coefficients[0])
    deltas[LOWER] = size * ends[:, None] * (basis @ coefficients[1])
    seam = judged(deltas)
    assert (seam.lost, seam.invented) == ((), ())


def test_lips_that_move_alike_have_no_wrong_vertex() -> None:
    deltas = np.broadcast_to(DOWN, (HEAD.vertex_count, 3)).copy()
    seam = judged(deltas)
    assert (seam.lost, seam.invented, seam.gap) == ((), (), pytest.approx(0.0, abs=1e-12))


def test_shapes_are_judged_one_by_one() -> None:
    wrong = opened()
    wrong[LOWER[20]] = 0.0
    seams = TEST.seams(np.stack([opened(), wrong, np.zeros_like(wrong)]))
    assert [len(seam.lost) for seam in seams] == [0, 1, 0]
    assert seams[1] == judged(wrong)
