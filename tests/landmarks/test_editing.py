"""Landmarks placed, mirrored and taken away by a person."""

from __future__ import annotations

import numpy as np
import pytest

from risorius.anatomy.template import builtin_head
from risorius.errors import LandmarkError
from risorius.landmarks.editing import mirrored, placed, without
from risorius.landmarks.landmark_set import LandmarkSpec, resolve

HEAD = builtin_head()
SPECS = {name: LandmarkSpec(vertex=HEAD.landmarks.vertex(name)) for name in HEAD.landmarks}


def test_a_placed_landmark_stands_on_the_nearest_vertex_and_no_other_moves() -> None:
    vertex = int(HEAD.skin.first_source()[700])
    place = HEAD.source.positions[vertex] + 1e-3
    moved = placed(SPECS, "8.3", place, HEAD.source)
    found = resolve(moved, HEAD.source).position("8.3")
    assert np.allclose(found, HEAD.source.positions[vertex])
    assert {n: s for n, s in moved.items() if n != "8.3"} == {
        n: s for n, s in SPECS.items() if n != "8.3"
    }


def test_a_mirrored_landmark_lies_across_the_midline_on_the_other_side() -> None:
    bare = without(SPECS, "8.4")
    whole = mirrored(bare, "8.3", HEAD.positions, HEAD.source)
    there = HEAD.positions[whole["8.4"].vertex or 0]
    assert np.allclose(there, HEAD.landmarks.position("8.3") * [-1.0, 1.0, 1.0], atol=0.5)
    assert there[0] < 0.0, "8.4 is the character's right"


@pytest.mark.parametrize(
    ("act", "sentence"),
    [
        (lambda: placed(SPECS, "99.9", np.zeros(3), HEAD.source), "no feature point"),
        (lambda: mirrored(SPECS, "9.3", HEAD.positions, HEAD.source), "no other side"),
        (
            lambda: mirrored(without(SPECS, "8.3"), "8.3", HEAD.positions, HEAD.source),
            "place '8.3' on the head first",
        ),
        (lambda: without(without(SPECS, "8.3"), "8.3"), "no '8.3' to take away"),
    ],
)
def test_what_cannot_be_is_refused(act, sentence: str) -> None:
    with pytest.raises(LandmarkError, match=sentence):
        act()
