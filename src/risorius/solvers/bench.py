"""Measure the solver: every way to run it, in turns, in one process.

Times are of the processor, not of the clock, and of the fastest round, so that other work on the
machine disturbs little.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from risorius._check import FloatArray
from risorius.errors import ParameterError
from risorius.mesh.core import TriMesh
from risorius.solvers.constraints import Constraints, Holds
from risorius.solvers.layout import layout_of
from risorius.solvers.model import Control, Model, State
from risorius.solvers.parameters import Parameters
from risorius.solvers.pbd import Solver
from risorius.solvers.peer import peer_iteration
from risorius.solvers.runs import LaneRun, Run, SingleRun
from risorius.solvers.surface import SurfaceStiffness, surface_constraints
from risorius.solvers.trial_head import trial_head

__all__ = ["SIZES", "head_model", "run", "settle_all"]

# Vertex counts of thesis table 5.1, and two that are larger.
SIZES = (1466, 2502, 4604, 4904, 20000, 80000)
_LANE_POSES = 16
# Constraint-iterations per timed call: a few milliseconds at every size, and enough sweeps for
# the caches to hold what they hold in a long run.
_WORK = 400_000
_FEWEST = 4
# Area stiffness of .95, as published, trembles on slivers; time does not depend on it.
_STIFFNESS = SurfaceStiffness(area=0.5)
_ANCHOR = 0.2


def head_model(mesh: TriMesh) -> tuple[Model, FloatArray]:
    """Return the model of a head's skin whose front is held, and the targets (k, 3) of a pull.

    A patch at the mouth corner is drawn sideways and up by a twentieth of the head's height.
    """
    positions = mesh.positions
    front = np.flatnonzero((positions[:, 2] > -25.0) & (positions[:, 1] > -85.0)).astype(np.int32)
    skin = surface_constraints(mesh, _STIFFNESS)
    holds = Holds(front, np.full(len(front), _ANCHOR))
    constraints = Constraints(skin.distances, skin.areas, skin.bends, skin.volumes, holds)
    corner = np.array([25.0, -35.0, 0.75 * positions[:, 2].max()])
    gap = np.linalg.norm(positions[front] - corner, axis=1)
    pull = np.clip(1.0 - (gap / 35.0) ** 2, 0.0, 1.0) ** 2
    targets = positions[front] + pull[:, None] * np.array([6.0, 8.0, 0.0])
    return Model(positions, constraints), targets


def run(sizes: Sequence[int] = SIZES, *, rounds: int = 9, with_peer: bool = True) -> dict[str, Any]:
    """Return times and ratios for each size of `sizes`, as plain numbers and words.

    Per size: vertex and constraint counts; seconds to order the constraints; for each way
    ("scalar", "packed", "lanes", and "pypbd" where it is installed) milliseconds per iteration
    and pose, nanoseconds per constraint, and how many times faster than "scalar" it is; memory of
    tables and positions of our own ways, for "lanes" of all 16 poses [MB]; the largest difference
    from the scalar result, relative to the largest motion. "pypbd" does distances, bends and
    triangle strains only.
    """
    if rounds < 1:
        raise ParameterError(f"rounds: {rounds} must be 1 or more")
    return {str(size): _one_size(size, rounds, with_peer=with_peer) for size in sizes}


def settle_all(size: int, *, pose_count: int = 84) -> dict[str, Any]:
    """Return what it takes to bring many poses of one head to rest at once, on one thread.

    Vertex and pose count; processor seconds of the second of two runs; sweeps of the slowest
    pose; whether all have settled.
    """
    model, targets = head_model(trial_head(size))
    held = model.rest_positions[model.constraints.holds.particles]
    shares = np.linspace(-1.0, 1.0, pose_count)[:, None, None]
    control = Control(targets=held + shares * (targets - held))
    state, solver = State.at_rest(model, pose_count=pose_count), Solver()
    found = solver.settle(model, state, control)
    began = time.process_time()
    solver.settle(model, state, control)
    seconds = time.process_time() - began
    return {
        "vertex_count": model.particle_count,
        "pose_count": pose_count,
        "seconds": seconds,
        "sweeps": int(found.iterations.max()),
        "has_settled": found.has_settled,
    }


def _one_size(size: int, rounds: int, *, with_peer: bool) -> dict[str, Any]:
    mesh = trial_head(size)
    model, targets = head_model(mesh)
    began = time.process_time()
    order = model.order
    ordered = time.process_time() - began
    count = model.constraints.count
    iterations = max(_FEWEST, round(_WORK / count))
    control, parameters = Control(targets=targets), Parameters()
    sequence64 = layout_of(model, parameters, "sequence", np.float64)
    sequence32 = layout_of(model, parameters, "sequence", np.float32)
    packed32 = layout_of(model, parameters, "packed", np.float32)
    scalar = SingleRun(model, control, parameters, sequence64)
    packed = SingleRun(model, control, parameters, packed32)
    lanes = LaneRun(model, control, parameters, sequence32, pose_count=_LANE_POSES, threads=1)
    difference = _differences(model, scalar, packed, lanes)
    ways: dict[str, tuple[Callable[[int], None], int, int]] = {
        "scalar": (scalar.sweep, iterations, 1),
        "packed": (packed.sweep, iterations, 1),
        "lanes": (lanes.sweep, _FEWEST, _LANE_POSES),
    }
    peer = peer_iteration(model) if with_peer else None
    if peer is not None:
        ways["pypbd"] = (peer, _FEWEST, 1)
    times = _interleaved(ways, rounds)
    runs = {"scalar": scalar, "packed": packed, "lanes": lanes}
    filled = sum(len(g) for g in (order.distances, order.areas, order.bends))
    used = count - len(order.holds) - len(model.constraints.volumes)
    return {
        "vertex_count": mesh.vertex_count,
        "constraint_count": count,
        "seconds_to_order": ordered,
        "group_fill": used / (filled * order.distances.shape[1]),
        "megabytes": {name: run.byte_count / 1e6 for name, run in runs.items()},
        "difference_from_scalar": difference,
        "ways": {
            name: {
                "milliseconds": 1e3 * min(spent),
                "nanoseconds_per_constraint": 1e9 * min(spent) / count,
                "times_faster_than_scalar": min(times["scalar"]) / min(spent),
            }
            for name, spent in times.items()
        },
    }


def _differences(
    model: Model, scalar: SingleRun, packed: SingleRun, lanes: LaneRun
) -> dict[str, float]:
    """Run all ways for a few sweeps from rest; return how far the results are apart."""
    rest = model.rest_positions

    def after(run: Run, start: FloatArray) -> FloatArray:
        run.place(start)
        run.sweep(10)
        return run.positions()

    exact = after(scalar, rest)
    motion = float(np.abs(exact - rest).max())
    several = after(lanes, np.broadcast_to(rest, (_LANE_POSES, *rest.shape)))
    return {
        "packed": float(np.abs(after(packed, rest) - exact).max()) / motion,
        "lanes": float(np.abs(several - exact).max()) / motion,
    }


def _interleaved(
    ways: dict[str, tuple[Callable[[int], None], int, int]], rounds: int
) -> dict[str, list[float]]:
    """Return the processor time per iteration and pose of every way and round [s]."""
    times: dict[str, list[float]] = {name: [] for name in ways}
    for _ in range(rounds):
        for name, (sweep, iterations, poses) in ways.items():
            began = time.process_time()
            sweep(iterations)
            times[name].append((time.process_time() - began) / (iterations * poses))
    return times
