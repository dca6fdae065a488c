from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np
import pytest

from risorius.controls.control import resolve_pose
from risorius.controls.fap import faps
from risorius.controls.shape_sets import ShapeList
from risorius.errors import RisoriusWarning
from risorius.head import Head
from risorius.playback import FapReading, FapShapes, solve_fap_shapes
from risorius.playback.bounded_fit import fit_bounded
from risorius.playback.solved_sets import with_solved_sets
from risorius.vectormuscle import VectorFace
from tests.face_fixtures import builtin_face

CHOSEN = (3, 6, 7, 12, 13, 14, 19, 24, 64, 65)


@pytest.fixture(scope="module")
def solved() -> FapShapes:
    return solve_fap_shapes(builtin_face(), numbers=CHOSEN)


def test_a_made_shape_moves_its_point_by_the_units_it_claims(solved: FapShapes) -> None:
    face = builtin_face()
    reading = FapReading.of_head(face.head)
    made = [shape for shape in solved.shapes if shape.made]
    assert len(made) >= 13
    for shape in made:
        values = reading.values(face.displace(shape.pose))
        read = values[reading.numbers.index(shape.number)]
        assert shape.sign * read == pytest.approx(shape.reach)
        assert shape.reach <= 1.02 * shape.bound


def test_shapes_stay_within_the_ranges_of_the_controls(solved: FapShapes) -> None:
    for shape in solved.shapes:
        assert resolve_pose(builtin_face().controls, shape.pose).clamped == ()


def test_parameters_with_one_direction_have_one_shape(solved: FapShapes) -> None:
    signs: dict[int, list[int]] = {}
    for shape in solved.shapes:
        signs.setdefault(shape.number, []).append(shape.sign)
    assert all(signs[n] == ([1] if faps()[n].one_way else [1, -1]) for n in CHOSEN)


def test_what_no_muscle_moves_is_left_out_with_what_it_reaches(solved: FapShapes) -> None:
    assert "fap_65" not in solved.poses()
    assert solved.left_out["fap_65"] == "the face makes 0 of 100 units"
    assert "turn the whole head" in solved.left_out["fap_48"]


def test_left_and_right_parameters_are_solved_as_mirror_images(solved: FapShapes) -> None:
    reach = {shape.name: shape.reach for shape in solved.shapes}
    for left, right in (("fap_6", "fap_7"), ("fap_12", "fap_13"), ("fap_12_neg", "fap_13_neg")):
        assert reach[left] == pytest.approx(reach[right], rel=0.02)


def test_the_set_of_the_thesis_has_no_opposite_directions() -> None:
    shapes = solve_fap_shapes(builtin_face(), numbers=(12,))
    assert list(shapes.poses(thesis=True)) == ["fap_12"]
    assert list(shapes.poses()) == ["fap_12", "fap_12_neg"]


def test_sets_that_need_no_solving_stay_as_they_are() -> None:
    shapes = ShapeList({"joy": {}}, {})
    assert with_solved_sets(shapes, builtin_face(), ("emotions", "facs")) is shapes


def test_a_bounded_fit_meets_the_conditions_of_optimality() -> None:
    rng = np.random.default_rng(3)
    a = rng.normal(size=(30, 12))
    gram, linear = a.T @ a, a.T @ rng.normal(size=30)
    x = fit_bounded(gram, linear, low=np.zeros(12), high=np.full(12, 0.2))
    slope = gram @ x - linear
    inside = (x > 0.0) & (x < 0.2)
    assert np.abs(slope[inside]).max() < 1e-3
    assert (slope[x == 0.0] > -1e-3).all()
    assert (slope[x == 0.2] < 1e-3).all()
    assert (x == 0.0).any()
    assert (x == 0.2).any()


@pytest.mark.real
def test_a_real_head_makes_fifty_of_the_parameters(real_data: Path) -> None:
    path = real_data / "ict_facekit" / "ict_neutral.obj"
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RisoriusWarning)
        face = VectorFace.build(Head.load(path, path.with_name("landmarks.json")))
    solved = solve_fap_shapes(face)
    assert solved.turns == (48, 49, 50)
    assert solved.made_count >= 53
    assert solved.full_count >= 48
    assert solved.bound_count >= 14


def test_the_built_in_head_makes_fifty_of_the_parameters() -> None:
    solved = solve_fap_shapes(builtin_face())
    assert solved.made_count >= 55
    assert solved.full_count >= 47
