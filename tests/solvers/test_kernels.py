"""Compiled projections: against hand calculation, against the gradients, against one another."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from risorius._check import FloatArray
from risorius.mesh.core import TriMesh
from risorius.solvers import gradients
from risorius.solvers.constraints import Areas, Bends, Constraints, Contacts, Distances, Volume
from risorius.solvers.model import Control, Model, State
from risorius.solvers.parameters import PROFILES, Parameters
from risorius.solvers.pbd import Path, Solver
from tests.mesh.shapes import rotation, sphere
from tests.solvers.particles import (
    TETRAHEDRON,
    meshes,
    momenta,
    pairs_of,
    pulled,
    skin,
)

# Without step limits a projection is the printed formula.
STILL = Parameters(damping=1.0, bend_step_limit=None, area_step_limit=None)
PATHS: tuple[Path, ...] = ("scalar", "simd")
# float32, after as many as thirty sweeps, in sizes of the model.
CLOSE = 2e-6


def _moved(
    model: Model,
    positions: FloatArray,
    control: Control | None = None,
    *,
    parameters: Parameters = STILL,
    path: Path = "scalar",
) -> FloatArray:
    state = State(positions, np.zeros_like(positions))
    return Solver(path=path).step(model, state, control, parameters=parameters).positions


@pytest.mark.parametrize("path", PATHS)
def test_distance_moves_both_ends_by_hand_calculation(path: Path) -> None:
    # 1 mm too long, w = 1 and 3: a quarter and three quarters of k = 0.5 of it.
    table = Distances(pairs_of((0, 1)), [2.0], 0.5)
    model = Model([(0, 0, 0), (2, 0, 0)], Constraints(table), inv_mass=[1.0, 3.0])
    found = _moved(model, np.array([(0, 0, 0), (3, 0, 0)], float), path=path)
    np.testing.assert_allclose(found, [(0.125, 0, 0), (2.625, 0, 0)], atol=1e-6)


def _single(kind: str, seed: int) -> tuple[Model, FloatArray, FloatArray, float]:
    """Return one constraint, shaken positions, its gradient there, its error there."""
    generator = np.random.default_rng(seed)
    count = {"distance": 2, "area": 3, "bend": 4, "volume": 4}[kind]
    rest = np.array([(0, 0, 0), (2, 0, 0), (0.7, 1.5, 0.2), (1.1, -0.6, 1.4)])[:count]
    positions = rest + 0.2 * generator.normal(size=rest.shape)
    row = pairs_of(tuple(range(count)))
    if kind == "distance":
        wanted = gradients.distance_value(rest[None])
        constraints = Constraints(Distances(row, wanted, 0.7))
        value, gradient = gradients.distance_value, gradients.distance_gradient
    elif kind == "area":
        wanted = gradients.area_value(rest[None])
        constraints = Constraints(areas=Areas(row, wanted, 0.7))
        value, gradient = gradients.area_value, gradients.area_gradient
    elif kind == "bend":
        wanted = gradients.bend_value(rest[None])
        constraints = Constraints(bends=Bends(row, wanted, 0.7))
        value, gradient = gradients.bend_value, gradients.bend_gradient
    else:
        volume = gradients.volume_value(rest, TETRAHEDRON)
        constraints = Constraints(volumes=(Volume(TETRAHEDRON, volume, 0.7),))
        model = Model(rest, constraints, inv_mass=generator.uniform(0.5, 2.0, count))
        error = gradients.volume_value(positions, TETRAHEDRON) - volume
        return model, positions, gradients.volume_gradient(positions, TETRAHEDRON), error
    model = Model(rest, constraints, inv_mass=generator.uniform(0.5, 2.0, count))
    error = (value(positions[None]) - wanted)[0]
    return model, positions, gradient(positions[None])[0], float(error)


@pytest.mark.parametrize("kind", ["distance", "area", "bend", "volume"])
@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("path", PATHS)
def test_one_projection_is_minus_k_c_w_gradient_over_w(kind: str, seed: int, path: Path) -> None:
    model, positions, gradient, error = _single(kind, seed)
    w = model.weights[:, None]
    wanted = positions - 0.7 * error * w * gradient / (w * gradient**2).sum()
    found = _moved(model, positions, path=path)
    tolerance = 1e-10 if path == "scalar" else 1e-5
    assert np.abs(found - wanted).max() < tolerance * max(1.0, np.abs(wanted - positions).max())


@pytest.mark.parametrize("kind", ["distance", "area", "bend", "volume"])
@pytest.mark.parametrize("path", PATHS)
def test_compliance_reproduces_one_published_projection(kind: str, path: Path) -> None:
    model, _, _, _ = _single(kind, 1)
    # Near rest, where W is what it is at rest, a = dt^2 W (1 - k) / k removes the share k.
    positions = model.rest_positions.copy()
    positions[0] += (1e-3, 2e-3, -1e-3)
    published = _moved(model, positions, path=path)
    compliant = _moved(
        model, positions, parameters=replace(STILL, stiffness_rule="compliance"), path=path
    )
    move = np.abs(published - positions).max()
    assert move > 1e-5
    assert np.abs(compliant - published).max() < 0.01 * move


@pytest.mark.parametrize("path", PATHS)
def test_compliance_stiffens_with_the_square_of_the_duration_of_a_substep(path: Path) -> None:
    table = Distances(pairs_of((0, 1)), [1.0], 0.2)
    model = Model([(0, 0, 0), (1, 0, 0)], Constraints(table), inv_mass=[0.0, 1.0])
    stretched = np.array([(0, 0, 0), (2, 0, 0)], float)
    for dt, wanted in ((0.0166, 0.2), (2 * 0.0166, 1 / (1 + 4 / 4)), (0.0083, 1 / (1 + 4 * 4))):
        parameters = replace(STILL, stiffness_rule="compliance", dt=dt)
        found = _moved(model, stretched, parameters=parameters, path=path)
        assert 2.0 - found[1, 0] == pytest.approx(wanted, rel=1e-5)
        halved = replace(parameters, dt=2 * dt, substeps=2)
        twice = _moved(model, stretched, parameters=halved, path=path)
        assert twice[1, 0] - 1.0 == pytest.approx((1.0 - wanted) ** 2, rel=1e-5)


@pytest.mark.parametrize("kind", ["distance", "area", "bend", "volume"])
def test_free_projections_converge_and_keep_both_momenta(kind: str) -> None:
    model, positions, _, error = _single(kind, 2)
    found = _moved(model, positions, parameters=replace(STILL, iterations=60))
    linear, angular = momenta(found, positions, 1.0 / model.weights)
    assert np.abs(linear).max() < 1e-10
    left = {
        "distance": lambda p: (
            gradients.distance_value(p[None])[0] - model.constraints.distances.rest[0]
        ),
        "area": lambda p: gradients.area_value(p[None])[0] - model.constraints.areas.rest[0],
        "bend": lambda p: gradients.bend_value(p[None])[0] - model.constraints.bends.rest[0],
        "volume": lambda p: (
            gradients.volume_value(p, TETRAHEDRON) - model.constraints.volumes[0].rest
        ),
    }[kind](found)
    assert abs(left) < 1e-9 * abs(error)
    # Each single projection turns nothing.
    once = _moved(model, positions)
    _, angular = momenta(once, positions, 1.0 / model.weights)
    assert np.abs(angular).max() < 1e-10


@settings(max_examples=25)
@given(meshes(), st.integers(0, 1000), st.sampled_from(["improved", "faithful"]))
def test_all_ways_to_run_a_model_agree(mesh: TriMesh, seed: int, profile: str) -> None:
    model = skin(mesh)
    positions, targets = pulled(model, seed)
    parameters = replace(PROFILES[profile], iterations=6)
    control = Control(targets=targets)
    exact = _moved(model, positions, control, parameters=parameters)
    assert np.abs(exact - positions).max() > 1e-3 * model.size
    packed = _moved(model, positions, control, parameters=parameters, path="simd")
    assert np.abs(packed - exact).max() < CLOSE * model.size
    several = np.stack([positions, model.rest_positions, positions])
    pulls = np.stack([targets, targets[::-1], targets])
    state = State(several, np.zeros_like(several))
    lanes = Solver().step(model, state, Control(targets=pulls), parameters=parameters).positions
    assert np.abs(lanes[[0, 2]] - exact).max() < CLOSE * model.size
    other = _moved(
        model, model.rest_positions, Control(targets=targets[::-1]), parameters=parameters
    )
    assert np.abs(lanes[1] - other).max() < CLOSE * model.size


def test_a_surface_without_simple_rings_gives_the_same_in_all_ways() -> None:
    # Two spheres that touch in one vertex: its neighbours form two rings.
    one, two = sphere(1), sphere(1)
    second = np.where(two.faces == 0, 0, two.faces + one.vertex_count)
    shift = one.positions[0] * 2.0
    mesh = TriMesh(
        np.concatenate([one.positions, shift - two.positions]),
        np.concatenate([one.faces, second[:, ::-1]]),
    )
    model = skin(mesh)
    positions, targets = pulled(model, 3)
    control = Control(targets=targets)
    exact = _moved(model, positions, control)
    assert np.abs(_moved(model, positions, control, path="simd") - exact).max() < 1e-5
    state = State(positions[None], np.zeros((1, *positions.shape)))
    lanes = Solver().step(model, state, control, parameters=STILL)
    assert np.abs(lanes.positions[0] - exact).max() < 1e-5


@pytest.mark.parametrize("path", PATHS)
@pytest.mark.parametrize("profile", sorted(PROFILES))
def test_rest_is_a_fixed_point(path: Path, profile: str) -> None:
    model = skin(sphere(2, 80.0))
    found = _moved(model, model.rest_positions, parameters=PROFILES[profile], path=path)
    assert np.abs(found - model.rest_positions).max() < (1e-10 if path == "scalar" else 1e-4)


@settings(max_examples=10)
@given(meshes(), st.integers(0, 1000), st.sampled_from(PATHS))
def test_moving_turning_and_scaling_the_model_does_so_with_the_result(
    mesh: TriMesh, seed: int, path: Path
) -> None:
    model = skin(mesh)
    positions, targets = pulled(model, seed)
    parameters = replace(PROFILES["improved"], sweeps="forward")
    found = _moved(model, positions, Control(targets=targets), parameters=parameters, path=path)
    turn = rotation(np.random.default_rng(seed))

    def carried(points: FloatArray) -> FloatArray:
        return 8.0 * points @ turn.T + (0.3 * model.size, 0.0, -model.size)

    image = skin(mesh.at(carried(mesh.positions)))
    after = _moved(
        image,
        carried(positions),
        Control(targets=carried(targets)),
        parameters=parameters,
        path=path,
    )
    tolerance = 1e-9 if path == "scalar" else CLOSE
    assert np.abs(after - carried(found)).max() < tolerance * image.size


@pytest.mark.parametrize("path", PATHS)
def test_pinned_particles_stay_to_the_bit_and_follow_the_control(path: Path) -> None:
    free = skin(sphere(2, 80.0))
    weights = free.weights.copy()
    weights[[3, 50, 51]] = 0.0
    model = Model(free.rest_positions, free.constraints, inv_mass=weights)
    positions, targets = pulled(model, 4)
    for where in (model.rest_positions[model.pinned], np.array([(1, 2, 3), (90, 0, 0), (0, 0, 9)])):
        control = Control(targets=targets, pinned=where)
        found = _moved(model, positions, control, path=path)
        # Exactly what a single copy through the solver's coordinates leaves of them.
        untouched = _moved(
            Model(model.rest_positions, Constraints(free.constraints.distances), inv_mass=weights),
            positions,
            Control(pinned=where),
            path=path,
        )
        assert found[model.pinned].tobytes() == untouched[model.pinned].tobytes()
        assert np.abs(found[model.pinned] - where).max() < 1e-5


def test_the_same_input_gives_the_same_bytes_on_any_number_of_threads() -> None:
    model = skin(sphere(2, 80.0))
    poses = [pulled(model, seed) for seed in range(40)]
    state = State(np.stack([p for p, _ in poses]), np.zeros((40, model.particle_count, 3)))
    control = Control(targets=np.stack([t for _, t in poses]))
    once = Solver().step(model, state, control).positions
    again = Solver(threads=3).step(model, state, control).positions
    assert once.tobytes() == again.tobytes()


@pytest.mark.parametrize("path", PATHS)
def test_contacts_push_out_what_is_behind_them_and_nothing_else(path: Path) -> None:
    rest = np.array([(0, 0, -1), (0, 0, 2), (3, 0, -5)], float)
    model = Model(rest, Constraints())
    contacts = Contacts([0, 1], np.zeros((2, 3)), np.tile((0.0, 0.0, 1.0), (2, 1)))
    found = _moved(model, rest, Control(contacts=contacts), path=path)
    np.testing.assert_allclose(found, [(0, 0, 0), (0, 0, 2), (3, 0, -5)], atol=1e-6)


def test_contacts_of_several_poses_act_on_their_own_pose_only() -> None:
    rest = np.array([(0, 0, -1), (0, 0, -2)], float)
    model = Model(rest, Constraints())
    normals = np.zeros((2, 1, 3))
    normals[0] = (0, 0, 1)
    contacts = Contacts([0], np.zeros((2, 1, 3)), normals)
    state = State.at_rest(model, pose_count=2)
    found = Solver().step(model, state, Control(contacts=contacts), parameters=STILL)
    np.testing.assert_allclose(found.positions[0], [(0, 0, 0), (0, 0, -2)], atol=1e-6)
    np.testing.assert_allclose(found.positions[1], rest, atol=1e-6)
    apart = Solver(path="scalar").step(model, state, Control(contacts=contacts), parameters=STILL)
    np.testing.assert_allclose(apart.positions, found.positions, atol=1e-6)


@pytest.mark.parametrize("path", PATHS)
def test_a_step_limit_tames_a_projection_without_lever(path: Path) -> None:
    # Both far corners are pinned and lie on the edge's own line, nearly: no lever to turn with.
    rest = np.array([(0, 0, 0), (1, 0, 0), (0.5, 1, 0), (0.5, -1, 0)], float)
    table = Bends(pairs_of((0, 1, 2, 3)), [0.0], 0.95)
    model = Model(rest, Constraints(bends=table), inv_mass=[1, 1, 0, 0])
    squashed = rest.copy()
    squashed[2], squashed[3] = (50, 0.02, 0.02), (-50, -0.02, 0.021)
    wild = _moved(model, squashed, Control(pinned=squashed[2:]), path=path)
    tame = _moved(
        model,
        squashed,
        Control(pinned=squashed[2:]),
        parameters=replace(STILL, bend_step_limit=0.2),
        path=path,
    )
    assert np.linalg.norm(wild - squashed, axis=1).max() < 1e7
    assert np.linalg.norm(tame - squashed, axis=1).max() <= 0.2 * (1 + 1e-5)


@given(st.integers(0, 10**6), st.floats(0.02, 1.0))
def test_step_limits_hold_for_any_configuration(seed: int, limit: float) -> None:
    generator = np.random.default_rng(seed)
    rest = np.array([(0, 0, 0), (1, 0, 0), (0.5, 1, 0), (0.5, -1, 0.4)])
    table = Bends(pairs_of((0, 1, 2, 3)), gradients.bend_value(rest[None]), 0.95)
    area = Areas(pairs_of((0, 1, 2)), gradients.area_value(rest[None, :3]), 0.95)
    weights = generator.uniform(0.0, 2.0, 4)
    positions = generator.normal(size=(4, 3))
    for constraints, edge in (
        (Constraints(bends=table), float(np.linalg.norm(positions[1] - positions[0]))),
        (Constraints(areas=area), float(np.sqrt(area.rest[0]))),
    ):
        model = Model(rest, constraints, inv_mass=weights)
        parameters = replace(STILL, bend_step_limit=limit, area_step_limit=limit)
        found = _moved(model, positions, parameters=parameters)
        assert np.linalg.norm(found - positions, axis=1).max() <= limit * edge * (1 + 1e-9)
