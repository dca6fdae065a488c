"""The outline recipe: portable, mirrored, read and written, refused with the place."""

from __future__ import annotations

import json
from contextlib import suppress

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from risorius.errors import FormatError, LandmarkError, ParameterError
from risorius.springmuscle.measure import REFERENCE_WIDTH, FaceMeasure
from risorius.springmuscle.recipe import (
    MuscleOutline,
    OutlinePoint,
    OutlineRecipe,
    OutlineSettings,
    Ring,
    thickness_at,
)
from risorius.springmuscle.recipe_file import (
    default_recipe,
    parse_recipe,
    read_recipe,
    recipe_text,
    write_recipe,
)
from tests.springmuscle.skins import MARKS

MEASURE = FaceMeasure(MARKS, REFERENCE_WIDTH, 70.0)
NAMES = ("2.1", "2.2", "2.4", "3.7", "4.1", "8.1")
ROWS = (
    (OutlinePoint(("2.2",), (0.1, 0.2, 0.0)), OutlinePoint(("2.2",), (0.2, 0.2, 0.0))),
    (OutlinePoint(("2.4",), (0.1, 0.1, 0.0)), OutlinePoint(("2.4", "2.2"), (0.2, 0.1, 0.0))),
)

_offset = st.tuples(*[st.floats(-3.0, 3.0).map(lambda v: round(v, 4))] * 3)
_names = st.lists(st.sampled_from(NAMES), min_size=1, max_size=3, unique=True).map(tuple)


@st.composite
def _points(draw) -> OutlinePoint:
    names = draw(_names)
    weights = draw(
        st.one_of(
            st.just(()),
            st.tuples(*[st.sampled_from((0.25, 1.5, 3.0))] * len(names)),
        )
    )
    return OutlinePoint(names, draw(_offset), () if len(set(weights)) <= 1 else weights)


@st.composite
def _outlines(draw) -> MuscleOutline:
    count = draw(st.integers(2, 4))
    rows = tuple(tuple(draw(st.lists(_points(), min_size=2, max_size=4))) for _ in range(count))
    round_ = draw(st.booleans())
    shares = tuple(draw(st.lists(st.floats(0, 1), min_size=count, max_size=count)))
    ring = None
    if round_:
        ring = Ring(
            draw(_points()),
            ahead=draw(st.floats(-20, 20)),
            line=draw(st.sampled_from(((), ROWS[0]))),
            turn=0.0,
            around_eye=draw(st.booleans()),
            closed=draw(st.booleans()),
            shares=draw(st.sampled_from(((), shares))),
        )
    settings = OutlineSettings(
        skin=draw(st.sampled_from((None, 2.5, {"3.7": 1.0, "2.1": 4.0}))),
        thickness=draw(st.sampled_from((None, (1.0, 3.0)))),
        radius=draw(st.sampled_from((None, 9.0))),
        max_contraction=draw(st.floats(0, 1)),
        stiffness=draw(st.floats(0, 10)),
        fixed_point=draw(st.floats(0, 1)),
        bulge=draw(st.floats(0, 9)),
        seal=draw(st.booleans()),
        host=draw(st.booleans()),
    )
    kind = "sphincter" if round_ else draw(st.sampled_from(("linear", "sheet", "curved")))
    return MuscleOutline(
        draw(st.text("abcdefg_", min_size=1)), kind, rows, mirror=draw(st.booleans()),
        control=draw(st.sampled_from(("", "risorius"))), ring=ring, settings=settings,
    )  # fmt: skip


@given(outline=_outlines())
def test_what_is_written_is_read_again(outline: MuscleOutline) -> None:
    recipe = OutlineRecipe((outline,))
    text = recipe_text(recipe)
    assert parse_recipe(json.loads(text), source="again") == recipe
    assert recipe_text(parse_recipe(json.loads(text), source="again")) == text


def test_files_are_written_whole_and_read_back(tmp_path) -> None:
    path = tmp_path / "mine.recipe.json"
    write_recipe(default_recipe(), path)
    first = path.read_bytes()
    assert read_recipe(path) == default_recipe()
    write_recipe(read_recipe(path), path)
    assert path.read_bytes() == first
    with pytest.raises(FormatError, match=r"absent\.json"):
        read_recipe(tmp_path / "absent.json")


@given(point=_points())
def test_mirroring_twice_is_nothing_and_once_is_the_mirror_image(point: OutlinePoint) -> None:
    assert point.mirrored().mirrored() == point
    places = {name: np.array([k + 1.0, 3.0 * k, -k]) for k, name in enumerate(NAMES)}
    flipped = {
        OutlinePoint((name,)).mirrored().anchors[0]: place * [-1.0, 1.0, 1.0]
        for name, place in places.items()
    }
    left = point.place(FaceMeasure(places, 90.0, 70.0))
    right = point.mirrored().place(FaceMeasure(flipped, 90.0, 70.0))
    assert np.abs(left * [-1.0, 1.0, 1.0] - right).max() < 1e-9


@given(size=st.floats(0.1, 10.0), point=_points())
def test_outlines_scale_with_the_face(size: float, point: OutlinePoint) -> None:
    places = {name: np.array([k + 1.0, 3.0 * k, -k]) for k, name in enumerate(NAMES)}
    large = {name: size * place for name, place in places.items()}
    small = point.place(FaceMeasure(places, 90.0, 70.0))
    assert np.abs(point.place(FaceMeasure(large, 90 * size, 70 * size)) - size * small).max() < (
        1e-9 * size * 1000
    )


def test_weights_of_anchors_count() -> None:
    point = OutlinePoint(("3.7", "3.12"), weights=(3.0, 1.0))
    assert np.abs(point.place(MEASURE) - [0.25 * REFERENCE_WIDTH, 0.0, -30.0]).max() < 1e-12


def test_paired_muscles_have_sided_names_and_controls_and_single_controls_stay() -> None:
    outline = MuscleOutline("risorius", "linear", ROWS)
    left, right = OutlineRecipe((outline,)).sided()
    assert (left.name, left.control) == ("risorius_l", "risorius_l")
    assert (right.name, right.control) == ("risorius_r", "risorius_r")
    assert right.rows[1][0].anchors == ("2.5",)
    halves = OutlineRecipe((MuscleOutline("procerus", "linear", ROWS, control="procerus"),)).sided()
    assert [half.control for half in halves] == ["procerus", "procerus"]
    single = OutlineRecipe((MuscleOutline("chin", "linear", ROWS, mirror=False),)).sided()
    assert [(one.name, one.control) for one in single] == [("chin", "chin")]


def test_the_thickness_of_a_map_is_met_at_its_landmarks_and_between_inside_its_range() -> None:
    thickness = {"3.7": 1.0, "2.1": 4.0, "9.9": 77.0}
    places = np.array([MARKS["3.7"], MARKS["2.1"], [5.0, -50.0, 0.0]])
    found = thickness_at(thickness, places, MEASURE)
    assert np.abs(found[:2] - [1.0, 4.0]).max() < 1e-4
    assert 1.0 < found[2] < 4.0
    assert (thickness_at(2.5, places, MEASURE) == 2.5).all()
    with pytest.raises(LandmarkError, match="none of the map of thickness"):
        thickness_at({"8.8": 1.0}, places, MEASURE)


def test_a_muscle_is_found_by_name_or_the_names_are_told() -> None:
    assert default_recipe().outline("risorius_l").name == "risorius_l"
    with pytest.raises(ParameterError, match=r"no muscle 'risorious'; there are .*risorius_l"):
        default_recipe().outline("risorious")
    changed = default_recipe().replaced(MuscleOutline("risorius", "linear", ROWS))
    assert changed.outline("risorius_l").rows == ROWS
    with pytest.raises(ParameterError, match="has no thigh to replace"):
        default_recipe().replaced(MuscleOutline("thigh", "linear", ROWS))


def test_the_default_recipe_covers_the_face() -> None:
    names = [outline.name for outline in default_recipe().muscles if outline.mirror]
    assert len(names) >= 11
    single = [outline.name for outline in default_recipe().muscles if not outline.mirror]
    assert "orbicularis_oris" in single
    assert "orbicularis_oculi" in names
    kinds = {outline.kind for outline in default_recipe().muscles}
    assert kinds == {"linear", "sheet", "curved", "sphincter"}


def _document(**changes) -> dict:
    muscle = {
        "name": "m",
        "kind": "linear",
        "rows": [[["2.2", 0, 0, 0], ["2.4"]], [["2.2+2.4*2", 0, 1, 0], ["2.4", 0, 1, 0]]],
    }
    muscle.update(changes)
    muscle = {key: value for key, value in muscle.items() if value is not None}
    return {"schema": "risorius/outline-recipe", "version": 1, "muscles": [muscle]}


REFUSED = [
    ({"kind": "round"}, FormatError, r"muscle 0 \(m\)\.kind: 'round' is not one of linear, sheet"),
    ({"name": None}, FormatError, r"muscle 0\.name: is missing"),
    ({"rows": []}, ParameterError, r"outline m: has 0 row\(s\), at least 2"),
    ({"rows": [[["2.2"]], [["2.2"], ["2.4"]]]}, ParameterError, r"row 0 has 1 point\(s\)"),
    ({"rows": [1, 2]}, FormatError, r"rows\[0\]: expected a list of points"),
    ({"rows": [[["2.2", 1], ["2.2"]]]}, FormatError, r"rows\[0\]\[0\]: expected \[\"landmark"),
    ({"rows": [[["nose"], ["2.2"]]]}, FormatError, r"rows\[0\]\[0\]: nose is no landmark"),
    ({"rows": [[["2.2*x"], ["2.2"]]]}, ParameterError, r"'x' is not a number"),
    ({"rows": [[["2.2", 0, "a", 0], ["2.2"]]]}, FormatError, r"\[0\]\[0\]: expected a number"),
    ({"kind": "sphincter"}, FormatError, r"centre: is missing; a sphincter needs one"),
    (
        {"kind": "sphincter", "centre": ["2.2"], "line": [["2.2"]]},
        FormatError,
        "left and the right",
    ),
    (
        {"kind": "sphincter", "centre": ["2.2"], "shares": [1]},
        ParameterError,
        "1 shares for 2 rows",
    ),
    ({"thickness": [3, 1]}, ParameterError, r"thickness: \[3, 1\] must be least and most"),
    ({"skin": {"nose": 2}}, FormatError, r"map of landmarks to thickness; nose is no landmark"),
    ({"skin": -1}, ParameterError, r"skin: -1 is below 0"),
    ({"max_contraction": 1.5}, ParameterError, r"max_contraction: 1\.5 is above 1"),
    ({"mirror": "yes"}, FormatError, r"mirror: expected true or false"),
    ({"radius": 900}, ParameterError, r"radius: 900 is above 50"),
]


@pytest.mark.parametrize(("changes", "error", "message"), REFUSED, ids=lambda v: str(v)[:30])
def test_bad_muscles_are_refused_with_their_place(changes, error, message) -> None:
    with pytest.raises(error, match=message) as caught:
        parse_recipe(_document(**changes), source="mine.json")
    assert "mine.json" in str(caught.value)


def test_foreign_files_and_newer_versions_are_refused() -> None:
    with pytest.raises(FormatError, match="risorius/outline-recipe"):
        parse_recipe({"schema": "risorius/muscle-map", "version": 1}, source="mine.json")
    with pytest.raises(FormatError, match="update risorius"):
        parse_recipe({**_document(), "version": 2}, source="mine.json")
    with pytest.raises(FormatError, match="at least one muscle"):
        parse_recipe({**_document(), "muscles": []}, source="mine.json")
    with pytest.raises(ParameterError, match="m_l, m_r is there twice"):
        twice = _document()
        parse_recipe({**twice, "muscles": twice["muscles"] * 2}, source="mine.json")


def test_a_face_that_contradicts_itself_is_refused() -> None:
    from risorius.landmarks.landmark_set import Landmark, LandmarkSet

    points = np.array([[45.0, 0, 0], [-45.0, 0, 0], [0.0, 2.0, 0.0], [0.0, 2.0, 0.0]])
    marks = [Landmark(n, (k,), (1.0,)) for k, n in enumerate(("3.7", "3.12", "2.2", "2.3"))]
    with pytest.raises(LandmarkError, match=r"the mouth \(2\.2, 2\.3\) lies -2\.0 mm below"):
        FaceMeasure.of(LandmarkSet(marks, points))


_json = st.recursive(
    st.one_of(st.none(), st.booleans(), st.floats(), st.integers(), st.text(max_size=6)),
    lambda inner: st.one_of(
        st.lists(inner, max_size=4),
        st.dictionaries(
            st.sampled_from(("name", "kind", "rows", "centre", "line", "skin", "shares", "2.2")),
            inner,
            max_size=5,
        ),
    ),
    max_leaves=20,
)


@given(entry=_json, kind=st.sampled_from(("linear", "sphincter")), rows=_json, centre=_json)
def test_whatever_stands_in_a_file_is_read_or_refused(entry, kind, rows, centre) -> None:
    muscles = [entry, {"name": "m", "kind": kind, "rows": rows, "centre": centre}]
    for muscle in muscles:
        document = {"schema": "risorius/outline-recipe", "version": 1, "muscles": [muscle]}
        with suppress(FormatError, ParameterError):
            parse_recipe(document, source="fuzz")
