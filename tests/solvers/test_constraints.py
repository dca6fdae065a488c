"""Constraint tables refuse what cannot be meant."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from risorius.errors import ParameterError, ShapeError
from risorius.solvers.constraints import (
    Areas,
    Bends,
    Constraints,
    Contacts,
    Distances,
    Holds,
    Volume,
)
from tests.solvers.particles import TETRAHEDRON, pairs_of

_REFUSED = [
    (lambda: Distances(pairs_of((0, 1, 2)), [1.0], 0.5), ShapeError, r"expected integers of shape"),
    (lambda: Distances([[0.0, 1.0]], [1.0], 0.5), ShapeError, "expected integers"),
    (lambda: Distances(pairs_of((3, 3)), [1.0], 0.5), ShapeError, r"row 0 is \[3, 3\]"),
    (lambda: Distances(pairs_of((0, 1)), [-1.0], 0.5), ParameterError, "entry 0 is -1, below 0"),
    (lambda: Distances(pairs_of((0, 1)), [np.nan], 0.5), ShapeError, "entry 0 is nan"),
    (lambda: Distances(pairs_of((0, 1)), [1.0], 1.5), ParameterError, "1.5, must lie in 0..1"),
    (lambda: Areas(pairs_of((0, 1, 2)), [0.0], 0.5), ParameterError, "must be above 0"),
    (lambda: Bends(pairs_of((0, 1, 2, 2)), [0.0], 0.5), ShapeError, "it names one twice"),
    (lambda: Holds(pairs_of((0, 1)), 0.5), ShapeError, "holds.particles"),
    (lambda: Volume(TETRAHEDRON, np.inf), ParameterError, "volume.rest: inf is not finite"),
    (lambda: Volume(TETRAHEDRON, 1.0, 2.0), ParameterError, "volume.stiffness: 2 is above 1"),
    (lambda: Contacts([0], np.zeros((2, 3)), np.zeros((2, 3))), ShapeError, "contacts.points"),
    (
        lambda: Contacts([0], np.zeros((1, 3)), np.zeros((2, 1, 3))),
        ShapeError,
        "points .* and normals .* differ",
    ),
    (
        lambda: Contacts([0], np.full((1, 3), np.nan), np.zeros((1, 3))),
        ShapeError,
        "every entry must be finite",
    ),
]


@pytest.mark.parametrize(("build", "error", "message"), _REFUSED)
def test_refusal_says_what_is_wrong(
    build: Callable[[], object], error: type[Exception], message: str
) -> None:
    with pytest.raises(error, match=message):
        build()


def test_one_stiffness_serves_all_rows() -> None:
    table = Distances(pairs_of((0, 1), (1, 2)), [1.0, 2.0], 0.5)
    assert table.stiffness.tolist() == [0.5, 0.5]


def test_joined_tables_keep_their_rows_in_order() -> None:
    first = Distances(pairs_of((0, 1)), [1.0], 0.5)
    second = Distances(pairs_of((1, 2), (2, 3)), [2.0, 3.0], [0.1, 0.2])
    both = Distances.joined([first, second])
    assert both.rest.tolist() == [1.0, 2.0, 3.0]
    assert both.stiffness.tolist() == [0.5, 0.1, 0.2]
    assert len(Distances.joined([]).particles) == 0


def test_count_is_the_sum_over_all_kinds() -> None:
    found = Constraints(
        Distances(pairs_of((0, 1)), [1.0], 0.5),
        Areas(pairs_of((0, 1, 2)), [1.0], 0.5),
        Bends(pairs_of((0, 1, 2, 3)), [0.0], 0.5),
        (Volume(TETRAHEDRON, 1.0),),
        Holds([0, 1], 0.5),
    )
    assert found.count == 6
