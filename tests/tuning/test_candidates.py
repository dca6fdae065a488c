"""Other things that can be tuned, and the objective."""

from __future__ import annotations

import numpy as np
import pytest

from risorius.errors import ParameterError, ShapeError
from risorius.tuning import (
    FunctionCandidates,
    Genome,
    MuscleCandidates,
    Parameter,
    PoseCandidates,
    Session,
    ShapeObjective,
    tune,
)
from risorius.tuning.candidates import sensitivity_of
from risorius.tuning.objective import MadeUpUser
from tests.face_fixtures import builtin_face

POINTS = np.arange(12.0).reshape(4, 3)
LINE = FunctionCandidates(
    Genome((Parameter("stiffness", 0.0, 4.0, 1.0), Parameter("idle", 0.0, 1.0, 1.0))),
    lambda values: values["stiffness"] * POINTS,
)


def test_any_function_of_named_numbers_can_be_tuned_to_a_shape() -> None:
    objective = ShapeObjective(LINE, 3.1 * POINTS)
    session = Session(LINE.genome, strategy="preference", sensitivity=sensitivity_of(LINE))
    found = tune(session, objective, generations=8)
    assert found["stiffness"] == pytest.approx(3.1, abs=0.2)


def test_sensitivity_is_the_effect_of_the_whole_range() -> None:
    effect = sensitivity_of(LINE)
    assert effect.shape == (12, 2)
    assert np.allclose(effect[:, 0], 4.0 * POINTS.ravel())
    assert not effect[:, 1].any()
    assert not sensitivity_of(LINE, names=["idle"]).any()


def test_a_preset_of_a_face_is_a_genome() -> None:
    face = builtin_face()
    pose = {"zygomaticus_major_l": 0.5, "zygomaticus_major_r": 0.5, "jaw_pitch": 4.0}
    candidates = PoseCandidates(face, pose)
    assert candidates.genome.names == ("zygomaticus_major", "jaw_pitch")
    values = {"zygomaticus_major": 0.9, "jaw_pitch": 10.0}
    made = candidates.pose_of(values)
    assert made == {
        "zygomaticus_major_l": 0.9,
        "zygomaticus_major_r": 0.9,
        "jaw_pitch": 10.0,
    }
    assert (candidates.positions(values) == face.pose(made)).all()
    assert len(PoseCandidates(face, pose, mirror=False).genome) == 3


def test_muscles_are_fitted_to_a_sculpted_smile() -> None:
    face = builtin_face()
    names = ("zygomaticus_major_l", "zygomaticus_major_r")
    pose = dict.fromkeys(names, 1.0)
    candidates = MuscleCandidates(face, names, pose, 130.0)
    genome = candidates.genome
    rng = np.random.default_rng(4)
    wish = genome.low + rng.uniform(0.2, 0.8, len(genome)) * (genome.high - genome.low)
    objective = ShapeObjective(candidates, candidates.positions(genome.named(wish)))
    session = Session(genome, strategy="preference", sensitivity=sensitivity_of(candidates))
    found = tune(session, objective, generations=10)
    assert objective.distance(genome.values(found)) < 0.5 * objective.distance(genome.start)


def test_weights_say_what_counts() -> None:
    target = POINTS.copy()
    target[0] += 100.0
    weighted = ShapeObjective(LINE, target, weights=[0.0, 1.0, 1.0, 1.0])
    assert weighted.distance(np.array([1.0, 0.0])) == 0.0
    assert ShapeObjective(LINE, target).distance(np.array([1.0, 0.0])) > 10.0


def test_another_mesh_is_no_target() -> None:
    with pytest.raises(ShapeError, match="it must be the same mesh, sculpted"):
        ShapeObjective(LINE, POINTS[:3]).distance(LINE.genome.start)


def test_broken_candidates_and_users_are_refused() -> None:
    broken = FunctionCandidates(LINE.genome, lambda values: POINTS * np.nan)
    with pytest.raises(ParameterError, match="not finite"):
        sensitivity_of(broken)
    with pytest.raises(ParameterError, match="1 to 9 picks"):
        MadeUpUser(lambda values: 0.0, picks=0)
