"""The errors by which clones are judged."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from risorius.cloning import (
    absolute_error,
    compare_rigs,
    direction_cosine,
    motion_error,
    roughness,
)
from risorius.errors import ParameterError, ShapeError
from risorius.mesh import TriMesh
from tests.cloning.rigs import source_rig

REST = np.array([[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 4.0, 0.0]])
TRUTH = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 2.0]])
MADE = np.array([[0.0, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 3.0]])


def test_the_motion_error_is_what_one_computes_by_hand() -> None:
    assert motion_error(TRUTH, MADE) == pytest.approx(100.0 * (1.0 + 1.0) / 3.0)
    assert motion_error(TRUTH, TRUTH) == 0.0
    assert motion_error(0.0 * TRUTH, 0.0 * TRUTH) == 0.0
    assert motion_error(0.0 * TRUTH, MADE) == np.inf


def test_equation_6_1_is_what_one_computes_by_hand() -> None:
    size = np.linalg.norm(REST - REST.mean(axis=0) + TRUTH, axis=1).sum()
    assert absolute_error(REST, TRUTH, MADE) == pytest.approx(200.0 / size)


@given(st.lists(st.floats(-1e3, 1e3), min_size=3, max_size=3))
def test_equation_6_1_does_not_depend_on_the_origin(shift: list[float]) -> None:
    moved = absolute_error(REST + np.array(shift), TRUTH, MADE)
    assert moved == pytest.approx(absolute_error(REST, TRUTH, MADE), rel=1e-9)


def test_direction_weighs_by_motion_and_counts_rest_as_nothing() -> None:
    assert direction_cosine(TRUTH, 2.0 * TRUTH) == pytest.approx(1.0)
    assert direction_cosine(TRUTH, -TRUTH) == pytest.approx(-1.0)
    assert direction_cosine(TRUTH, MADE) == pytest.approx(2.0 / 3.0)
    assert direction_cosine(0.0 * TRUTH, MADE) == 1.0


def _sheet(count: int) -> TriMesh:
    x, y = np.meshgrid(np.arange(count, dtype=float), np.arange(count, dtype=float))
    points = np.stack([x.ravel(), y.ravel(), 0.0 * x.ravel()], axis=1)
    at = np.arange(count * count).reshape(count, count)
    a, b, c, d = at[:-1, :-1], at[:-1, 1:], at[1:, 1:], at[1:, :-1]
    faces = [np.stack(t, axis=-1).reshape(-1, 3) for t in ((a, b, c), (a, c, d))]
    return TriMesh(points, np.concatenate(faces).astype(np.int32))


def test_noise_is_rougher_than_a_wave_and_a_plane_is_not_rough() -> None:
    mesh = _sheet(20)
    x = mesh.positions[:, :1]
    plane, wave = x * [0.0, 0.0, 1.0], np.sin(0.3 * x) * [0.0, 0.0, 1.0]
    noise = np.random.default_rng(1).standard_normal((len(x), 3))
    assert roughness(mesh, plane) < 1e-12
    assert roughness(mesh, 0.0 * plane) == 0.0
    assert roughness(mesh, 5.0 * wave) == pytest.approx(roughness(mesh, wave))
    assert roughness(mesh, noise) > 10.0 * roughness(mesh, wave)


def test_displacements_of_different_meshes_are_refused() -> None:
    with pytest.raises(ShapeError, match="expected displacements like the truth's"):
        motion_error(TRUTH, MADE[:2])


def test_a_rig_is_equal_to_itself_and_doubled_motion_is_told() -> None:
    rig = source_rig().subset(["smile", "jawOpen"])
    same = compare_rigs(rig, rig)
    assert [shape.name for shape in same.shapes] == ["smile", "jawOpen"]
    for shape in same.shapes:
        assert (shape.motion, shape.absolute) == (0.0, 0.0)
        assert shape.amplitude == shape.roughness == 1.0
        assert shape.gap == shape.gap_first
    doubled = rig.with_targets(
        [replace(rig.target("smile"), deltas=2.0 * rig.target("smile").deltas)]
    )
    told = compare_rigs(rig, doubled)
    assert told.only_first == ("jawOpen",)
    assert told.shapes[0].motion == pytest.approx(100.0)
    assert told.shapes[0].amplitude == pytest.approx(2.0)


def test_rigs_that_cannot_be_compared_are_refused() -> None:
    rig = source_rig().subset(["smile"])
    with pytest.raises(ParameterError, match="share no name of a shape"):
        compare_rigs(rig, source_rig().subset(["blink"]))
    moved = replace(rig, mesh=replace(rig.mesh, positions=1.1 * rig.mesh.positions))
    with pytest.raises(ShapeError, match="the neutral heads differ"):
        compare_rigs(rig, moved)
