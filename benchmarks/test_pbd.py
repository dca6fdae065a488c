"""Speed of the position-based solver against its scalar reference, in one run.

`risorius.solvers.bench.run` gives the figures for all sizes of thesis table 5.1 and beyond.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from risorius.solvers.bench import head_model, run
from risorius.solvers.model import Control, State
from risorius.solvers.parameters import PROFILES, Parameters
from risorius.solvers.pbd import Solver
from risorius.solvers.trial_head import trial_head

SIZE = 4904


@pytest.fixture(scope="module")
def head():
    return head_model(trial_head(SIZE))


@pytest.mark.parametrize("path", ["scalar", "simd"])
def test_one_step_of_one_pose(benchmark, head, path: str) -> None:
    model, targets = head
    state, control, solver = State.at_rest(model), Control(targets=targets), Solver(path=path)
    after = benchmark(solver.step, model, state, control)
    exact = Solver(path="scalar").step(model, state, control)
    assert np.abs(after.positions - exact.positions).max() < 1e-5 * model.size


@pytest.mark.parametrize("profile", sorted(PROFILES))
def test_one_pose_settles(benchmark, head, profile: str) -> None:
    model, targets = head
    state, control, solver = State.at_rest(model), Control(targets=targets), Solver()
    found = benchmark(solver.settle, model, state, control, parameters=PROFILES[profile])
    assert found.has_settled
    assert 1.0 < np.abs(found.positions - model.rest_positions).max() < 10.0


def test_84_poses_settle_together(benchmark, head) -> None:
    model, targets = head
    held = model.rest_positions[model.constraints.holds.particles]
    shares = np.linspace(-1.0, 1.0, 84)[:, None, None]
    control = Control(targets=held + shares * (targets - held))
    state, solver = State.at_rest(model, pose_count=84), Solver()
    found = benchmark.pedantic(
        solver.settle, (model, state, control), {"parameters": Parameters()}, rounds=3
    )
    assert found.has_settled
    alone = solver.settle(model, State.at_rest(model), Control(targets=targets))
    assert np.abs(found.positions[-1] - alone.positions).max() < 1e-4 * model.size


@pytest.mark.parametrize("size", [1466, 2502, 4604, 4904, 20000, 80000])
def test_all_ways_against_the_scalar_reference(benchmark, size: int) -> None:
    found = benchmark.pedantic(run, ([size],), {"rounds": 5}, rounds=1)[str(size)]
    benchmark.extra_info.update(found)
    assert max(found["difference_from_scalar"].values()) < 1e-3
    # Far below what is reached, so that a busy machine does not fail: a broken way does.
    assert found["ways"]["packed"]["times_faster_than_scalar"] > 1.5
    assert found["ways"]["lanes"]["times_faster_than_scalar"] > 3.0


def test_the_order_is_made_in_time_proportional_to_the_constraints(benchmark) -> None:
    model, _ = head_model(trial_head(20000))
    fresh = replace(model)
    order = benchmark.pedantic(lambda: replace(fresh).order, rounds=3)
    assert sum((group >= 0).sum() for group in (order.distances, order.areas, order.bends)) > 2e5
