from __future__ import annotations

import numpy as np
import pytest

from risorius.mesh.core import TriMesh
from risorius.rig.quality.triangles import TriangleFaults, TriangleTest
from tests.rig.quality.made_heads import ball, grid

SHEET = grid()
INNER = 2 * 7 + 3
ALL = [np.ones(SHEET.face_count, bool)]


def judged(deltas: np.ndarray, mesh: TriMesh = SHEET) -> TriangleFaults:
    return TriangleTest(mesh).faults(deltas, [np.ones(mesh.face_count, bool)])[0]


def test_rest_has_no_faults() -> None:
    assert judged(np.zeros((42, 3))) == TriangleFaults(0, 0, 0)


@pytest.mark.parametrize("degrees", [30.0, 90.0, 135.0, 180.0])
def test_a_sheet_that_turns_as_a_whole_has_no_faults(degrees: float) -> None:
    a = np.radians(degrees)
    turn = np.array([[1, 0, 0], [0, np.cos(a), -np.sin(a)], [0, np.sin(a), np.cos(a)]])
    assert not judged(SHEET.positions @ turn.T - SHEET.positions).any
    round_one = ball((1.0, 2.0, 3.0), 5.0)
    assert not judged(round_one.positions @ turn.T - round_one.positions, round_one).any


def test_a_vertex_that_is_pushed_past_its_neighbours_turns_faces_over() -> None:
    deltas = np.zeros((42, 3))
    deltas[INNER] = (1.6, 0.0, 0.0)
    # Passing the next column folds the two faces that lie between them.
    assert judged(deltas).inverted == 2
    deltas[INNER] = (0.8, 0.0, 0.0)
    assert judged(deltas).inverted == 0


def test_a_sharp_fold_at_rest_is_not_called_inverted() -> None:
    positions = SHEET.positions.copy()
    positions[INNER] += (1.6, 0.0, 0.0)
    folded = SHEET.at(positions)
    assert judged(np.full((42, 3), 2.0), folded).inverted == 0


def test_faces_pressed_flat_are_collapsed_and_not_inverted() -> None:
    deltas = np.zeros((42, 3))
    column = SHEET.positions[:, 0] == 3.0
    deltas[column, 0] = 0.995
    faults = judged(deltas)
    assert faults.collapsed == 10
    assert faults.inverted == 0
    deltas[column, 0] = 0.98
    assert judged(deltas).collapsed == 0


def test_edges_beyond_four_times_their_length_are_stretched() -> None:
    deltas = np.zeros((42, 3))
    deltas[SHEET.positions[:, 0] == 6.0, 0] = 3.1
    assert judged(deltas).stretched == 10
    deltas[SHEET.positions[:, 0] == 6.0, 0] = 2.9
    assert judged(deltas).stretched == 0


def test_a_tiny_edge_may_grow_to_an_ordinary_one() -> None:
    positions = SHEET.positions.copy()
    positions[SHEET.positions[:, 0] == 6.0, 0] = 5.05
    deltas = SHEET.positions - positions
    assert judged(deltas, SHEET.at(positions)).stretched == 0


def test_groups_are_counted_apart() -> None:
    deltas = np.zeros((42, 3))
    deltas[INNER] = (1.6, 0.0, 0.0)
    upper = SHEET.positions[SHEET.faces].mean(axis=1)[:, 1] > 2.0
    above, below = TriangleTest(SHEET).faults(deltas, [upper, ~upper])
    assert (above.inverted, below.inverted) == (1, 1)


def test_faults_do_not_depend_on_the_unit() -> None:
    deltas = np.zeros((42, 3))
    deltas[INNER] = (1.6, 0.0, 0.0)
    deltas[SHEET.positions[:, 0] == 6.0, 0] = 3.1
    small = SHEET.at(1e-4 * SHEET.positions)
    assert judged(1e-4 * deltas, small) == judged(deltas)
