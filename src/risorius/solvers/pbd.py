"""The position-based solver: steps through time, and poses that have settled."""

from __future__ import annotations

import weakref
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from risorius._check import FloatArray, IntArray, one_of
from risorius.errors import ParameterError, ShapeError, SolverError
from risorius.mesh.core import TriMesh
from risorius.solvers.layout import Layout, layout_of
from risorius.solvers.model import Control, Model, State
from risorius.solvers.parameters import Parameters
from risorius.solvers.residuals import residuals
from risorius.solvers.runs import LaneRun, Run, SingleRun
from risorius.solvers.surface import surface_constraints

__all__ = ["Path", "Settled", "Solver", "warm_up"]

Path = Literal["simd", "scalar"]
_PATHS = ("simd", "scalar")
# The test for rest spans a sweep in each direction (finding S6).
_TEST_SWEEPS = 2
# Tolerances, in those asked for, at which compliant constraints begin again without pushes.
_STAGES = np.array([100.0, 10.0, 1.0])


@dataclass(frozen=True, eq=False)
class Settled:
    """Where particles come to rest.

    Parameters
    ----------
    positions : (n, 3) float64
        Or (s, n, 3) [mm].
    iterations : (s,) int32
        Sweeps until rest of every pose; one entry for a single pose.
    moves : (s,) float64
        Largest motion of a particle in the last two sweeps [mm].
    has_settled : bool
        Whether every pose met the tolerance.
    """

    positions: FloatArray
    iterations: IntArray
    moves: FloatArray
    has_settled: bool


class Solver:
    """Position-based dynamics (thesis section 3.1; errata E1-E5).

    Keeps nothing between calls but tables that it has made for models it has seen: the result of
    a call depends on its arguments only, and the same arguments give the same bytes.

    Parameters
    ----------
    path : {"simd", "scalar"}
        float32 in vectors (constraints side by side for one pose, poses side by side for
        several), or the float64 reference, one constraint and one pose after the other.
    threads : int
        Threads that share the blocks of 16 poses; the result does not depend on it.
    """

    def __init__(self, *, path: Path = "simd", threads: int = 1) -> None:
        self.path = one_of("path", path, _PATHS)
        if threads < 1:
            raise ParameterError(f"threads: {threads} must be 1 or more")
        self.threads = threads
        self._layouts: weakref.WeakKeyDictionary[Model, dict[tuple[object, ...], Layout]] = (
            weakref.WeakKeyDictionary()
        )

    def step(
        self,
        model: Model,
        state: State,
        control: Control | None = None,
        *,
        parameters: Parameters | None = None,
    ) -> State:
        """Return the state after one step of `parameters.dt`.

        Raises
        ------
        SolverError
            If a coordinate stops being a finite number.
        """
        control, parameters = control or Control(), parameters or Parameters()
        self._require_fit(model, state)
        if self.path == "scalar" and state.positions.ndim == 3:
            return self._each_step(model, state, control, parameters)
        run = self._run(model, state, control, parameters)
        dt = parameters.dt / parameters.substeps
        kept = (1.0 - parameters.damping) ** (1.0 / parameters.substeps)
        push = np.zeros(3) if control.acceleration is None else np.asarray(control.acceleration)
        positions, velocities = state.positions, state.velocities
        for _ in range(parameters.substeps):
            velocities = (velocities + push * dt * (model.weights[:, None] > 0.0)) * kept
            start = positions + velocities * dt
            run.place(start)
            run.sweep(parameters.iterations)
            if not run.is_finite():
                raise _failure(model, run, start, parameters.iterations)
            moved = run.positions()
            velocities, positions = (moved - positions) / dt, moved
        return State(positions, velocities, state.positions)

    def settle(
        self,
        model: Model,
        state: State,
        control: Control | None = None,
        *,
        parameters: Parameters | None = None,
    ) -> Settled:
        """Return where the particles come to rest, each pose as if it were alone.

        Without velocities: sweeps go on until no particle moves more than
        ``tolerance * model.size`` in two of them. With compliance every two sweeps are a step of
        `dt` that begins with the pushes of the last one; its rest is the least energy of the
        constraints, whatever their order and the duration of a step. Pushes gathered on the way
        point where constraints pointed then, so they are forgotten twice before the end.

        Raises
        ------
        SolverError
            If a coordinate stops being a finite number. Not settling within `iteration_limit`
            sweeps is no error: see `Settled.has_settled`.
        """
        control, parameters = control or Control(), parameters or Parameters()
        self._require_fit(model, state)
        if self.path == "scalar" and state.positions.ndim == 3:
            return self._each_settled(model, state, control, parameters)
        run = self._run(model, state, control, parameters)
        is_compliant = parameters.stiffness_rule == "compliance"
        bounds = parameters.tolerance * model.size * (_STAGES if is_compliant else _STAGES[-1:])
        run.place(state.positions)
        run.mark()
        start = result = run.positions()
        pose_count = 1 if start.ndim == 2 else len(start)
        stage, is_open = np.zeros(pose_count, np.int32), np.ones(pose_count, bool)
        iterations, moves = np.zeros(pose_count, np.int32), np.zeros(pose_count)
        for done in range(_TEST_SWEEPS, parameters.iteration_limit + _TEST_SWEEPS, _TEST_SWEEPS):
            run.sweep(_TEST_SWEEPS)
            if not run.is_finite():
                raise _failure(model, run, start, done)
            now = run.moved()
            iterations[is_open], moves[is_open] = done, now[is_open]
            calm = now <= bounds[stage]
            is_last = done >= parameters.iteration_limit
            ready = is_open & ((calm & (stage == len(bounds) - 1)) | is_last)
            if ready.any():
                found = run.positions()
                # A pose is read when it comes to rest itself, whatever the others still do.
                result = np.where(ready.reshape(-1, *(1,) * (found.ndim - 1)), found, result)
                is_open &= ~ready
            if not is_open.any():
                break
            fresh = calm & (stage < len(bounds) - 1)
            stage += fresh
            if is_compliant:
                run.carry_on(fresh)
            else:
                run.mark()
        has_settled = bool((moves <= bounds[-1]).all() and (stage == len(bounds) - 1).all())
        return Settled(result, iterations, moves, has_settled)

    def _run(self, model: Model, state: State, control: Control, parameters: Parameters) -> Run:
        many = state.positions.ndim == 3
        is_packed = self.path == "simd" and not many
        form = "packed" if is_packed else "sequence"
        dtype = np.float64 if self.path == "scalar" else np.float32
        key = (
            form,
            parameters.stiffness_rule,
            parameters.iterations,
            parameters.substeps,
            parameters.dt,
            parameters.bend_step_limit,
            parameters.area_step_limit,
        )
        known = self._layouts.setdefault(model, {})
        if key not in known:
            known[key] = layout_of(model, parameters, form, dtype)
        if many:
            pose_count = len(state.positions)
            return LaneRun(
                model,
                control,
                parameters,
                known[key],
                pose_count=pose_count,
                threads=min(self.threads, max(pose_count // 16, 1)),
            )
        return SingleRun(model, control, parameters, known[key])

    def _require_fit(self, model: Model, state: State) -> None:
        shape = state.positions.shape
        if shape[-2] != model.particle_count or shape[0] == 0:
            raise ShapeError(
                f"state.positions: expected shape ({model.particle_count}, 3) or "
                f"(s, {model.particle_count}, 3) with s of 1 or more, got {shape}"
            )

    def _each_step(
        self, model: Model, state: State, control: Control, parameters: Parameters
    ) -> State:
        steps = [
            self.step(model, one, part, parameters=parameters)
            for one, part in _singles(model, state, control)
        ]
        return State(
            np.stack([one.positions for one in steps]),
            np.stack([one.velocities for one in steps]),
            state.positions,
        )

    def _each_settled(
        self, model: Model, state: State, control: Control, parameters: Parameters
    ) -> Settled:
        poses = [
            self.settle(model, one, part, parameters=parameters)
            for one, part in _singles(model, state, control)
        ]
        return Settled(
            np.stack([pose.positions for pose in poses]),
            np.concatenate([pose.iterations for pose in poses]),
            np.concatenate([pose.moves for pose in poses]),
            all(pose.has_settled for pose in poses),
        )


def _singles(model: Model, state: State, control: Control) -> list[tuple[State, Control]]:
    """Split several poses into single ones."""

    def of(pose: int, array: FloatArray | None, dimensions: int) -> FloatArray | None:
        return array[pose] if array is not None and array.ndim == dimensions else array

    pairs: list[tuple[State, Control]] = []
    for pose in range(len(state.positions)):
        contacts = control.contacts
        if contacts is not None and contacts.points.ndim == 3:
            contacts = replace(
                contacts, points=contacts.points[pose], normals=contacts.normals[pose]
            )
        part = Control(
            of(pose, control.targets, 3),
            of(pose, control.pinned, 3),
            of(pose, control.rest_volumes, 2),
            of(pose, control.acceleration, 3),
            contacts,
        )
        pairs.append((State(state.positions[pose], state.velocities[pose]), part))
    return pairs


def _failure(model: Model, run: Run, start: FloatArray, sweeps: int) -> SolverError:
    """Say when a run from `start` went wrong: repeat it sweep by sweep."""
    run.place(start)
    last, iteration = start, 0
    while iteration < sweeps:
        run.sweep(1)
        iteration += 1
        if not run.is_finite():
            break
        last = run.positions()
    with np.errstate(over="ignore", invalid="ignore"):
        worst = residuals(model, last if last.ndim == 2 else last[0])
    named = ", ".join(f"{kind} {residual.largest:.3g}" for kind, residual in worst.items())
    return SolverError(
        f"solver: a coordinate stopped being finite in iteration {iteration}; largest residuals "
        f"before it: {named}; lower the stiffness, or set bend_step_limit and area_step_limit"
    )


def warm_up() -> None:
    """Compile the float32 kernels, or load them from the cache; some ten seconds the first time.

    For programs that want to hide the wait: call it from a thread while something else goes on.
    """
    positions = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], float)
    faces = np.array([(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)], np.int32)
    model = Model(positions, surface_constraints(TriMesh(positions, faces)))
    Solver().settle(model, State.at_rest(model))
    Solver().settle(model, State.at_rest(model, pose_count=1))
