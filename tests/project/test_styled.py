"""Projects in a style, and muscles of projects as something to tune."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from risorius.anatomy.mechanics import Mechanics
from risorius.anatomy.template import builtin_head
from risorius.errors import ParameterError
from risorius.layered.muscle_map import default_muscle_map
from risorius.project import Project, face_of, presets_of
from risorius.project.layered import muscle_map_of
from risorius.project.springs import recipe_of
from risorius.project.styled import styled, unknown_of
from risorius.project.tunable import tunable_of
from risorius.springmuscle.recipe_file import recipe_to_json
from risorius.tuning.map_genes import apply_map_genes
from risorius.tuning.style import Style
from tests.tuning.faces import expression

STYLES = {
    "layered": {"corrugator.shortening": 0.7, "corrugator.origin_y": 0.02},
    "springs": {"corrugator.max_contraction": 0.7, "corrugator.origin_y": 0.03},
    "vector": {"corrugator.strength": 0.7, "corrugator.origin_y": 0.02},
}
INTENSITIES = {"anger.procerus": -0.2, "anger.lid_lower": 0.1}
METHOD = pytest.mark.parametrize("method", STYLES)


@METHOD
def test_a_project_wears_the_style_of_its_method(method: str) -> None:
    head, plain = builtin_head(), Project(method=method)
    style = Style({**STYLES[method], **INTENSITIES}, method)
    assert unknown_of(plain, style) == ()
    worn = styled(plain, style, head, source="x")
    anger, before = presets_of(worn).emotions["anger"], presets_of(plain).emotions["anger"]
    assert anger["procerus"] == pytest.approx(before["procerus"] - 0.2)
    assert presets_of(worn).emotions["joy"] == presets_of(plain).emotions["joy"]
    mechanics = Mechanics.build(head)
    weak, strong = (face_of(each, head, mechanics=mechanics) for each in (worn, plain))
    pose = {"corrugator_l": 1.0, "corrugator_r": 1.0}
    share = np.linalg.norm(weak.displace(pose)) / np.linalg.norm(strong.displace(pose))
    assert 0.4 < share < 0.9
    # Muscles that the style does not name are the same.
    other = {"depressor_anguli_l": 1.0, "depressor_anguli_r": 1.0}
    assert np.abs(weak.displace(other) - strong.displace(other)).max() < 0.05


@METHOD
def test_a_style_of_another_method_is_refused_in_one_sentence(method: str) -> None:
    other = "springs" if method != "springs" else "layered"
    style = Style(STYLES[other], other)
    with pytest.raises(ParameterError, match=f"^mine: this style was tuned on .*--method {other}"):
        styled(Project(method=method), style, builtin_head(), source="mine")


@METHOD
def test_parameters_that_nothing_has_are_named(method: str) -> None:
    names = dict.fromkeys(("vomer.reach", "anger.vomer", "bliss.procerus"), 1.0)
    style = Style({**STYLES[method], **INTENSITIES, **names, "anger.lid_lower_l": 0.1}, method)
    assert unknown_of(Project(method=method), style) == tuple(names)


def test_a_map_in_a_style_is_the_tuned_map() -> None:
    style = Style(STYLES["layered"], "layered")
    worn = styled(Project(method="layered"), style, builtin_head(), source="x")
    wanted = apply_map_genes(default_muscle_map(), STYLES["layered"])
    assert muscle_map_of(worn).to_json() == wanted.to_json()
    assert "presets" not in worn.inline


@pytest.mark.parametrize("method", ["layered", "springs"])
def test_what_is_tuned_is_what_the_file_makes(tmp_path: Path, method: str) -> None:
    head = builtin_head()
    project = Project(method=method)
    subject = tunable_of(project, head, mechanics=Mechanics.build(head))
    pose = expression(subject.face, "anger")
    names = subject.muscles(pose)
    assert {"corrugator", "procerus"} <= set(names)
    style = Style({**STYLES[method], "mentalis.stiffness": 1.5}, method)
    candidates = subject.candidates(("corrugator",), pose, style=style, genes="published")
    assert {name.partition(".")[0] for name in candidates.genome.names} == {"corrugator"}
    made = candidates.positions(STYLES[method])
    assert np.abs(made - subject.face_in(style).pose(pose)).max() < 0.05
    path = tmp_path / "tuned.json"
    subject.write(style, path)
    file = {
        "layered": Project(method=method, muscle_map=path),
        "springs": Project(method=method, recipe=path),
    }[method]
    assert np.abs(made - face_of(file, head).pose(pose)).max() < 0.05
    assert np.abs(made - subject.face.pose(pose)).max() > 0.2


def test_a_recipe_in_a_style_keeps_what_the_style_does_not_name() -> None:
    plain = Project(method="springs")
    worn = styled(plain, Style(STYLES["springs"], "springs"), builtin_head(), source="x")
    for before, after in zip(
        recipe_to_json(recipe_of(plain))["muscles"], recipe_to_json(recipe_of(worn))["muscles"]
    ):
        assert (before == after) == (before["name"] != "corrugator")
