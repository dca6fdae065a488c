"""Genes of spring muscles."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest

from risorius.errors import ParameterError
from risorius.springmuscle.face import SpringFace
from risorius.springmuscle.recipe import OutlineRecipe
from risorius.springmuscle.recipe_file import default_recipe, parse_recipe, recipe_to_json
from risorius.tuning.outline_genes import (
    OutlineCandidates,
    apply_outline_genes,
    outline_muscles,
    outline_parameters,
)
from tests.tuning.faces import builtin_springs, expression, values_at

RECIPE = default_recipe()
NAMES = tuple(outline.name for outline in RECIPE.muscles)
ALL = outline_parameters(RECIPE, NAMES, genes="all")


def _genes(name: str) -> set[str]:
    return {each.name.partition(".")[2] for each in outline_parameters(RECIPE, [name])}


def test_a_muscle_has_its_outline_depth_thickness_contraction_radius_and_hold() -> None:
    plain = {"skin", "thickness", "max_contraction", "radius", "stiffness"}
    ends = {"origin_x", "origin_y", "insertion_x", "insertion_y"}
    assert _genes("zygomaticus_major") == plain | ends
    everything = {each.name for each in outline_parameters(RECIPE, ["platysma"], genes="all")}
    assert {"platysma.fixed_point", "platysma.bulge"} <= everything


def test_a_ring_on_the_midline_stays_there_and_one_of_a_side_does_not() -> None:
    assert "centre_y" in _genes("orbicularis_oris")
    assert "centre_x" not in _genes("orbicularis_oris")
    assert {"centre_x", "centre_y"} <= _genes("orbicularis_oculi")
    assert "turn" in _genes("orbicularis_oris_upper")
    assert "ahead" in _genes("orbicularis_oris")


def test_neutral_genes_leave_the_same_outlines() -> None:
    start = {each.name: each.start for each in ALL}
    tuned = apply_outline_genes(RECIPE, start)
    assert all(a is b for a, b in zip(tuned.muscles, RECIPE.muscles))


@pytest.mark.parametrize("share", [0.0, 0.35, 1.0])
def test_every_value_in_bounds_is_a_recipe_that_its_file_keeps(share: float) -> None:
    tuned = apply_outline_genes(RECIPE, values_at(ALL, share))
    again = parse_recipe(recipe_to_json(tuned), source="tuned")
    assert json.dumps(recipe_to_json(again)) == json.dumps(recipe_to_json(tuned))
    assert all(a is not b for a, b in zip(tuned.muscles, RECIPE.muscles))


def test_ends_shift_in_units_of_the_face_and_rows_between_follow() -> None:
    values = {"zygomaticus_major.origin_y": 0.06, "zygomaticus_major.insertion_x": -0.04}
    before = RECIPE.outline("zygomaticus_major_l")
    after = apply_outline_genes(RECIPE, values).outline("zygomaticus_major_l")
    for row, (old, new) in enumerate(zip(before.rows, after.rows)):
        along = row / (len(before.rows) - 1)
        shift = np.array([n.offset for n in new]) - [o.offset for o in old]
        assert np.allclose(shift, [-0.04 * along, 0.06 * (1.0 - along), 0.0])


def test_the_right_side_is_the_mirror_image_of_the_left() -> None:
    tuned = apply_outline_genes(RECIPE, values_at(ALL, 0.8))
    for outline in tuned.muscles:
        if outline.mirror:
            assert outline.sided(-1).mirrors(outline.sided(1))


def test_what_an_outline_leaves_open_is_taken_from_the_fit() -> None:
    plain = RECIPE.outline("mentalis_l").settings
    assert plain.radius is None and plain.thickness is None and plain.skin is None
    values = {"mentalis.radius": 0.8, "mentalis.thickness": 0.9, "mentalis.skin": 1.2}
    tuned = apply_outline_genes(RECIPE, values).outline("mentalis_l").settings
    assert tuned.radius == pytest.approx(0.8 * 14.0)
    assert tuned.thickness == pytest.approx((0.9, 3.6))
    assert tuned.skin == pytest.approx(2.4)


def test_a_map_of_skin_is_scaled_at_every_landmark() -> None:
    outline = next(each for each in RECIPE.muscles if each.name == "mentalis")
    settings = replace(outline.settings, skin={"2.1": 3.0, "2.3": 1.5})
    recipe = OutlineRecipe((replace(outline, settings=settings),))
    tuned = apply_outline_genes(recipe, {"mentalis.skin": 0.8}).muscles[0].settings.skin
    assert tuned == pytest.approx({"2.1": 2.4, "2.3": 1.2})


def test_an_expression_names_its_muscles() -> None:
    pose = {"zygomaticus_major_r": 0.5, "procerus": 0.2, "risorius_l": 0.0}
    assert outline_muscles(RECIPE, pose) == ("procerus", "zygomaticus_major")


def test_a_muscle_that_is_not_there_is_refused() -> None:
    with pytest.raises(ParameterError, match="'vomer' is not one of"):
        outline_parameters(RECIPE, ["vomer"])


def test_candidates_are_the_faces_of_their_recipes() -> None:
    face = builtin_springs()
    pose = expression(face, "sadness")
    names = ("corrugator", "depressor_anguli")
    candidates = OutlineCandidates(face, RECIPE, names, pose)
    values = values_at(candidates.genome.parameters, 0.7)
    slow = SpringFace.build(face.head, candidates.recipe_of(values))
    # What the kept muscles do alone is not settled again; springs converge to 0.02 mm.
    assert np.abs(candidates.positions(values) - slow.pose(pose)).max() < 0.05
    assert np.abs(candidates.positions(values) - face.pose(pose)).max() > 0.3
