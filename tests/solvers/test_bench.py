"""The measurement measures what it says, and its trial heads are what they claim to be."""

from __future__ import annotations

import json

import numpy as np
import pytest

from risorius.errors import ParameterError
from risorius.mesh.topology import report
from risorius.solvers.bench import run
from risorius.solvers.trial_head import trial_head


def test_a_run_gives_every_figure_as_plain_numbers() -> None:
    found = json.loads(json.dumps(run([400], rounds=2, with_peer=False)))["400"]
    assert abs(found["vertex_count"] - 400) < 20
    assert set(found["ways"]) == {"scalar", "packed", "lanes"}
    for way in found["ways"].values():
        assert way["milliseconds"] > 0.0
        assert way["nanoseconds_per_constraint"] == pytest.approx(
            1e6 * way["milliseconds"] / found["constraint_count"]
        )
    assert found["ways"]["scalar"]["times_faster_than_scalar"] == 1.0
    assert 0.5 < found["group_fill"] <= 1.0
    assert 0.0 < found["difference_from_scalar"]["packed"] < 1e-3
    assert 0.0 < found["difference_from_scalar"]["lanes"] < 1e-3


def test_a_run_of_no_rounds_is_refused() -> None:
    with pytest.raises(ParameterError, match="rounds: 0 must be 1 or more"):
        run([400], rounds=0)


@pytest.mark.parametrize("count", [300, 1466, 5000])
def test_a_trial_head_is_an_oriented_manifold_with_four_holes(count: int) -> None:
    mesh = trial_head(count)
    found = report(mesh)
    assert abs(mesh.vertex_count - count) < 0.05 * count
    assert found.component_count == 1
    assert found.is_manifold
    assert not len(found.inconsistent_edges)
    assert not len(found.unused_vertices)
    assert len(found.boundary_loops) == 4
    assert np.array_equal(mesh.positions, trial_head(count).positions)
