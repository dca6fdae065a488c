"""Taking fields out of parsed JSON."""

import pytest

from risorius.errors import FormatError
from risorius.io.json_fields import LARGEST_INDEX, Fields

FIELDS = Fields(
    {"n": 3, "f": 2.0, "x": 0.5, "s": "text", "l": [1, 2.5], "t": ["a"], "o": {"k": 1}, "z": None},
    "a.json",
)


def test_fields_come_out_with_their_types():
    assert FIELDS.integer("n") == FIELDS.integer("absent", default=3) == 3
    assert FIELDS.integer("f") == 2
    assert FIELDS.number("x") == FIELDS.number("absent", default=0.5) == 0.5
    assert FIELDS.text("s") == FIELDS.text("absent", default="text") == "text"
    assert FIELDS.numbers("l", 2) == [1.0, 2.5]
    assert FIELDS.texts("t") == ["a"]
    assert FIELDS.fields("o").integer("k") == 1
    assert FIELDS.items("absent") == FIELDS.texts("absent") == list(FIELDS.fields("absent")) == []
    assert "n" in FIELDS
    assert "z" not in FIELDS


@pytest.mark.parametrize(
    ("take", "message"),
    [
        (lambda: FIELDS.integer("absent"), "a.json: absent: is missing"),
        (lambda: FIELDS.integer("z"), "a.json: z: is missing"),
        (lambda: FIELDS.integer("x"), "a.json: x: expected a whole number"),
        (lambda: FIELDS.integer("n", low=4), f"a.json: n: must lie in 4..{LARGEST_INDEX}"),
        (lambda: FIELDS.number("s"), "a.json: s: expected a number"),
        (lambda: FIELDS.text("n"), "a.json: n: expected a text"),
        (lambda: FIELDS.items("n"), "a.json: n: expected a list"),
        (lambda: FIELDS.numbers("l", 3), "a.json: l: expected a list of 3 numbers"),
        (lambda: FIELDS.texts("l"), "a.json: l: expected a list of texts"),
        (lambda: FIELDS.fields("l"), "a.json: l: expected a JSON object"),
        (lambda: FIELDS.fields("o").text("k"), "a.json: o.k: expected a text"),
        (lambda: Fields({"b": True}, "a").integer("b"), "a: b: expected a whole number"),
        (lambda: Fields({"b": 1e300}, "a").number("b"), "a: b: must lie within 3e+38"),
        (lambda: Fields([], "a"), "a: expected a JSON object"),
    ],
)
def test_a_wrong_type_is_refused_with_its_place(take, message):
    with pytest.raises(FormatError) as caught:
        take()
    assert str(caught.value) == message
