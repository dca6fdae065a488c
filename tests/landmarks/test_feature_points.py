from __future__ import annotations

import pytest

from risorius.landmarks import feature_points, mirror_name

TABLE = feature_points()


def test_the_table_holds_all_84_points_of_the_standard_and_the_condyles() -> None:
    standard = [name for name in TABLE if name[0].isdigit()]
    groups = {2: 14, 3: 14, 4: 6, 5: 4, 6: 4, 7: 1, 8: 10, 9: 15, 10: 10, 11: 6}
    assert standard == [f"{g}.{i}" for g, count in groups.items() for i in range(1, count + 1)]
    assert set(TABLE) - set(standard) == {"condyle_l", "condyle_r"}


def test_mirroring_twice_returns_to_the_same_point() -> None:
    for name in TABLE:
        assert mirror_name(mirror_name(name)) == name


def test_a_point_and_its_mirror_lie_on_opposite_sides() -> None:
    opposite = {"left": "right", "right": "left", "centre": "centre"}
    for point in TABLE.values():
        assert TABLE[point.mirror].side == opposite[point.side]
        assert (point.mirror == point.name) == (point.side == "centre")


def test_a_point_and_its_mirror_lie_on_the_same_kind_of_part() -> None:
    for point in TABLE.values():
        mirrored = point.part.replace("left", "*").replace("right", "left").replace("*", "right")
        assert TABLE[point.mirror].part == mirrored


def test_descriptions_speak_of_the_side_that_the_table_gives() -> None:
    for point in TABLE.values():
        for side in ("left", "right"):
            # Inner eye corners are described by the eye, so the word is always the own side.
            if side in point.description.split():
                assert point.side == side


@pytest.mark.parametrize(
    ("name", "side"),
    [("3.7", "left"), ("3.11", "left"), ("3.8", "right"), ("3.12", "right"), ("8.10", "left")],
)
def test_odd_and_even_numbers_are_no_rule_for_sides(name: str, side: str) -> None:
    assert TABLE[name].side == side


def test_an_unknown_name_is_its_own_mirror() -> None:
    assert mirror_name("wart") == "wart"


def test_the_table_cannot_be_changed() -> None:
    with pytest.raises(TypeError):
        TABLE["2.1"] = TABLE["2.2"]  # pyright: ignore
