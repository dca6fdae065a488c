from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from risorius.errors import ParameterError
from risorius.vectormuscle.combine import combine
from risorius.vectormuscle.kinds import SheetMuscle
from risorius.vectormuscle.muscle import KINDS
from risorius.vectormuscle.wrinkle import (
    BoundWrinkles,
    Wrinkles,
    WrinkleZone,
    bind_all_wrinkles,
    bind_wrinkles,
    raise_wrinkles,
    wrinkle_field,
)
from tests.vectormuscle.patches import context, linear, local_maxima, patch

FINE = patch(41, 121, step=0.5)
SEEN = context(FINE)
MUSCLES = {
    "linear": linear(wrinkles=Wrinkles()),
    "sheet": SheetMuscle(
        "sheet", np.array([0.0, -8.0, 0.0]), np.array([0.0, -48.0, 0.0]), 9.0, 8.0,
        wrinkles=Wrinkles(),
    ),
}  # fmt: skip
MIDDLE = np.isclose(FINE.positions[:, 0], 0.0)


def _height(muscle, contraction: float = 1.0) -> np.ndarray:
    """Return the height (rows,) along the middle of the patch."""
    bound = bind_wrinkles(muscle, muscle.wrinkles, SEEN, faces=FINE.faces)
    assert isinstance(bound, BoundWrinkles)
    raised = raise_wrinkles([(bound, contraction)], FINE.vertex_count)
    return np.zeros(MIDDLE.sum()) if raised is None else raised[MIDDLE, 2]


@pytest.mark.parametrize("kind", MUSCLES)
@pytest.mark.parametrize("count", [1, 3, 4])
def test_there_are_as_many_ridges_as_asked_for(kind: str, count: int) -> None:
    muscle = replace(MUSCLES[kind], wrinkles=Wrinkles(count=count))
    assert local_maxima(_height(muscle)) == count


@pytest.mark.parametrize("kind", MUSCLES)
def test_at_rest_there_is_none(kind: str) -> None:
    np.testing.assert_array_equal(_height(MUSCLES[kind], 0.0), 0.0)


@pytest.mark.parametrize("kind", MUSCLES)
def test_ridges_grow_with_contraction_and_height(kind: str) -> None:
    whole = _height(MUSCLES[kind])
    np.testing.assert_allclose(_height(MUSCLES[kind], 0.5), 0.5 * whole)
    higher = replace(MUSCLES[kind], wrinkles=Wrinkles(height=0.3))
    np.testing.assert_allclose(_height(higher), 2.0 * whole)


def test_a_ridge_is_as_high_as_its_share_of_the_width() -> None:
    assert _height(MUSCLES["sheet"]).max() == pytest.approx(0.15 * 40.0 / 4.0, rel=1e-3)


def test_each_ridge_is_a_parabola_between_two_valleys() -> None:
    place = np.linspace(-0.2, 1.2, 1401)
    zone = WrinkleZone(place, np.ones_like(place), 20.0)
    height = wrinkle_field(zone, Wrinkles(count=2, height=0.1))
    outside = (place <= 0.0) | (place >= 1.0)
    np.testing.assert_array_equal(height[outside], 0.0)
    phase = 4.0 * place - 1.0
    first = (place > 0.0) & (place < 0.5)
    np.testing.assert_allclose(height[first], (1.0 - phase[first] ** 2), atol=1e-9)
    valley = np.isclose(place, 0.5)
    np.testing.assert_allclose(height[valley], 0.0, atol=1e-9)


def test_the_height_vanishes_at_the_sides_of_the_muscle() -> None:
    bound = bind_wrinkles(MUSCLES["sheet"], Wrinkles(), SEEN, faces=FINE.faces)
    assert isinstance(bound, BoundWrinkles)
    aside = np.abs(FINE.positions[bound.vertices, 0])
    assert aside.max() < 9.0
    assert bound.height[aside > 8.4].max() < 0.03 * bound.height.max()


def test_ridges_rise_along_the_normal_after_the_pull() -> None:
    muscle = MUSCLES["linear"]
    bent = patch(41, 121, step=0.5, bulge=0.01)
    seen = context(bent)
    bound = bind_wrinkles(muscle, Wrinkles(), seen, faces=bent.faces)
    assert isinstance(bound, BoundWrinkles)
    raised = raise_wrinkles([(bound, 1.0)], bent.vertex_count)
    assert raised is not None
    away = np.cross(raised, seen.normals)
    np.testing.assert_allclose(away, 0.0, atol=1e-12)
    flat = combine([(replace(muscle, wrinkles=None).bind(seen), 1.0)], bent.positions)
    pulled = combine([(muscle.bind(seen), 1.0)], bent.positions)
    np.testing.assert_array_equal(pulled, flat)


def test_where_two_muscles_wrinkle_the_higher_ridge_counts_in_any_order() -> None:
    muscles = (MUSCLES["linear"], MUSCLES["sheet"])
    pairs = [
        (bind_wrinkles(muscle, Wrinkles(), SEEN, faces=FINE.faces), share)
        for muscle, share in zip(muscles, (1.0, 0.6))
    ]
    both = raise_wrinkles(pairs, FINE.vertex_count)
    single = [raise_wrinkles([pair], FINE.vertex_count) for pair in pairs]
    np.testing.assert_array_equal(both, np.maximum(*single))
    np.testing.assert_array_equal(raise_wrinkles(pairs[::-1], FINE.vertex_count), both)


def test_muscles_without_contraction_raise_nothing() -> None:
    bound = bind_wrinkles(MUSCLES["sheet"], Wrinkles(), SEEN, faces=FINE.faces)
    assert raise_wrinkles([(bound, 0.0)], FINE.vertex_count) is None
    assert raise_wrinkles([], FINE.vertex_count) is None


@pytest.mark.parametrize("kind", MUSCLES)
def test_a_mesh_too_coarse_for_parabolas_is_told_and_left_out(kind: str) -> None:
    coarse = patch(17, 25, step=3.0)
    bound, notes = bind_all_wrinkles([MUSCLES[kind]], context(coarse), faces=coarse.faces)
    assert bound == {}
    assert len(notes) == 1
    each = {"linear": "2", "sheet": "3.3"}[kind]
    assert notes[0].startswith(f"{MUSCLES[kind].name}: wrinkles left out: the skin has {each} ")
    assert "refine it there or ask for fewer wrinkles" in notes[0]


def test_four_vertices_are_enough_and_three_are_not() -> None:
    sheet = MUSCLES["sheet"]
    for step, shown in ((2.4, True), (2.6, False)):
        mesh = patch(21, 31, step=step)
        bound = bind_wrinkles(sheet, Wrinkles(), context(mesh), faces=mesh.faces)
        assert isinstance(bound, BoundWrinkles) == shown


def test_muscles_that_ask_for_none_get_none() -> None:
    muscles = [linear(), MUSCLES["sheet"]]
    bound, notes = bind_all_wrinkles(muscles, SEEN, faces=FINE.faces)
    assert list(bound) == ["sheet"]
    assert notes == ()


ENTRY = {
    "name": "m", "kind": "linear", "origin": [0, 0, 0], "insertion": [0, -9, 0],
    "start_radius": 8, "finish_radius": 12, "half_angle": 30,
}  # fmt: skip


def test_an_empty_entry_takes_the_defaults() -> None:
    assert KINDS["linear"](ENTRY | {"wrinkles": {}}, "s").wrinkles == Wrinkles()
    assert KINDS["linear"](ENTRY, "s").wrinkles is None


@pytest.mark.parametrize(
    ("value", "message"),
    [
        (4, "wrinkles must be an object"),
        ({"count": 0}, "wrinkles count: 0 is below 1"),
        ({"count": 2.5}, "wrinkles count: 2.5 is not a whole number"),
        ({"count": "some"}, "wrinkles count: 'some' is not a number"),
        ({"height": 0.9}, "wrinkles height: 0.9 is above 0.5"),
        ({"height": float("nan")}, "wrinkles height: nan is not finite"),
    ],
)
def test_a_bad_entry_is_refused_by_place(value: object, message: str) -> None:
    with pytest.raises(ParameterError, match=f"^s: muscle 3: {message}"):
        KINDS["linear"](ENTRY | {"wrinkles": value}, "s: muscle 3")
