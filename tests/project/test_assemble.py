"""From a project to head, recipes and face."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from risorius import VectorFace, builtin_head
from risorius.cli.options import Method, Profile
from risorius.controls.presets import default_presets
from risorius.errors import FormatError, LandmarkError, ParameterError
from risorius.landmarks import LandmarkSpec
from risorius.project import (
    METHODS,
    PROFILES,
    Project,
    face_of,
    landmarks_of,
    presets_of,
    read_mesh,
    read_presets,
    read_vector_set,
    vectors_of,
)
from risorius.project.assemble import BUILDERS
from risorius.vectormuscle import default_vector_set

MARK = {"2.1": LandmarkSpec(vertex=7)}


def _head(folder: Path) -> Path:
    path = folder / "head.obj"
    path.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    return path


def _marks(path: Path, vertex: int) -> Path:
    table = {"2.1": {"vertex": vertex}}
    path.write_text(json.dumps({"schema": "risorius/landmarks", "version": 1, "landmarks": table}))
    return path


def test_the_built_in_head_brings_its_landmarks() -> None:
    mesh, carried = read_mesh(Project())
    assert mesh.vertex_count == builtin_head().vertex_count
    assert landmarks_of(Project(), carried) == carried
    assert "2.1" in carried


def test_given_landmarks_go_before_carried_ones_and_those_before_a_file_beside(
    tmp_path: Path,
) -> None:
    head = _head(tmp_path)
    _marks(tmp_path / "head.landmarks.json", 1)
    given = _marks(tmp_path / "given.json", 2)
    assert landmarks_of(Project(head=head), {})["2.1"].vertex == 1
    assert landmarks_of(Project(head=head), MARK)["2.1"].vertex == 7
    assert landmarks_of(Project(head=head, landmarks=given), MARK)["2.1"].vertex == 2


def test_a_head_without_any_landmarks_is_refused_with_the_way_out(tmp_path: Path) -> None:
    with pytest.raises(LandmarkError, match="give a landmark file with --landmarks FILE"):
        landmarks_of(Project(head=_head(tmp_path)), {})


def test_recipes_that_ship_are_taken_unless_others_are_named(tmp_path: Path) -> None:
    assert presets_of(Project()) is default_presets()
    assert vectors_of(Project()) is default_vector_set()
    path = tmp_path / "v.json"
    path.write_text(json.dumps(default_vector_set().to_json()))
    other = vectors_of(Project(vector_set=path))
    assert [m.name for m in other.muscles] == [m.name for m in default_vector_set().muscles]


@pytest.mark.parametrize("reader", [read_presets, read_vector_set])
def test_a_recipe_of_another_kind_is_refused(tmp_path: Path, reader) -> None:
    with pytest.raises(FormatError, match='found "risorius/landmarks"'):
        reader(_marks(tmp_path / "m.json", 1))
    with pytest.raises(FormatError, match="no such file"):
        reader(tmp_path / "none.json")


def test_parameters_go_on_top_of_the_profile() -> None:
    project = Project(method="vector", profile="faithful", parameters={"steps": 3.0})
    face = face_of(project, builtin_head())
    assert isinstance(face, VectorFace)
    assert face.parameters.steps == 3
    assert face.parameters.angular == "published"


@pytest.mark.parametrize(
    ("parameters", "sentence"),
    [
        ({"speed": 1.0}, "the method 'vector' has no 'speed'; it has angular, steps"),
        ({"steps": 0.0}, "parameters: steps: 0 is below 1"),
        ({"steps": 2.5}, "parameters: steps: 2.5 is not a whole number"),
        ({"support": 2.0}, "parameters: support: 2 is above 1"),
        ({"support": "much"}, "'much' is not a number"),
        ({"angular": "round"}, "'round' is not one of"),
    ],
)
def test_a_parameter_that_does_not_exist_or_fit_is_refused(parameters, sentence: str) -> None:
    with pytest.raises(ParameterError) as caught:
        face_of(Project(method="vector", parameters=parameters), builtin_head())
    assert sentence in str(caught.value)


def test_every_method_has_a_builder_and_a_word_on_the_command_line() -> None:
    assert tuple(BUILDERS) == METHODS == tuple(method.value for method in Method)
    assert tuple(profile.value for profile in Profile) == PROFILES
