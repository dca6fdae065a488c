"""Projects bind the spring-muscle face: recipe, bones, parameters."""

from __future__ import annotations

from pathlib import Path

import pytest

from risorius.anatomy.mechanics import Mechanics
from risorius.anatomy.template import builtin_head
from risorius.errors import FormatError, ParameterError
from risorius.project import Project, face_of, read_project, write_project
from risorius.project.springs import recipe_of, spring_face
from risorius.springmuscle.face import SpringFace
from risorius.springmuscle.recipe import OutlineRecipe
from risorius.springmuscle.recipe_file import default_recipe, recipe_text, write_recipe
from tests.springmuscle.faces import builtin_mechanics

HEAD = builtin_head()


def _short() -> OutlineRecipe:
    wanted = ("zygomaticus_major", "frontalis_inner")
    return OutlineRecipe(tuple(m for m in default_recipe().muscles if m.name in wanted))


def _mechanics() -> Mechanics:
    return builtin_mechanics()


def test_the_method_and_the_profile_choose_the_face(tmp_path: Path) -> None:
    write_recipe(_short(), tmp_path / "two.json")
    for profile, carried in (("improved", True), ("faithful", False)):
        project = Project(method="springs", profile=profile, recipe=tmp_path / "two.json")
        face = face_of(project, HEAD, mechanics=_mechanics())
        assert isinstance(face, SpringFace)
        assert face.parameters.carried is carried
        names = {muscle.name for muscle in face.muscles.muscles}
        assert names == {f"{m.name}_{side}" for m in _short().muscles for side in "lr"}


def test_a_recipe_may_stand_in_the_project_itself(tmp_path: Path) -> None:
    import json

    recipe = json.loads(recipe_text(_short()))
    project = Project(method="springs", bones="cut", inline={"recipe": recipe})
    write_project(project, tmp_path / "p.json")
    again = read_project(tmp_path / "p.json")
    assert again == project
    assert recipe_of(again) == _short()
    with pytest.raises(FormatError, match="recipe"):
        recipe_of(Project(inline={"recipe": {"schema": "risorius/style"}}))


def test_parameters_go_on_top_of_the_profile(tmp_path: Path) -> None:
    write_recipe(_short(), tmp_path / "two.json")
    parameters = {"muscle_stiffness": 0.2, "relaxation": 3.0}
    project = Project(method="springs", recipe=tmp_path / "two.json", parameters=parameters)
    face = face_of(project, HEAD, mechanics=_mechanics())
    assert isinstance(face, SpringFace)
    assert face.parameters.muscle_stiffness == 0.2
    assert face.parameters.relaxation == 3


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"parameters": {"speed": 1.0}}, "the method 'springs' has no 'speed'; it has pretension"),
        ({"parameters": {"pretension": 1.0}}, "pretension: 1 must be below 1"),
        ({"parameters": {"relaxation": 2.5}}, "parameters: relaxation: 2.5 is not a whole number"),
        ({"parameters": {"grip": "much"}}, "'much' is not a number"),
        ({"bones": "given"}, "'given' needs a skull; name it with --skull"),
        ({"bones": "cut", "skull": Path("s.ply")}, "'cut' to the bones makes no use of it"),
        ({"skull": Path("s.ply")}, "needs bone landmarks"),
        ({"skull_landmarks": Path("s.json")}, "makes no use of it"),
    ],
)
def test_what_does_not_fit_is_refused(changes: dict[str, object], sentence: str) -> None:
    with pytest.raises(ParameterError) as caught:
        spring_face(Project(method="springs", **changes), HEAD, _mechanics())
    assert sentence in str(caught.value)


def test_a_way_to_the_bones_that_does_not_exist_is_refused() -> None:
    with pytest.raises(ParameterError, match="bones"):
        Project(bones="own")
