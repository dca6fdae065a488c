from __future__ import annotations

import numpy as np
import pytest

from risorius.layered.faithful.motion import MovingMuscles
from risorius.solvers.model import State
from risorius.solvers.pbd import Solver
from tests.layered.faithful.ground import PUBLISHED, flat_ground, lay, sheet


def _moving() -> MovingMuscles:
    anatomy = flat_ground()
    lay(anatomy, sheet("base", [(0, 0), (0, 40)]))
    lay(anatomy, sheet("other", [(30, 0), (30, 40)]))
    lay(anatomy, sheet("top", [(0, 5), (0, 35)], on=("base",), layer=2, half_width=5))
    return MovingMuscles(anatomy, PUBLISHED, solver=Solver(path="scalar"))


def test_muscles_stand_in_layers_deep_before_superficial() -> None:
    moving = _moving()
    names = [[laid.name for laid in layer.muscles] for layer in moving.layers]
    assert names == [["base", "other"], ["top"]]
    assert moving.bone_count == 81


def test_a_muscle_rests_where_nothing_pulls() -> None:
    moving = _moving()
    rest = moving.anatomy.positions
    np.testing.assert_allclose(moving.settle(rest, {}), rest, atol=1e-9)


def test_bones_take_their_muscles_along() -> None:
    moving = _moving()
    rest = moving.anatomy.positions
    bones = rest + [3.0, 0.0, 0.0]
    moved = moving.settle(bones, {})
    np.testing.assert_allclose(moved - rest, np.broadcast_to([3.0, 0, 0], rest.shape), atol=1e-3)


def test_only_the_named_muscle_and_what_lies_on_it_move() -> None:
    moving = _moving()
    rest = moving.anatomy.positions
    moved = np.abs(moving.settle(rest, {"base": 0.4}) - rest).max(axis=1)
    by_name = {
        laid.name: moved[laid.surface.first : laid.surface.last].max()
        for laid in moving.anatomy.muscles
    }
    assert by_name["base"] > 5.0
    assert by_name["top"] > 1.0
    assert by_name["other"] < 1e-9


def test_a_muscle_shortens_by_its_limit_at_most() -> None:
    moving = _moving()
    laid = moving.anatomy.muscles[0]
    assert moving.contractions({"base": 1.0})["base"] == laid.muscle.shortening


def test_steps_draw_the_fibres_where_settling_does() -> None:
    moving = _moving()
    rest = moving.anatomy.positions
    state = State(rest.copy(), np.zeros_like(rest))
    for _ in range(400):
        state = moving.step(state, rest, {"base": 0.3})
    settled = moving.settle(rest, {"base": 0.3}, steps=1)
    laid = moving.anatomy.muscles[0]
    # Vertices without targets may rest in several ways, those with targets in one.
    held = laid.surface.first + np.concatenate(laid.lines.held)
    moved = np.abs(settled - rest)[held].max()
    assert moved > 5.0
    assert np.abs(state.positions - settled)[held].max() < 0.05 * moved


def test_supports_reach_down_to_the_bone() -> None:
    supports = _moving().anatomy.supports()
    assert supports == {
        "base": {"cranium"},
        "other": {"cranium"},
        "top": {"base", "cranium"},
    }


@pytest.mark.parametrize("contraction", [0.2, 0.5])
def test_the_origin_stays_when_it_is_held(contraction: float) -> None:
    from risorius.layered.faithful.parameters import FaithfulParameters

    p = FaithfulParameters(wide=1e9, muscle_solver=PUBLISHED.muscle_solver)
    anatomy = flat_ground()
    laid = lay(anatomy, sheet("a", [(0, 0), (0, 40)]), p)
    moving = MovingMuscles(anatomy, p, solver=Solver(path="scalar"))
    moved = moving.settle(anatomy.positions, {"a": contraction})
    origin = slice(laid.surface.first, laid.surface.first + laid.mesh.columns)
    off = np.abs(moved[origin] - anatomy.positions[origin]).max()
    end = slice(
        laid.surface.first + 4 * laid.mesh.columns, laid.surface.first + 5 * laid.mesh.columns
    )
    assert off < 0.15 * np.abs(moved[end] - anatomy.positions[end]).max()
