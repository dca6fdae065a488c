from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from risorius.errors import ShapeError
from risorius.layered.faithful.contour import (
    Contour,
    contour_vertices,
    fill_grid,
    harmonic_fill,
)
from tests.layered.faithful.ground import flat_ground, lay, sheet


@given(st.integers(2, 7), st.integers(2, 7))
def test_the_four_lines_go_round_the_grid_and_meet_in_its_corners(rows: int, columns: int) -> None:
    a0, a1, a2, a3 = contour_vertices(rows, columns)
    for before, after in ((a0, a1), (a1, a2), (a2, a3), (a3, a0)):
        assert before[-1] == after[0]
    round_trip = np.unique(np.concatenate([a0, a1, a2, a3]))
    assert len(round_trip) == 2 * (rows + columns) - 4
    r, c = np.divmod(round_trip, columns)
    assert ((r == 0) | (r == rows - 1) | (c == 0) | (c == columns - 1)).all()


def _rim(rows: int, columns: int) -> np.ndarray:
    return np.unique(np.concatenate(contour_vertices(rows, columns)))


def test_the_inside_of_a_sheared_plane_is_exact() -> None:
    r, c = np.divmod(np.arange(35), 5)
    true = np.stack([3.0 * c + 0.4 * r, 2.0 * r, 0.3 * r - 0.1 * c], axis=1)
    known = _rim(7, 5)
    found = fill_grid(known, true[known], rows=7, columns=5)
    np.testing.assert_allclose(found, true, atol=1e-6)


def test_given_vertices_stay_where_they_are() -> None:
    generator = np.random.default_rng(3)
    known = _rim(6, 4)
    places = generator.normal(size=(len(known), 3)) * 10.0
    found = fill_grid(known, places, rows=6, columns=4)
    np.testing.assert_array_equal(found[known], places)
    assert np.isfinite(found).all()


def test_filled_values_are_means_of_their_neighbours() -> None:
    known = _rim(4, 5)
    values = np.random.default_rng(1).normal(size=(len(known), 2))
    grid = harmonic_fill(known, values, rows=4, columns=5).reshape(4, 5, 2)
    around = 0.25 * (grid[:-2, 1:-1] + grid[2:, 1:-1] + grid[1:-1, :-2] + grid[1:-1, 2:])
    np.testing.assert_allclose(grid[1:-1, 1:-1], around, atol=1e-12)


def test_lines_that_do_not_meet_are_refused() -> None:
    anatomy = flat_ground()
    lines = lay(anatomy, sheet("a", [(0, 0), (0, 40)])).lines.contour.lines
    Contour(lines).require_closed(anatomy.positions, anatomy.faces)
    turned = Contour((lines[0].reversed, *lines[1:]))
    with pytest.raises(ShapeError, match=r"line 0 ends .* mm from the start of line 1"):
        turned.require_closed(anatomy.positions, anatomy.faces)
