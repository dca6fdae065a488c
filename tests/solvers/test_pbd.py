"""Steps through time and poses at rest."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from risorius._check import FloatArray
from risorius.errors import MeshError, ParameterError, RisoriusWarning, ShapeError, SolverError
from risorius.mesh.core import TriMesh
from risorius.solvers.constraints import Bends, Constraints, Contacts, Distances, Holds
from risorius.solvers.model import Control, Model, State
from risorius.solvers.parameters import PROFILES, Parameters
from risorius.solvers.pbd import Path, Settled, Solver, warm_up
from risorius.solvers.residuals import residuals
from risorius.solvers.surface import SurfaceStiffness, surface_constraints
from tests.mesh.shapes import sphere
from tests.solvers.particles import dodecahedron, pairs_of, pulled, skin

PATHS: tuple[Path, ...] = ("scalar", "simd")
IMPROVED = PROFILES["improved"]


def _spring(stiffness: float = 0.5) -> Model:
    """Return a particle between a pinned one and a target."""
    table = Distances(pairs_of((0, 1)), [1.0], stiffness)
    constraints = Constraints(table, holds=Holds([1], 0.3))
    return Model([(0, 0, 0), (1, 0, 0)], constraints, inv_mass=[0.0, 1.0])


def test_without_constraints_a_particle_flies_on_and_loses_its_share_of_speed() -> None:
    model = Model(np.zeros((1, 3)), Constraints())
    state = State(np.zeros((1, 3)), np.array([(10.0, 0, 0)]))
    parameters = Parameters(dt=0.1)
    after = Solver(path="scalar").step(model, state, parameters=parameters)
    np.testing.assert_allclose(after.positions, [(0.8, 0, 0)], rtol=1e-14)
    np.testing.assert_allclose(after.velocities, [(8.0, 0, 0)], rtol=1e-14)
    np.testing.assert_array_equal(after.previous, state.positions)


def test_substeps_lose_the_same_share_of_speed_together() -> None:
    model = Model(np.zeros((1, 3)), Constraints())
    state = State(np.zeros((1, 3)), np.array([(10.0, 0, 0)]))
    after = Solver(path="scalar").step(model, state, parameters=Parameters(dt=0.1, substeps=5))
    np.testing.assert_allclose(after.velocities, [(8.0, 0, 0)], rtol=1e-12)


def test_acceleration_drives_all_but_pinned_particles() -> None:
    model = Model(np.zeros((2, 3)), Constraints(), inv_mass=[0.0, 2.0])
    control = Control(acceleration=np.array([0.0, -10.0, 0.0]))
    parameters = Parameters(dt=0.1, damping=0.0)
    after = Solver(path="scalar").step(model, State.at_rest(model), control, parameters=parameters)
    np.testing.assert_allclose(after.positions, [(0, 0, 0), (0, -0.1, 0)], rtol=1e-14)


@pytest.mark.parametrize("path", PATHS)
def test_published_stiffness_settles_where_its_order_says(path: Path) -> None:
    # A sweep maps x to a = x + .3 (2 - x), then to a + .5 (1 - a): rest is 1.3 / 1.3 of ... below.
    control = Control(targets=np.array([(2.0, 0, 0)]))
    parameters = Parameters(tolerance=1e-9, iteration_limit=400)
    model = _spring()
    found = Solver(path=path).settle(model, State.at_rest(model), control, parameters=parameters)
    # x = .5 (x + .3 (2 - x)) + .5  =>  x (1 - .35) = .8
    assert found.positions[1, 0] == pytest.approx(0.8 / 0.65, rel=1e-6)


@pytest.mark.parametrize("path", PATHS)
def test_compliance_settles_where_forces_balance_whatever_the_way_there(path: Path) -> None:
    # Springs of stiffness k / (1 - k): 1 towards 1 and 3 / 7 towards 2.
    control = Control(targets=np.array([(2.0, 0, 0)]))
    wanted = (1.0 + 2.0 * 3.0 / 7.0) / (1.0 + 3.0 / 7.0)
    model = _spring()
    for parameters in (
        IMPROVED,
        replace(IMPROVED, dt=0.05),
        replace(IMPROVED, sweeps="forward", iterations=1, substeps=1),
    ):
        exact = replace(parameters, tolerance=1e-8, iteration_limit=2000)
        found = Solver(path=path).settle(model, State.at_rest(model), control, parameters=exact)
        assert found.has_settled
        assert found.positions[1, 0] == pytest.approx(wanted, rel=1e-5)


def test_compliance_of_a_whole_skin_does_not_depend_on_order_or_step() -> None:
    model = skin(sphere(2, 80.0))
    _, targets = pulled(model, 8, 0.02)
    control, state = Control(targets=targets), State.at_rest(model)

    def rest(parameters: Parameters, of: Model = model) -> FloatArray:
        exact = replace(parameters, tolerance=1e-7, iteration_limit=4000)
        found = Solver(path="scalar").settle(of, state, control, parameters=exact)
        assert found.has_settled
        return found.positions

    soft = rest(IMPROVED)
    motion = np.abs(soft - model.rest_positions).max()
    for other in (replace(IMPROVED, sweeps="forward"), replace(IMPROVED, dt=0.025)):
        assert np.abs(rest(other) - soft).max() < 0.015 * motion
    # The same constraints in another order: turned about, the walk over the net starts elsewhere.
    turned = _reversed(model)
    assert np.abs(rest(IMPROVED, turned) - soft).max() < 0.01 * motion
    published = rest(Parameters())
    assert np.abs(rest(Parameters(), turned) - published).max() > 0.02 * motion


def _reversed(model: Model) -> Model:
    """Return the same model with a mirror that pairs nothing, hence another order."""
    shuffled = np.random.default_rng(0).permutation(len(model.constraints.distances.particles))
    c = model.constraints
    table = Distances(
        c.distances.particles[shuffled][:, ::-1],
        c.distances.rest[shuffled],
        c.distances.stiffness[shuffled],
    )
    result = Model(
        model.rest_positions,
        Constraints(table, c.areas, c.bends, c.volumes, c.holds),
        inv_mass=model.weights,
    )
    order = result.order
    backwards = replace(order, distances=order.distances[::-1], bends=order.bends[::-1])
    vars(result)["order"] = backwards
    return result


def test_stiffness_by_step_does_not_grow_with_the_iterations() -> None:
    table = Distances(pairs_of((0, 1)), [1.0], 0.2)
    model = Model([(0, 0, 0), (1, 0, 0)], Constraints(table))
    state = State(np.array([(0, 0, 0), (2, 0, 0)], float), np.zeros((2, 3)))
    left = {
        (rule, count): _length(
            Solver(path="scalar").step(
                model,
                state,
                parameters=Parameters(stiffness_rule=rule, iterations=count),
            )
        )
        - 1.0
        for rule in ("each_iteration", "each_step")
        for count in (1, 5)
    }
    assert left["each_iteration", 1] == pytest.approx(0.8)
    assert left["each_iteration", 5] == pytest.approx(0.8**5)
    assert left["each_step", 1] == pytest.approx(0.8)
    assert left["each_step", 5] == pytest.approx(0.8)


def _length(state: State) -> float:
    return float(np.linalg.norm(state.positions[1] - state.positions[0]))


@pytest.mark.parametrize("path", PATHS)
@pytest.mark.parametrize("profile", sorted(PROFILES))
def test_a_pose_depends_neither_on_its_neighbours_nor_on_its_past(path: Path, profile: str) -> None:
    model = skin(sphere(2, 80.0))
    poses = [pulled(model, seed, share)[1] for seed, share in ((1, 0.02), (2, 0.1), (3, 0.0))]
    parameters = replace(PROFILES[profile], tolerance=1e-6, iteration_limit=3000)
    solver = Solver(path=path)
    together = solver.settle(
        model,
        State.at_rest(model, pose_count=3),
        Control(targets=np.stack(poses)),
        parameters=parameters,
    )
    assert together.has_settled
    assert len(np.unique(together.iterations)) == 3
    for number, targets in enumerate(poses):
        alone = Solver(path=path).settle(
            model,
            State.at_rest(model, pose_count=1),
            Control(targets=targets),
            parameters=parameters,
        )
        assert alone.positions[0].tobytes() == together.positions[number].tobytes()
        assert alone.iterations[0] == together.iterations[number]
    start = State(together.positions[1], np.zeros_like(model.rest_positions))
    later = solver.settle(model, start, Control(targets=poses[0]), parameters=parameters)
    assert np.abs(later.positions - together.positions[0]).max() < 3e-4 * model.size
    np.testing.assert_allclose(together.positions[2], model.rest_positions, atol=1e-3)


def test_a_step_forgets_nothing_and_keeps_nothing_back() -> None:
    model = skin(sphere(1, 80.0))
    positions, targets = pulled(model, 5)
    state, control = State(positions, np.zeros_like(positions)), Control(targets=targets)
    used = Solver()
    used.step(model, State.at_rest(model), control)
    used.settle(model, state, control, parameters=IMPROVED)
    first, second = used.step(model, state, control), Solver().step(model, state, control)
    assert first.positions.tobytes() == second.positions.tobytes()


def test_settling_too_slowly_is_reported_not_hidden() -> None:
    model = skin(sphere(2, 80.0))
    _, targets = pulled(model, 1)
    found = Solver().settle(
        model,
        State.at_rest(model),
        Control(targets=targets),
        parameters=Parameters(tolerance=0.0, iteration_limit=7),
    )
    assert isinstance(found, Settled)
    assert not found.has_settled
    assert found.iterations.tolist() == [8]
    assert found.moves[0] > 0.0


@pytest.mark.parametrize("profile", sorted(PROFILES))
def test_a_symmetric_pull_gives_a_symmetric_result(profile: str) -> None:
    mesh = sphere(2, 80.0)
    key = {tuple(np.round(point, 6) + 0.0): i for i, point in enumerate(mesh.positions)}
    mirror = np.array(
        [key[tuple(np.round(point * (-1, 1, 1), 6) + 0.0)] for point in mesh.positions], np.int32
    )
    held = np.flatnonzero(mesh.positions[:, 1] > 0.0)
    found = surface_constraints(mesh, SurfaceStiffness(0.15, 0.3, 0.4, 1.0))
    constraints = Constraints(
        found.distances, found.areas, found.bends, found.volumes, Holds(held, 0.2)
    )
    model = Model(mesh.positions, constraints, mirror=mirror)
    rest = mesh.positions[held]
    pull = np.stack([0.1 * rest[:, 0], 0.05 * rest[:, 2] + 3.0, np.abs(rest[:, 0]) * 0.1], axis=1)
    parameters = replace(PROFILES[profile], sweeps="alternating", tolerance=1e-6)
    result = Solver().settle(
        model, State.at_rest(model), Control(targets=rest + pull), parameters=parameters
    )
    moved = result.positions - mesh.positions
    difference = moved[mirror] * (-1, 1, 1) - moved
    # Published stiffness keeps a trace of the order next to the midline.
    share = {"improved": 0.003, "faithful": 0.02}[profile]
    assert np.abs(difference).max() < share * np.linalg.norm(moved, axis=1).max()


# Acceptance test 3 (Figs. 3.7-3.8).
@pytest.mark.parametrize("profile", sorted(PROFILES))
@pytest.mark.parametrize("build", [dodecahedron, lambda: sphere(3, 60.0)])
def test_a_surface_inflates_to_three_times_its_volume(
    profile: str, build: Callable[[], TriMesh]
) -> None:
    mesh = build()
    model = Model(mesh.positions, surface_constraints(mesh, SurfaceStiffness(0.05, 0.1, 0.0, 1.0)))
    volume = model.constraints.volumes[0]
    state = State.at_rest(model)
    solver, parameters = Solver(path="scalar"), replace(PROFILES[profile], iterations=10)
    for factor in np.linspace(1.0, 3.0, 9)[1:]:
        wanted = np.array([factor * volume.rest])
        for _ in range(10):
            state = solver.step(model, state, Control(rest_volumes=wanted), parameters=parameters)
        error = residuals(model, state.positions, Control(rest_volumes=wanted))["volumes"]
        assert error.largest < 0.01
        corners = state.positions[mesh.faces]
        outwards = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        centres = corners.mean(axis=1) - state.positions.mean(axis=0)
        assert (np.einsum("ij,ij->i", outwards, centres) > 0.0).all()
    assert mesh.face_count in (60, 1280)


def test_what_stops_being_finite_is_an_error_with_iteration_and_residual() -> None:
    # Stiff bending of edges without width and no limit to a step.
    points = np.array([(0, 0, 0), (1, 0, 0), (0.5, 1, 0), (0.5, -1, 0)], float)
    model = Model(points, Constraints(bends=Bends(pairs_of((0, 1, 2, 3)), [0.0], 1.0)))
    far = points * 1e160
    wild = Parameters(bend_step_limit=None)
    with pytest.raises(SolverError, match=r"in iteration 1; largest residuals before it: holds"):
        Solver(path="scalar").step(model, State(far, np.zeros((4, 3))), parameters=wild)
    with pytest.raises(SolverError, match="stopped being finite in iteration"):
        Solver().settle(model, State(points * 1e35, np.zeros((4, 3))), parameters=wild)


_MODEL = _spring()
_STATE = State.at_rest(_MODEL)
_REFUSED = [
    (lambda: Solver(path="gpu"), ParameterError, "path: 'gpu' is not one of"),
    (lambda: Solver(threads=0), ParameterError, "threads: 0 must be 1 or more"),
    (
        lambda: Solver().step(_MODEL, State(np.zeros((3, 3)), np.zeros((3, 3)))),
        ShapeError,
        r"state.positions: expected shape \(2, 3\)",
    ),
    (
        lambda: Solver().step(_MODEL, _STATE, Control(targets=np.zeros((2, 3)))),
        ShapeError,
        r"control.targets: expected shape \(1, 3\), got \(2, 3\)",
    ),
    (
        lambda: Solver().step(_MODEL, _STATE, Control(pinned=np.full((1, 3), np.nan))),
        ShapeError,
        "control.pinned: every entry must be finite",
    ),
    (
        lambda: Solver().step(
            _MODEL,
            State.at_rest(_MODEL, pose_count=2),
            Control(contacts=Contacts([0], np.zeros((3, 1, 3)), np.zeros((3, 1, 3)))),
        ),
        ShapeError,
        "control.contacts: expected points of shape",
    ),
    (lambda: State(np.zeros((3, 3)), np.zeros((2, 3))), ShapeError, "velocities: expected"),
    (lambda: State(np.zeros(3), np.zeros(3)), ShapeError, "positions: expected shape"),
    (lambda: Model(np.zeros((2, 3)), Constraints(), inv_mass=[1.0]), ShapeError, "inv_mass"),
    (lambda: Model(np.zeros((1, 3)), Constraints(), inv_mass=[-1]), ParameterError, "inv_mass"),
    (
        lambda: Model(np.zeros((2, 3)), Constraints(Distances(pairs_of((0, 2)), [1.0], 1.0))),
        MeshError,
        r"constraints.distances: names particle 2 .* only 0..1",
    ),
    (lambda: Parameters(dt=0.0), ParameterError, "dt: 0 is below"),
    (lambda: Parameters(damping=1.5), ParameterError, "damping: 1.5 is above 1"),
    (lambda: Parameters(iterations=0), ParameterError, "iterations: 0 must be a whole number"),
    (lambda: Parameters(bend_step_limit=0.0), ParameterError, "bend_step_limit: 0 must be above"),
    (lambda: Parameters(stiffness_rule="hard"), ParameterError, "stiffness_rule: 'hard'"),
    (lambda: Parameters.of_profile("best"), ParameterError, "profile: 'best' is not one of"),
]


@pytest.mark.parametrize(("build", "error", "message"), _REFUSED)
def test_refusal_says_what_is_wrong(
    build: Callable[[], object], error: type[Exception], message: str
) -> None:
    with pytest.raises(error, match=message):
        build()


def test_profiles_differ_in_explicit_fields_only() -> None:
    faithful, improved = Parameters.of_profile("faithful"), Parameters.of_profile("improved")
    assert faithful == Parameters()
    assert (faithful.dt, faithful.damping, faithful.iterations) == (0.0166, 0.2, 1)
    assert (
        replace(
            improved,
            iterations=1,
            stiffness_rule="each_iteration",
            sweeps="forward",
            tolerance=1e-4,
        )
        == faithful
    )


def test_stiff_slivers_are_warned_of_and_soft_ones_are_not() -> None:
    mesh = TriMesh([(0, 0, 0), (10, 0, 0), (5, 0.3, 0), (5, -8, 2)], [(0, 1, 2), (1, 0, 3)])
    stiff = surface_constraints(mesh, with_volume=False)
    with pytest.warns(RisoriusWarning, match=r"1 sliver triangles, first \[0, 1, 2\]"):
        Model(mesh.positions, stiff)
    Model(mesh.positions, surface_constraints(mesh, SurfaceStiffness(area=0.5), with_volume=False))


def test_residuals_are_zero_at_rest_and_say_how_far_off_a_pose_is() -> None:
    model = skin(sphere(2, 80.0))
    assert max(found.largest for found in residuals(model, model.rest_positions).values()) < 1e-12
    grown = residuals(model, 1.1 * model.rest_positions)
    assert grown["distances"].largest == pytest.approx(0.1)
    assert grown["areas"].mean_square_root == pytest.approx(0.21)
    assert grown["volumes"].largest == pytest.approx(0.331)
    assert grown["bends"].largest < 1e-12
    assert grown["holds"].largest == pytest.approx(8.0 / model.size)


@pytest.mark.parametrize("path", PATHS)
def test_an_empty_model_takes_steps(path: Path) -> None:
    model = Model(np.zeros((1, 3)), Constraints())
    after = Solver(path=path).step(model, State.at_rest(model))
    np.testing.assert_array_equal(after.positions, np.zeros((1, 3)))
    found = Solver(path=path).settle(model, State.at_rest(model, pose_count=2))
    assert found.positions.shape == (2, 1, 3)


def test_warming_up_leaves_kernels_ready() -> None:
    warm_up()
