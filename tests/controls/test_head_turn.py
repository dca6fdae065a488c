from __future__ import annotations

import pytest

from risorius.controls.head_turn import HEAD_TURNS, head_turn_of, parameters_of_turn


def test_mpeg4_nods_down_turns_left_and_tilts_right() -> None:
    assert head_turn_of({"fap_48": 1e5}) == pytest.approx((-57.29578, 0.0, 0.0))
    assert head_turn_of({"fap_49": 1e5}) == pytest.approx((0.0, 57.29578, 0.0))
    assert head_turn_of({"fap_50": 1e5}) == pytest.approx((0.0, 0.0, -57.29578))


def test_turns_and_parameters_are_two_ways_of_saying_the_same() -> None:
    turn = (12.0, -30.0, 7.0)
    assert head_turn_of(parameters_of_turn(turn)) == pytest.approx(turn)
    named = dict(zip(HEAD_TURNS, turn))
    assert head_turn_of({**named, **parameters_of_turn(turn)}) == pytest.approx((24, -60, 14))
