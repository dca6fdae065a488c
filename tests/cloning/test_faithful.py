"""The published correspondence, errata fixed."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from risorius.anatomy.template import builtin_head
from risorius.cloning import Cloning, clone_parameters, motion_error
from risorius.cloning.landmark_pairs import pair_landmarks
from risorius.cloning.refinement import Refinement, ray_length, refine
from risorius.cloning.subject import Subject
from tests.cloning.rigs import copy_of, dense, other_head, source_rig


@cache
def subjects() -> tuple[Subject, Subject]:
    return Subject.of(builtin_head(), "source"), Subject.of(other_head(), "target")


def moving() -> np.ndarray:
    skin = builtin_head().skin.first_source()
    return dense(source_rig())[:, skin].any(axis=(0, 2))


@cache
def refinement() -> Refinement:
    source, target = subjects()
    pairs = pair_landmarks(source, target)
    return refine(source, target, pairs, moving(), clone_parameters("faithful"))


def test_refining_brings_the_skins_together_and_stops() -> None:
    found = refinement()
    assert 1 <= found.pass_count <= 10
    assert found.misses[-1] < 0.5 * found.misses[0]
    # Within the smoothing every pass is as good as the last or better.
    assert all(b < 1.1 * a for a, b in zip(found.misses, found.misses[1:]))
    assert found.misses[-1] < 0.005 * other_head().height


@pytest.mark.filterwarnings("ignore:unit. eyes")
def test_rays_are_a_share_of_the_target_s_face_and_shrink_with_it() -> None:
    target = subjects()[1]
    marks = target.head.landmarks
    eyes = marks.positions(("3.7", "3.8", "3.11", "3.12"))[:, 1].mean()
    expected = 0.3125 * abs(eyes - marks.position("9.15")[1])
    assert ray_length(target, 0.3125) == pytest.approx(expected, rel=1e-12)
    assert refinement().ray == ray_length(target, 0.3125)
    head = builtin_head()
    half = copy_of(head, 0.5 * head.source.positions)
    scale = half.frame.scale / head.frame.scale
    whole = ray_length(subjects()[0], 0.3125)
    assert ray_length(Subject.of(half, "half"), 0.3125) == pytest.approx(0.5 * scale * whole)


@cache
def bound(form: str) -> Cloning:
    parameters = replace(clone_parameters("faithful"), form=form)
    mask = dense(source_rig()).any(axis=(0, 2))
    return Cloning.build(builtin_head(), other_head(), moving=mask, parameters=parameters)


def test_it_clones_sanely_with_fewer_centres_than_vertices() -> None:
    skin = other_head().skin.first_source()
    made = bound("delta").carry(dense(source_rig()))
    for truth, moved in list(zip(dense(source_rig()), made))[:3]:
        assert motion_error(truth[skin], moved[skin]) < 25.0
    assert refinement().centre_count < 1500


def test_the_delta_form_moves_nothing_at_rest_and_the_absolute_form_only_what_moves() -> None:
    none = np.zeros((1, builtin_head().vertex_count, 3))
    for form in ("delta", "absolute"):
        assert (bound(form).carry(none) == 0.0).all()


def test_the_absolute_form_puts_vertices_on_the_deformed_source() -> None:
    smile = dense(source_rig())[source_rig().names.index("smile")]
    skin = other_head().skin.first_source()
    delta, absolute = (bound(form).carry(smile[None])[0][skin] for form in ("delta", "absolute"))
    moved = np.linalg.norm(delta, axis=1) > 1.0
    jump = np.linalg.norm(delta - absolute, axis=1)[moved]
    # They differ by what the fit misses of the neutral, not by the motion.
    assert 0.0 < jump.mean() < 0.01 * other_head().height


def test_cloned_onto_itself_it_is_exact() -> None:
    parameters = clone_parameters("faithful")
    own = Cloning.build(builtin_head(), builtin_head(), parameters=parameters)
    for truth, made in zip(dense(source_rig()), own.carry(dense(source_rig()))):
        assert motion_error(truth, made) < 0.1
