from __future__ import annotations

from risorius.controls import arkit_shapes

SHAPES = arkit_shapes()
BY_NAME = {shape.name: shape for shape in SHAPES}


def test_apple_lists_52_different_shapes() -> None:
    assert len(SHAPES) == len(BY_NAME) == 52


def test_the_order_is_apples() -> None:
    names = [shape.name for shape in SHAPES]
    assert names[0] == "eyeBlinkLeft"
    assert names[-1] == "tongueOut"
    families = ("eye", "jaw", "mouth", "brow", "cheek", "nose", "tongue")
    order = [next(i for i, f in enumerate(families) if name.startswith(f)) for name in names]
    assert order == sorted(order)


def test_mirror_shapes_point_at_each_other() -> None:
    for shape in SHAPES:
        assert BY_NAME[shape.mirror].mirror == shape.name


def test_sides_are_written_at_the_end_of_the_name() -> None:
    for shape in SHAPES:
        expected = (
            "left" if shape.name.endswith("Left")
            else "right" if shape.name.endswith("Right")
            else "center"
        )  # fmt: skip
        assert shape.side == expected
        assert (shape.mirror == shape.name) == (shape.side == "center")


def test_the_table_is_read_once() -> None:
    assert arkit_shapes() is SHAPES
