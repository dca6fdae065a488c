from __future__ import annotations

import copy
import json

import numpy as np
import pytest

from risorius.anatomy.template import SURE_LANDMARKS, builtin_head
from risorius.controls import MUSCLES, SINGLE_MUSCLES, sided
from risorius.errors import FormatError, LandmarkError, ParameterError, RisoriusWarning
from risorius.head import Head
from risorius.vectormuscle import default_vector_set, parse_vector_set
from tests.face_fixtures import made_up_head
from tests.synthetic import assemble, head_pieces, head_specs

SET = default_vector_set()
DATA = SET.to_json()
SMALL = {
    "schema": "risorius/vector-set",
    "version": 1,
    "landmarks": {"2.1": [0.0, -110.0, 80.0]},
    "muscles": [
        {
            "name": "pull",
            "kind": "linear",
            "mirror": True,
            "origin": [30.0, 0.0, 60.0],
            "insertion": [20.0, -50.0, 80.0],
            "start_radius": 40.0,
            "finish_radius": 60.0,
            "half_angle": 30.0,
        }
    ],
}


def _with(**muscle: object) -> dict:
    data = copy.deepcopy(SMALL)
    data["muscles"][0] |= muscle
    return data


PAIRED = [name for name in MUSCLES if f"{name}_l" in {muscle.name for muscle in SET.muscles}]


def test_every_muscle_of_the_default_set_is_registered_and_both_sides_are_there() -> None:
    names = {muscle.name for muscle in SET.muscles}
    assert len(PAIRED) >= 9
    expected = {full for name in PAIRED for full in sided(name)} | (set(SINGLE_MUSCLES) & names)
    assert names == expected


def test_left_and_right_muscles_are_mirror_images() -> None:
    by_name = {muscle.name: muscle for muscle in SET.muscles}
    for name in PAIRED:
        left, right = (by_name[full] for full in sided(name))
        assert left.mirrored().to_json() == right.to_json()
        assert right.mirrored().to_json() == left.to_json()


def test_a_set_survives_its_file() -> None:
    again = parse_vector_set(json.loads(json.dumps(DATA)), source="again")
    assert again.to_json() == DATA


def test_the_set_is_drawn_on_the_built_in_head() -> None:
    head = builtin_head()
    fitted = SET.fitted(head)
    assert set(SET.landmarks) >= set(SURE_LANDMARKS)
    shift = SET.landmarks["2.1"] - head.landmarks.position("2.1")
    for before, after in zip(SET.muscles, fitted.muscles):
        a, b = (m.to_json() for m in (before, after))
        ends = [key for key in ("origin", "insertion", "centre") if key in a]
        assert ends
        for key in ends:
            assert np.linalg.norm(np.subtract(a[key], b[key]) - shift) < 3.0, before.name


def test_fitting_twice_is_fitting_once() -> None:
    head = made_up_head()
    once = SET.fitted(head)
    twice = once.fitted(head)
    for first, second in zip(once.muscles, twice.muscles):
        a, b = first.to_json(), second.to_json()
        for key in ("origin", "insertion", "centre"):
            if key in a:
                np.testing.assert_allclose(b[key], a[key], atol=2e-3)


def test_a_fitted_set_stays_symmetric() -> None:
    by_name = {muscle.name: muscle for muscle in SET.fitted(made_up_head()).muscles}
    for name in PAIRED:
        left, right = (by_name[full].to_json() for full in sided(name))
        for key in ("origin", "insertion", "centre"):
            if key in left:
                mirrored = np.multiply(right[key], [-1.0, 1.0, 1.0])
                np.testing.assert_allclose(mirrored, left[key], atol=5e-3)


def test_mirror_makes_two_muscles_of_one_entry() -> None:
    left, right = parse_vector_set(SMALL, source="s").muscles
    assert (left.name, right.name) == ("pull_l", "pull_r")
    single = parse_vector_set(_with(mirror=False), source="s").muscles
    assert [muscle.name for muscle in single] == ["pull"]


def test_a_head_with_too_few_landmarks_is_refused() -> None:
    keep = ("3.7", "3.8", "3.11", "3.12", "2.1", "9.3")
    specs = {name: spec for name, spec in head_specs().items() if name in keep}
    head = Head.from_mesh(assemble({"skin": head_pieces()["skin"]}), specs)
    with pytest.raises(LandmarkError, match=r"6 in common .*, 8 are needed; add some of 2"):
        SET.fitted(head)


@pytest.mark.parametrize(
    ("data", "message"),
    [
        ({}, '^s: expected "schema": "risorius/vector-set", found null'),
        (SMALL | {"schema": "other"}, '^s: expected "schema": "risorius/vector-set", found'),
        (
            SMALL | {"version": 2},
            "^s: written in version 2 of risorius/vector-set",
        ),
        (SMALL | {"muscles": {}}, r"^s: needs 'landmarks' \(object\) and 'muscles' \(list\)"),
        (SMALL | {"landmarks": []}, r"^s: needs 'landmarks' \(object\) and 'muscles' \(list\)"),
        (SMALL | {"muscles": ["x"]}, "^s: muscle 0: must be an object with a 'name'"),
        (SMALL | {"muscles": [{}]}, "^s: muscle 0: must be an object with a 'name'"),
        (_with(kind="spiral"), r"^s: muscle 0 \(pull\): kind 'spiral' is not one of linear, roll"),
        (_with(kind=None), r"^s: muscle 0 \(pull\): kind None is not one of linear, roll, sheet"),
        (SMALL | {"muscles": SMALL["muscles"] * 2}, "^s: pull_l, pull_r is listed twice"),
    ],
)
def test_a_file_that_breaks_the_schema_is_refused(data: dict, message: str) -> None:
    with pytest.raises(FormatError, match=message):
        parse_vector_set(data, source="s")


def test_a_landmark_that_is_no_place_is_refused() -> None:
    data = SMALL | {"landmarks": {"2.1": [0.0, "low", 3.0]}}
    with pytest.raises(ParameterError, match=r"^s: landmarks: 2\.1 must be three finite numbers"):
        parse_vector_set(data, source="s")


def test_a_number_out_of_range_is_refused_with_the_muscle() -> None:
    with pytest.raises(ParameterError, match="muscle pull_l: finish_radius must be above 0"):
        parse_vector_set(_with(finish_radius=-1.0), source="s")


def test_what_means_nothing_in_a_vector_set_is_named() -> None:
    with pytest.warns(RisoriusWarning, match="mine: muscels means nothing in a vector set"):
        parse_vector_set({**DATA, "muscels": []}, source="mine")
