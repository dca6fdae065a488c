"""Welding of coincident vertices."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from risorius.errors import MeshError, ShapeError
from risorius.mesh.welding import weld
from tests.mesh.shapes import grid, sphere


def test_distinct_vertices_stay_as_they_are():
    mesh = sphere(2)
    result = weld(mesh.positions)
    assert result.is_identity
    np.testing.assert_array_equal(result.representative, np.arange(mesh.vertex_count))
    np.testing.assert_array_equal(result.faces(mesh.faces), mesh.faces)


def test_a_seam_is_closed_and_opened_again():
    mesh = sphere(2)
    soup = mesh.positions[mesh.faces.ravel()]
    result = weld(soup)
    assert len(result.first) == mesh.vertex_count
    faces = result.faces(np.arange(len(soup), dtype=np.int32).reshape(-1, 3))
    np.testing.assert_array_equal(result.compress(soup)[faces], mesh.positions[mesh.faces])
    np.testing.assert_array_equal(result.expand(result.compress(soup)), soup)


@given(
    arrays(np.int8, st.tuples(st.integers(0, 30), st.just(3)), elements=st.integers(0, 2)),
)
def test_equal_positions_join_and_others_do_not(cells: np.ndarray):
    points = cells * 10.0
    result = weld(points, tolerance=0.0)
    same = (points[:, None] == points).all(axis=2)
    np.testing.assert_array_equal(result.representative[:, None] == result.representative, same)
    np.testing.assert_array_equal(result.representative[result.first], np.arange(len(result.first)))
    assert (np.diff(result.first) > 0).all()


@given(st.floats(-1e3, 1e3), st.floats(0.01, 100.0))
def test_pairs_join_wherever_the_origin_lies(shift: float, unit: float):
    # A grid of cells would part some of these pairs at a cell border.
    base = grid(6, 6).positions
    near = base + 3e-7
    result = weld((np.concatenate([base, near]) + shift / 1e3) * unit, tolerance=1e-6)
    assert len(result.first) == len(base)
    np.testing.assert_array_equal(result.representative[len(base) :], np.arange(len(base)))


def test_tolerance_is_a_share_of_the_size():
    points = np.array([[0, 0, 0], [100, 0, 0], [100.05, 0, 0]])
    assert len(weld(points, tolerance=1e-3).first) == 2
    assert len(weld(points, tolerance=1e-4).first) == 3


def test_touching_lips_stay_apart():
    points = np.zeros((6, 3))
    points[[2, 5]] = [1, 0, 0]
    # 0 and 1 are upper and lower lip at one place, 3 and 4 their copies at a texture seam.
    result = weld(points, keep_apart=np.array([[0, 1], [0, 4], [3, 1], [3, 4]], np.int32))
    r = result.representative.tolist()
    assert r[0] == r[3] != r[1] == r[4]
    assert r[2] == r[5]
    assert len(result.first) == 3


def test_pairs_kept_apart_never_meet_through_a_third():
    points = np.array([[0.0, 0, 0], [0.9e-6, 0, 0], [0.3e-6, 0, 0], [1, 0, 0]])
    result = weld(points, tolerance=1e-6, keep_apart=np.array([[0, 1]]))
    r = result.representative.tolist()
    assert r[0] != r[1]
    assert r[2] == r[0], "the third joins the nearer one"


@given(st.integers(0, 2**32 - 1))
def test_no_forbidden_pair_is_ever_joined(seed: int):
    generator = np.random.default_rng(seed)
    points = generator.integers(0, 2, (12, 3)).astype(float)
    pairs = generator.integers(0, 12, (10, 2))
    pairs = pairs[pairs[:, 0] != pairs[:, 1]].astype(np.int32)
    r = weld(points, keep_apart=pairs).representative
    if len(pairs):
        assert (r[pairs[:, 0]] != r[pairs[:, 1]]).all()
    assert all((points[r == c] == points[r == c][0]).all() for c in range(r.max() + 1))


def test_a_stray_vertex_that_inflates_the_tolerance_is_refused():
    points = np.vstack([np.random.default_rng(0).normal(size=(2000, 3)), [[1e9, 0, 0]]])
    with pytest.raises(MeshError, match="remove stray vertices"):
        weld(points)


def test_many_vertices_at_one_place_are_no_burden():
    assert len(weld(np.vstack([np.zeros((50_000, 3)), np.eye(3)])).first) == 4


def test_nothing_welds_to_nothing():
    assert weld(np.zeros((0, 3))).representative.shape == (0,)
    assert weld(np.zeros((1, 3))).first.tolist() == [0]


@pytest.mark.parametrize(
    ("pairs", "message"),
    [
        ([[0, 5]], "must lie in 0..1"),
        ([[1, 1]], "row 0 pairs vertex 1 with itself"),
        ([0, 1], r"expected shape \(k, 2\)"),
    ],
)
def test_bad_pairs_are_refused(pairs: list[int], message: str):
    with pytest.raises(ShapeError, match=message):
        weld(np.eye(3)[:2], keep_apart=np.array(pairs))
