"""Springs: what they exert, where they come to rest, how long a step may be."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from risorius._check import FloatArray
from risorius.errors import MeshError, ParameterError, ShapeError, SolverError
from risorius.mesh.connectivity import edges
from risorius.solvers.kernels.springs import leapfrog
from risorius.solvers.leapfrog import (
    LeapfrogParameters,
    advance,
    edge_forces,
    forces_at,
    scalar_tables,
    settle,
)
from risorius.solvers.spring_energy import energy_at
from risorius.solvers.spring_stiffness import edge_stiffness
from risorius.solvers.springs import SpringControl, SpringNetwork, SpringState
from tests.mesh.shapes import grid, sphere

NOTHING = np.zeros(0)
PATHS = ("packed", "scalar")
TIGHT = LeapfrogParameters(tolerance=2e-5, step_limit=20000)


def _net(seed: int = 3, *, levels: int = 2, stiffening: float = 3.0) -> SpringNetwork:
    """Return a ball with a spring of every kind and unequal masses."""
    generator = np.random.default_rng(seed)
    mesh = sphere(levels, 20.0)
    points, pairs = mesh.positions, edges(mesh.faces)
    n = len(points)
    length = np.linalg.norm(points[pairs[:, 0]] - points[pairs[:, 1]], axis=1)
    anchored = np.repeat(generator.permutation(n)[: n // 2], 2).astype(np.int32)
    return SpringNetwork(
        points, pairs, 0.6 * length, generator.uniform(0.5, 2.0, len(pairs)),
        knee_lengths=1.05 * length, stiffening=stiffening, anchored=anchored,
        anchor_lengths=generator.uniform(0.0, 3.0, len(anchored)),
        anchor_stiffness=generator.uniform(0.1, 0.5, len(anchored)),
        hold_stiffness=generator.uniform(0.0, 0.1, n), load=generator.normal(size=(n, 3)),
        fixed=points[:, 1] < -15.0, mass=generator.uniform(1.0, 9.0, n),
    )  # fmt: skip


def _control(network: SpringNetwork, seed: int = 4) -> SpringControl:
    generator = np.random.default_rng(seed)
    near = network.rest_positions[network.anchored]
    return SpringControl(anchors=near + generator.normal(scale=4.0, size=near.shape))


def _pair(stiffening: float = 0.0, **changes: object) -> SpringNetwork:
    points = np.array([(0.0, 0.0, 0.0), (10.0, 0.0, 0.0)])
    network = SpringNetwork(
        points, np.array([(0, 1)], np.int32), np.array([10.0]), np.array([2.0]),
        knee_lengths=np.array([12.0]), stiffening=stiffening,
    )  # fmt: skip
    return replace(network, **changes)


@pytest.mark.parametrize("kind", ["edge", "anchor", "hold", "load", "all"])
def test_forces_are_the_negative_gradient_of_the_energy(kind: str) -> None:
    network = _net(levels=1)
    none = {"edge": "stiffness", "anchor": "anchor_stiffness", "hold": "hold_stiffness"}
    for other, name in none.items():
        if kind not in (other, "all"):
            network = replace(network, **{name: np.zeros_like(getattr(network, name))})
    if kind not in ("load", "all"):
        network = replace(network, load=NOTHING)
    control = _control(network)
    points = network.rest_positions + np.random.default_rng(1).normal(size=(42, 3))
    found, step = forces_at(network, points, control), 1e-4
    assert np.abs(found).max() > 0.01
    for entry in np.random.default_rng(2).permutation(found.size)[:40]:
        shift = np.zeros(found.size)
        shift[entry] = step
        high = energy_at(network, points + shift.reshape(-1, 3), control)
        low = energy_at(network, points - shift.reshape(-1, 3), control)
        assert -(high - low) / (2.0 * step) == pytest.approx(found.ravel()[entry], abs=2e-4)


@pytest.mark.parametrize(("length", "force"), [(9.0, -2.0), (11.0, 2.0), (12.0, 4.0), (13.0, 12.0)])
def test_a_biphasic_edge_pulls_as_calculated_by_hand(length: float, force: float) -> None:
    # k = 2, beta = 4, L0 = 10, L1 = 12: beyond, 2 * 2 + 4 * 2 * (L - 12).
    network = _pair(stiffening=3.0)
    forces = edge_forces(network, np.array([(0.0, 0.0, 0.0), (length, 0.0, 0.0)]))
    assert np.allclose(forces, [[force, 0.0, 0.0], [-force, 0.0, 0.0]], rtol=1e-12)


@pytest.mark.parametrize("path", PATHS)
def test_unequal_masses_move_as_calculated_by_hand(path: str) -> None:
    network = _pair(mass=np.array([1.0, 4.0]))
    start = SpringState.still(np.array([(0.0, 0.0, 0.0), (11.0, 0.0, 0.0)]))
    dt = 0.5 * network.stable_step
    free = LeapfrogParameters(drag=0.0, kinetic=False)
    moved = advance(network, start, SpringControl(), steps=1, parameters=free, path=path).state
    assert network.stable_step == pytest.approx(1.0)
    assert np.allclose(moved.velocities[:, 0], [2.0 * dt, -0.5 * dt], rtol=1e-5)
    assert np.allclose(moved.positions[:, 0], [2.0 * dt**2, 11.0 - 0.5 * dt**2], rtol=1e-6)


@pytest.mark.parametrize("path", PATHS)
def test_a_particle_between_two_anchors_comes_to_rest_where_their_pulls_cancel(path: str) -> None:
    network = SpringNetwork(
        np.zeros((1, 3)), np.zeros((0, 2), np.int32), np.zeros(0), np.zeros(0),
        anchored=np.zeros(2, np.int32), anchor_lengths=np.array([1.0, 2.0]),
        anchor_stiffness=np.array([3.0, 1.0]),
    )  # fmt: skip
    control = SpringControl(anchors=np.array([(-10.0, 0.0, 0.0), (10.0, 0.0, 0.0)]))
    found = settle(
        network, SpringState.still(np.zeros((1, 3))), control, parameters=TIGHT, path=path
    )
    # 3 (10 + x - 1) = 10 - x - 2
    assert found.state.positions[0] == pytest.approx([-19.0 / 4.0, 0.0, 0.0], abs=1e-4)
    assert found.residual <= TIGHT.tolerance


@pytest.mark.parametrize("path", PATHS)
def test_rest_is_a_fixed_point_when_the_load_balances_it(path: str) -> None:
    network = replace(_net(), load=NOTHING)
    control = SpringControl(anchors=network.rest_positions[network.anchored] + [0.0, 0.0, 1.0])
    load = -forces_at(network, network.rest_positions, control)
    network = replace(network, load=load)
    start = SpringState.still(network.rest_positions)
    found = advance(
        network, start, control, steps=500, parameters=LeapfrogParameters(tolerance=0.0), path=path
    )
    away = np.abs(found.state.positions - network.rest_positions).max()
    assert away < (1e-3 if path == "packed" else 1e-9)


def test_both_paths_take_the_same_steps_to_the_same_rest() -> None:
    network = _net(levels=3)
    control = _control(network)
    start = SpringState.still(network.rest_positions)
    fast, exact = (settle(network, start, control, path=path) for path in PATHS)
    motion = np.abs(exact.state.positions - network.rest_positions).max()
    assert motion > 1.0
    assert np.abs(fast.state.positions - exact.state.positions).max() < 1e-4 * motion
    assert abs(fast.steps - exact.steps) <= 2
    assert fast.state.velocities == pytest.approx(exact.state.velocities, abs=1e-3 * motion)


def test_a_settled_network_has_no_force_left() -> None:
    network = _net()
    control = _control(network)
    start = SpringState.still(network.rest_positions)
    found = settle(network, start, control, parameters=TIGHT)
    left = forces_at(network, found.state.positions, control) * network.inv_mass[:, None]
    assert np.linalg.norm(left, axis=1).max() < 3.0 * TIGHT.tolerance


@given(st.integers(0, 1000))
def test_springs_between_particles_keep_momentum(seed: int) -> None:
    network = _net(seed, levels=1)
    points = network.rest_positions + np.random.default_rng(seed).normal(size=(42, 3))
    forces = edge_forces(network, points)
    assert np.abs(forces.sum(axis=0)).max() < 1e-9 * np.abs(forces).sum()
    turning = np.cross(points, forces).sum(axis=0)
    assert np.abs(turning).max() < 1e-9 * np.abs(np.cross(points, forces)).sum()


@pytest.mark.parametrize("path", PATHS)
def test_turning_and_shifting_everything_turns_and_shifts_the_result(path: str) -> None:
    network = _net()
    control = _control(network)
    angle = 0.7
    c, s = np.cos(angle), np.sin(angle)
    turn = np.array([(c, -s, 0.0), (s, c, 0.0), (0.0, 0.0, 1.0)])

    def carried(points: FloatArray) -> FloatArray:
        return points @ turn.T + [5.0, -3.0, 11.0]

    other = replace(
        network, rest_positions=carried(network.rest_positions), load=network.load @ turn.T
    )
    moved = SpringControl(anchors=carried(control.anchors))
    found = settle(network, SpringState.still(network.rest_positions), control,
                   parameters=TIGHT, path=path)  # fmt: skip
    again = settle(other, SpringState.still(other.rest_positions), moved,
                   parameters=TIGHT, path=path)  # fmt: skip
    # Tolerance and rounding end the two runs at slightly different steps.
    assert np.abs(carried(found.state.positions) - again.state.positions).max() < 3e-3


@pytest.mark.parametrize("path", PATHS)
def test_fixed_particles_stay_to_the_last_bit(path: str) -> None:
    network = _net()
    start = network.rest_positions + 1.0 / 3.0
    found = advance(network, SpringState.still(start), _control(network), steps=40, path=path)
    still = network.fixed
    assert still.any()
    assert (found.state.positions[still] == start[still]).all()
    assert (found.state.positions[~still] != start[~still]).any(axis=1).all()


@pytest.mark.parametrize("path", PATHS)
def test_the_same_input_gives_the_same_bytes(path: str) -> None:
    network = _net()
    start = SpringState.still(network.rest_positions)
    runs = [settle(network, start, _control(network), path=path).state for _ in range(2)]
    assert runs[0].positions.tobytes() == runs[1].positions.tobytes()


def test_a_leapfrog_below_the_limit_keeps_its_energy_bounded_and_one_above_does_not() -> None:
    # Acceptance 12: dt = 1.9 / omega over 2000 steps without damping; the limit is sharp.
    network = _pair()
    omega = np.sqrt(2.0 * (1.0 / network.mass).sum())
    start = np.array([(0.0, 0.0, 0.0), (11.0, 0.0, 0.0)])
    reach = {}
    for share in (1.9, 2.1):
        x, v = start.copy(), np.zeros((2, 3))
        tables = scalar_tables(network, SpringControl())
        leapfrog(x, v, tables, np.zeros_like(x), share / omega, 0.0, False, 0.0, 2000)
        reach[share] = abs(x[1, 0] - x[0, 0] - 10.0)
    assert reach[1.9] < 10.0
    assert not reach[2.1] < 1e6


def test_the_stable_step_counts_biphasic_edges_with_their_stiffer_half() -> None:
    soft, stiff = _pair(mass=np.ones(2)), _pair(stiffening=3.0, mass=np.ones(2))
    assert soft.stable_step / stiff.stable_step == pytest.approx(2.0)
    start = np.array([(0.0, 0.0, 0.0), (16.0, 0.0, 0.0)])
    reach = {}
    for name, step in (("stiff", stiff.stable_step), ("soft", soft.stable_step)):
        x, v = start.copy(), np.zeros((2, 3))
        tables = scalar_tables(stiff, SpringControl())
        leapfrog(x, v, tables, np.zeros_like(x), 0.6 * step, 0.0, False, 0.0, 2000)
        reach[name] = abs(x[1, 0] - x[0, 0] - 10.0)
    assert reach["stiff"] < 20.0
    assert not reach["soft"] < 1e4


def test_masses_of_summed_stiffness_make_one_step_for_all_meshes() -> None:
    steps = [replace(_net(levels=level), mass=NOTHING).stable_step for level in (1, 2, 3)]
    assert steps == pytest.approx([2.0**0.5] * 3)


def test_kinetic_damping_settles_in_fewer_steps_than_drag() -> None:
    network = replace(_net(stiffening=0.0), mass=NOTHING)
    start, control = SpringState.still(network.rest_positions), _control(network)
    steps = {
        kinetic: settle(
            network, start, control, parameters=LeapfrogParameters(kinetic=kinetic, drag=0.05)
        ).steps
        for kinetic in (True, False)
    }
    assert steps[True] < 0.8 * steps[False]


def test_a_uniform_stretch_costs_the_same_on_three_triangulations() -> None:
    # Acceptance 11: below 5 percent with Van Gelder's stiffness, far more with a constant one.
    energies: dict[str, list[float]] = {"van gelder": [], "constant": []}
    for columns in (4, 8, 16):
        mesh = grid(columns, columns, 10.0, 10.0)
        pairs = edges(mesh.faces)
        points = mesh.positions
        length = np.linalg.norm(points[pairs[:, 0]] - points[pairs[:, 1]], axis=1)
        stretched = points * [1.1, 1.1, 1.0]
        for name, k in (
            ("van gelder", edge_stiffness(mesh, pairs)), ("constant", np.ones(len(pairs)))
        ):  # fmt: skip
            network = SpringNetwork(points, pairs, length, k)
            energies[name].append(energy_at(network, stretched, SpringControl()))
    assert np.ptp(energies["van gelder"]) < 1e-9 * energies["van gelder"][0]
    assert np.ptp(energies["constant"]) > 0.05 * energies["constant"][0]


def test_floors_keep_slivers_from_deciding_the_step() -> None:
    mesh = grid(4, 4, 10.0, 10.0)
    points = mesh.positions.copy()
    points[12] = points[11] + [1e-3, 0.0, 0.0]
    pairs = edges(mesh.faces)
    plain = edge_stiffness(mesh.at(points), pairs)
    floored = edge_stiffness(mesh.at(points), pairs, least_length=0.3, least=0.1)
    assert plain.max() > 1e3 * np.median(plain)
    assert floored.max() < 20.0 * np.median(floored)
    assert floored.min() > 0.09 * np.median(floored)
    assert floored.sum() < 0.1 * plain.sum()


@pytest.mark.parametrize(
    ("changes", "error", "message"),
    [
        ({"edges": np.array([(0, 7)], np.int32)}, MeshError, "edges: names particle 7"),
        ({"stiffness": np.array([-1.0])}, ParameterError, "stiffness: every entry"),
        ({"rest_lengths": np.array([np.nan])}, ParameterError, "rest_lengths: every entry"),
        ({"stiffness": np.ones(3)}, ShapeError, "stiffness: expected shape"),
        ({"mass": np.array([1.0, 0.0])}, ParameterError, "mass: every entry"),
        ({"mass": np.ones(3)}, ShapeError, "mass: expected shape"),
        ({"load": np.zeros((3, 3))}, ShapeError, "load: expected shape"),
        ({"fixed": np.zeros(3, bool)}, ShapeError, "fixed: expected shape"),
        ({"stiffening": -1.0}, ParameterError, "stiffening"),
    ],
)
def test_a_network_that_cannot_be_is_refused(
    changes: dict[str, object], error: type[Exception], message: str
) -> None:
    with pytest.raises(error, match=message):
        _pair(**changes)


def test_controls_that_do_not_fit_are_refused() -> None:
    network = _net(levels=1)
    start = SpringState.still(network.rest_positions)
    with pytest.raises(ShapeError, match=r"control\.anchors: missing"):
        settle(network, start, SpringControl())
    with pytest.raises(ShapeError, match=r"control\.load: expected shape"):
        settle(network, start, replace(_control(network), load=np.zeros((1, 3))))
    with pytest.raises(ShapeError, match=r"control\.load: every entry must be finite"):
        settle(network, start, replace(_control(network), load=np.full((42, 3), np.nan)))
    with pytest.raises(ParameterError, match="stable step"):
        stiff = 2.0 * network.anchor_stiffness
        settle(network, start, replace(_control(network), anchor_stiffness=stiff))
    with pytest.raises(ParameterError, match="path"):
        settle(network, start, _control(network), path="gpu")


@pytest.mark.parametrize("share", [0.0, 1.2, np.nan])
def test_a_step_beyond_the_limit_is_refused(share: float) -> None:
    with pytest.raises(ParameterError, match="step_share"):
        LeapfrogParameters(step_share=share)


@pytest.mark.parametrize("path", PATHS)
def test_an_explosion_is_an_error_and_not_a_result(path: str) -> None:
    network = _net(levels=1)
    start = SpringState(network.rest_positions, np.full((42, 3), np.inf))
    with pytest.raises(SolverError, match="not finite"):
        settle(network, start, _control(network), path=path)


def test_edges_without_length_and_without_knee_stay_finite() -> None:
    points = np.array([(0.0, 0.0, 0.0), (0.0, 0.0, 0.0), (5.0, 0.0, 0.0)])
    network = SpringNetwork(
        points, np.array([(0, 1), (1, 2)], np.int32), np.array([0.0, 4.0]), np.ones(2),
        stiffening=3.0, knee_lengths=np.array([np.inf, 4.5]),
    )  # fmt: skip
    start = SpringState.still(points)
    for path in PATHS:
        found = settle(network, start, SpringControl(), parameters=TIGHT, path=path).state.positions
        assert np.linalg.norm(found[2] - found[1]) == pytest.approx(4.0, abs=1e-3)
        assert np.linalg.norm(found[1] - found[0]) < 1e-3


def test_a_network_that_is_fixed_as_a_whole_rests() -> None:
    network = replace(_net(levels=1), fixed=np.ones(42, bool))
    start = SpringState.still(network.rest_positions)
    for path in PATHS:
        found = settle(network, start, _control(network), path=path)
        assert (found.state.positions == network.rest_positions).all()
        assert found.steps == 0
