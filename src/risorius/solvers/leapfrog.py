"""Move a spring network: to rest for a bake, or by a number of steps for the live view."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from risorius._check import FloatArray, IntArray, as_number, one_of
from risorius.errors import ParameterError, SolverError
from risorius.solvers.kernels.simd import PACK
from risorius.solvers.kernels.spring_packs import leapfrog_packs
from risorius.solvers.kernels.springs import add_anchors, add_edges, leapfrog
from risorius.solvers.spring_layout import PackTables, SpringTables
from risorius.solvers.springs import SpringControl, SpringNetwork, SpringState

__all__ = [
    "LeapfrogParameters",
    "Moved",
    "PackedRun",
    "advance",
    "edge_forces",
    "forces_at",
    "scalar_tables",
    "settle",
]

Path = Literal["packed", "scalar"]
_PATHS = ("packed", "scalar")
_ORIGIN = np.zeros(3)


@dataclass(frozen=True, kw_only=True)
class LeapfrogParameters:
    """How a network is moved.

    Parameters
    ----------
    step_share : float
        Length of a step, as a share of the longest stable one.
    drag : float
        Share of the velocity lost per unit of time, as the rate of an exponential.
    kinetic : bool
        Kinetic damping: all velocities are reset when the energy of motion has peaked.
    tolerance : float
        `settle` ends when no force exceeds this share of its particle's mass [mm, where masses
        are sums of stiffness].
    step_limit : int
        `settle` ends after this many steps at the latest.

    Raises
    ------
    ParameterError
        If the step would not be stable or anything is out of range.
    """

    step_share: float = 0.5
    drag: float = 0.1
    kinetic: bool = True
    tolerance: float = 2e-4
    step_limit: int = 2000

    def __post_init__(self) -> None:
        as_number("drag", self.drag, low=0.0)
        as_number("tolerance", self.tolerance, low=0.0)
        share = as_number("step_share", self.step_share)
        if not 0.0 < share <= 1.0:
            raise ParameterError(
                f"step_share: {share:g} must be above 0 and at most 1, the stability limit; the "
                "motion explodes beyond it"
            )
        if self.step_limit < 1:
            raise ParameterError(f"step_limit: {self.step_limit} must be 1 or more")


@dataclass(frozen=True, eq=False)
class Moved:
    """Outcome of a run.

    Parameters
    ----------
    state : SpringState
    steps : int
        Steps taken.
    residual : float
        Largest force over mass at the last step.
    """

    state: SpringState
    steps: int
    residual: float


def settle(
    network: SpringNetwork,
    state: SpringState,
    control: SpringControl,
    *,
    parameters: LeapfrogParameters | None = None,
    path: Path = "packed",
) -> Moved:
    """Step until the network is at rest.

    Parameters
    ----------
    network : SpringNetwork
    state : SpringState
        Where to start; the result depends on it by less than the tolerance.
    control : SpringControl
    parameters : LeapfrogParameters, optional
    path : {"packed", "scalar"}
        Vectors of float32, or the float64 reference.

    Raises
    ------
    SolverError
        If the motion is no longer finite.
    """
    p = parameters or LeapfrogParameters()
    return _run(network, state, control, p, p.step_limit, path)


def advance(
    network: SpringNetwork,
    state: SpringState,
    control: SpringControl,
    *,
    steps: int,
    parameters: LeapfrogParameters | None = None,
    path: Path = "packed",
) -> Moved:
    """Take `steps` steps; fewer if the network comes to rest. Otherwise as `settle`."""
    return _run(network, state, control, parameters or LeapfrogParameters(), steps, path)


def edge_forces(
    network: SpringNetwork, positions: FloatArray, control: SpringControl | None = None
) -> FloatArray:
    """Return the forces (n, 3) of the edges alone at `positions` (n, 3) [mm], by the reference."""
    forces = np.zeros_like(positions)
    asked = control or SpringControl()
    if asked.anchors is None:
        asked = replace(asked, anchors=np.zeros((len(network.anchored), 3)))
    tables = scalar_tables(network, asked)
    add_edges(positions, tables, forces)
    return forces


def forces_at(network: SpringNetwork, positions: FloatArray, control: SpringControl) -> FloatArray:
    """Return all forces (n, 3) at `positions` (n, 3) [mm], by the reference."""
    forces = np.zeros_like(positions)
    tables = scalar_tables(network, control)
    add_edges(positions, tables, forces)
    add_anchors(positions, tables, forces)
    return forces


def _run(
    network: SpringNetwork,
    state: SpringState,
    control: SpringControl,
    parameters: LeapfrogParameters,
    limit: int,
    path: Path,
) -> Moved:
    if one_of("path", path, _PATHS) == "packed":
        run = PackedRun(network, state, control, parameters)
        steps = run.advance(limit)
        return Moved(SpringState(run.positions, run.velocities), steps, run.residual)
    p = parameters
    x, v = state.positions.copy(), state.velocities.copy()
    steps, residual = leapfrog(
        x, v, scalar_tables(network, control), np.zeros_like(x),
        p.step_share * network.stable_step, p.drag, p.kinetic, p.tolerance, limit,
    )  # fmt: skip
    _require_finite(x, float(residual), int(steps), p)
    return Moved(SpringState(x, v), int(steps), float(residual))


def scalar_tables(network: SpringNetwork, control: SpringControl) -> SpringTables:
    """Return what the reference kernel reads."""
    given = control.resolved(network)
    taut = _taut(given)
    return SpringTables(
        network.edges, given["rest_lengths"], given["knee_lengths"], network.stiffness,
        network.stiffening, network.anchored[taut], given["anchors"][taut],
        network.anchor_lengths[taut], given["anchor_stiffness"][taut], given["hold_targets"],
        given["hold_stiffness"], given["load"], network.inv_mass,
    )  # fmt: skip


class PackedRun:
    """A network in motion, kept as the packed kernel has it; for frame after frame.

    Parameters
    ----------
    network : SpringNetwork
    state : SpringState
        Where it starts.
    control : SpringControl
    parameters : LeapfrogParameters, optional
    """

    def __init__(
        self,
        network: SpringNetwork,
        state: SpringState,
        control: SpringControl,
        parameters: LeapfrogParameters | None = None,
    ) -> None:
        self._network, self._parameters = network, parameters or LeapfrogParameters()
        # Counted from the middle, float32 is as exact as it can be.
        self._centre = network.rest_positions.mean(axis=0) if network.particle_count else _ORIGIN
        self._fixed = state.positions[network.fixed]
        layout = network.layout
        self._x = layout.vectors(state.positions - self._centre)
        self._v = layout.vectors(state.velocities)
        self._rows = layout.rows(self._x, self._fixed - self._centre)
        self._forces = np.zeros_like(self._x)
        self._peak = np.zeros(PACK, np.float32)
        self._tables = self._tables_of(control)
        self.residual = 0.0
        """Largest force over mass at the last step."""

    def ask(self, control: SpringControl) -> None:
        """Change what is asked of the network."""
        self._tables = self._tables_of(control)

    def shift(self, motion: FloatArray) -> None:
        """Move the particles by `motion` (n, 3) [mm]; fixed ones stay."""
        layout = self._network.layout
        self._x += layout.vectors(motion)
        self._rows = layout.rows(self._x, self._fixed - self._centre)

    def advance(self, steps: int) -> int:
        """Take `steps` steps, fewer if the network comes to rest; return how many.

        Raises
        ------
        SolverError
            If the motion is no longer finite.
        """
        p = self._parameters
        taken, residual = leapfrog_packs(
            self._rows, self._x, self._v, self._tables, self._forces, self._peak,
            p.step_share * self._network.stable_step, p.drag, p.kinetic, p.tolerance, steps,
        )  # fmt: skip
        self.residual = float(residual)
        _require_finite(self._x, float(residual), int(taken), p)
        return int(taken)

    @property
    def positions(self) -> FloatArray:
        """Where the particles are (n, 3) [mm]."""
        result = self._network.layout.vectors_back(self._x) + self._centre
        result[self._network.fixed] = self._fixed
        return result

    @property
    def velocities(self) -> FloatArray:
        """How fast they are (n, 3) [mm per unit of time]."""
        return self._network.layout.vectors_back(self._v)

    def _tables_of(self, control: SpringControl) -> PackTables:
        network, layout = self._network, self._network.layout
        given = control.resolved(network)
        taut = _taut(given)
        k = given["anchor_stiffness"][taut]
        anchor_start, anchor_rows = layout.anchor_fields(
            network.anchored[taut], *(given["anchors"][taut] - self._centre).T, k,
            k * network.anchor_lengths[taut],
        )  # fmt: skip
        edge = [network.stiffness, network.stiffness * given["rest_lengths"]]
        if network.stiffening > 0.0:
            edge.append(given["knee_lengths"])
        return PackTables(
            layout.edge_start, layout.neighbours, layout.edge_fields(*edge),
            np.array([network.stiffening], np.float32), anchor_start, anchor_rows,
            layout.vectors(given["hold_targets"] - self._centre),
            layout.scalars(given["hold_stiffness"]), layout.vectors(given["load"]),
            layout.scalars(network.inv_mass), layout.own_rows(),
        )  # fmt: skip


def _taut(given: dict[str, FloatArray]) -> IntArray:
    """Return which anchor springs (t,) pull at all."""
    return np.flatnonzero(given["anchor_stiffness"] > 0.0).astype(np.int32)


def _require_finite(
    places: npt.NDArray[Any], residual: float, steps: int, parameters: LeapfrogParameters
) -> None:
    if not (np.isfinite(places).all() and np.isfinite(residual)):
        raise SolverError(
            f"springs: not finite after {steps} steps; take a smaller step_share than "
            f"{parameters.step_share:g}"
        )
