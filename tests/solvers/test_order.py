"""The order of projections: independent groups, complete, repeatable, symmetric on request."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given

from risorius.errors import MeshError
from risorius.mesh.core import TriMesh
from risorius.solvers.constraints import Constraints, Distances
from risorius.solvers.model import Model
from risorius.solvers.order import order_of, sequence
from risorius.solvers.surface import surface_constraints
from risorius.solvers.trial_head import trial_head
from tests.mesh.shapes import grid, sphere
from tests.solvers.particles import meshes, pairs_of


@given(meshes())
def test_every_constraint_comes_once_and_groups_share_no_particle(mesh: TriMesh) -> None:
    found = surface_constraints(mesh)
    order = order_of(found, mesh.vertex_count)
    assert sorted(order.particles.tolist()) == list(range(mesh.vertex_count))
    for name in ("distances", "areas", "bends"):
        table, groups = getattr(found, name), getattr(order, name)
        assert sorted(sequence(groups).tolist()) == list(range(len(table.particles)))
        for group in groups:
            touched = table.particles[group[group >= 0]].ravel()
            assert len(np.unique(touched)) == len(touched)


def test_groups_of_a_head_are_nearly_full() -> None:
    mesh = trial_head(1500)
    found = surface_constraints(mesh)
    order = order_of(found, mesh.vertex_count)
    for groups in (order.distances, order.areas, order.bends):
        assert (groups >= 0).mean() > 0.9


def test_the_order_is_the_same_every_time() -> None:
    found = surface_constraints(sphere(2))
    first, second = order_of(found, 162), order_of(found, 162)
    assert first.particles.tobytes() == second.particles.tobytes()
    assert first.bends.tobytes() == second.bends.tobytes()


def test_constraints_without_stiffness_are_left_out() -> None:
    table = Distances(pairs_of((0, 1), (1, 2), (2, 3)), [1.0] * 3, [0.5, 0.0, 0.5])
    order = order_of(Constraints(table), 4)
    assert sorted(sequence(order.distances).tolist()) == [0, 2]


def test_mirrored_constraints_come_at_the_same_time() -> None:
    mesh = grid(8, 6)
    x, y = mesh.positions[:, 0], mesh.positions[:, 1]
    key = {(round(a, 6), round(b, 6)): i for i, (a, b) in enumerate(zip(x, y))}
    mirror = np.array([key[round(1.0 - a, 6), round(b, 6)] for a, b in zip(x, y)], np.int32)
    # Diagonals of a grid all run the same way: keep the sides, which have mirror images.
    pairs = surface_constraints(mesh, with_volume=False).distances.particles
    straight = np.abs(mesh.positions[pairs[:, 0]] - mesh.positions[pairs[:, 1]]) < 1e-9
    pairs = pairs[straight[:, :2].any(axis=1)]
    found = Constraints(Distances(pairs, np.ones(len(pairs)), 0.5))
    groups = order_of(found, mesh.vertex_count, mirror=mirror).distances
    group_of = np.empty(len(pairs), int)
    for number, group in enumerate(groups):
        group_of[group[group >= 0]] = number
    row_of = {tuple(sorted(row)): number for number, row in enumerate(pairs.tolist())}
    apart = 0
    for number, row in enumerate(pairs.tolist()):
        image = sorted(mirror[row].tolist())
        if not set(image) & set(row):
            first, second = sorted((group_of[row_of[tuple(image)]], group_of[number]))
            # In one group, or in two that follow each other and share no particle either.
            assert second - first <= 1
            between = groups[first : second + 1].ravel()
            touched = pairs[between[between >= 0]].ravel()
            assert len(np.unique(touched)) == len(touched)
            apart += 1
    assert apart > 50


def test_a_mirror_that_does_not_lead_back_is_refused() -> None:
    with pytest.raises(MeshError, match="mirror: must name for each of 3 particles"):
        Model(np.eye(3), Constraints(), mirror=np.array([1, 2, 0]))
