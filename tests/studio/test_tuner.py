"""Tuning by choosing: the nine that are shown are what is kept, for every method."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from risorius.errors import Cancelled, ParameterError
from risorius.project import Project
from risorius.studio.jobs import Job
from risorius.studio.scene import Stage, stage_of
from risorius.studio.subject import build_subject
from risorius.studio.tuner import Tuner, muscle_of
from risorius.studio.work import work_of


@cache
def _stage(method: str) -> Stage:
    frown = {"corrugator_l": 0.8, "corrugator_r": 0.8}
    return stage_of(build_subject(work_of(Project(method=method, poses={"frown": frown}))))


def _begin(method: str, what: str, expression: str = "anger", **options) -> Tuner:
    return Tuner.begin(_stage(method).subject, expression, Job("tune"), what=what, **options)


@pytest.mark.parametrize(
    ("method", "what"),
    [("layered", "pose"), ("layered", "muscles"), ("springs", "muscles"), ("vector", "muscles")],
)
def test_the_face_that_is_accepted_is_the_one_that_was_shown(method: str, what: str) -> None:
    stage = _stage(method)
    tuner = _begin(method, what, "anger" if what == "pose" else "frown", seed=3)
    shown = tuner.faces(stage)
    assert len(shown) == 9
    assert any(np.abs(shown[0]["skin"] - each["skin"]).max() > 0.5 for each in shown[1:])
    before = stage.subject.work
    work = tuner.accepted(before, 4)
    subject = build_subject(work, stage.subject)
    kept = subject.face.pose(work.pose)[subject.head.skin.first_source()]
    assert np.abs(kept - shown[4]["skin"]).max() < 1e-6
    if what == "pose":
        assert work.poses["my anger"] == work.pose
        assert work.muscle_map is before.muscle_map
    tuner.next((4,))
    assert tuner.session.generation.number == 1


def test_others_come_from_the_same_choice_and_back_is_back() -> None:
    tuner = _begin("vector", "pose")
    first = tuner.session.generation.candidates
    tuner.next(())
    others = tuner.session.generation
    assert others.number == 0
    assert not np.array_equal(others.candidates, first)
    tuner.next((2, 0))
    tuner.session.undo()
    assert np.array_equal(tuner.session.generation.candidates, others.candidates)


def test_locked_muscles_stay_as_they_are() -> None:
    tuner = _begin("vector", "muscles", locked=("corrugator",))
    names = tuner.session.genome.names
    fixed = [row for row, name in enumerate(names) if muscle_of(name) == "corrugator"]
    assert fixed
    start = tuner.session.genome.start
    for _ in range(2):
        tuner.next((1,))
        assert (tuner.session.generation.candidates[:, fixed] == start[fixed]).all()
    with pytest.raises(ParameterError, match="are locked"):
        _begin("vector", "muscles", locked={muscle_of(name) for name in names})


def test_tuning_of_what_does_not_exist_is_refused() -> None:
    with pytest.raises(ParameterError, match="there is no expression 'glee'"):
        Tuner.begin(_stage("vector").subject, "glee", Job("tune"), what="pose")


def test_a_person_need_not_wait_for_the_nine() -> None:
    job = Job("nine faces")
    job.cancel()
    with pytest.raises(Cancelled, match="nine faces: cancelled"):
        Tuner.begin(_stage("vector").subject, "anger", job, what="muscles")
