"""Vector muscles moved, added and removed by a person; both sides stay alike."""

from __future__ import annotations

import numpy as np
import pytest

from risorius.errors import ParameterError
from risorius.vectormuscle.editing import added, moved_end, removed, with_numbers
from risorius.vectormuscle.vector_set import default_vector_set, parse_vector_set

MIRROR = np.array([-1.0, 1.0, 1.0])
HEAD, TAIL = np.array([50.0, -20.0, 60.0]), np.array([28.0, -66.0, 84.0])


def _named(vectors, name: str):
    return next(muscle for muscle in vectors.muscles if muscle.name == name)


def test_a_moved_tail_moves_the_mirror_image_and_nothing_else() -> None:
    before = default_vector_set()
    after = moved_end(before, "zygomaticus_major_l", "insertion", TAIL)
    assert np.array_equal(_named(after, "zygomaticus_major_l").insertion, TAIL)
    assert np.array_equal(_named(after, "zygomaticus_major_r").insertion, TAIL * MIRROR)
    for muscle in before.muscles:
        if not muscle.name.startswith("zygomaticus_major"):
            assert _named(after, muscle.name).to_json() == muscle.to_json()


def test_what_is_seen_is_what_the_file_gives_back() -> None:
    after = moved_end(default_vector_set(), "zygomaticus_major_l", "origin", HEAD / 3.0)
    again = parse_vector_set(after.to_json(), source="x")
    assert np.array_equal(
        _named(again, "zygomaticus_major_l").origin, _named(after, "zygomaticus_major_l").origin
    )


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_new_muscle_is_there_on_both_sides_wherever_it_was_drawn(sign: float) -> None:
    side = np.array([sign, 1.0, 1.0])
    after = added(default_vector_set(), "smiler", HEAD * side, TAIL * side)
    assert np.allclose(_named(after, "smiler_l").origin, HEAD)
    assert np.allclose(_named(after, "smiler_r").insertion, TAIL * MIRROR)
    assert removed(after, "smiler_r").to_json() == default_vector_set().to_json()


def test_numbers_change_on_both_sides() -> None:
    after = with_numbers(default_vector_set(), "zygomaticus_major_l", {"half_angle": 20.0})
    assert _named(after, "zygomaticus_major_r").half_angle == 20.0


@pytest.mark.parametrize(
    ("act", "sentence"),
    [
        (lambda v: moved_end(v, "biceps_l", "origin", HEAD), "there is no muscle 'biceps_l'"),
        (lambda v: moved_end(v, "zygomaticus_major_l", "name", HEAD), "has no 'name' to move"),
        (lambda v: moved_end(v, "zygomaticus_major_l", "origin", HEAD * np.nan), "three finite"),
        (lambda v: with_numbers(v, "zygomaticus_major_l", {"colour": 1.0}), "has no 'colour'"),
        (lambda v: added(v, "Smile!", HEAD, TAIL), "use small letters"),
        (lambda v: added(v, "smile_l", HEAD, TAIL), "leave out the side"),
        (lambda v: added(v, "zygomaticus_major", HEAD, TAIL), "is taken"),
        (lambda v: removed(v, "biceps_l"), "there is no muscle"),
    ],
)
def test_what_cannot_be_is_refused(act, sentence: str) -> None:
    with pytest.raises(ParameterError, match=sentence):
        act(default_vector_set())
