"""How far controls of an expression go."""

from __future__ import annotations

import numpy as np
import pytest

from risorius.controls.presets import default_presets
from risorius.tuning import MuscleCandidates
from risorius.tuning.intensities import (
    IntensityCandidates,
    apply_intensities,
    intensity_parameters,
)
from tests.face_fixtures import builtin_face
from tests.tuning.faces import expression

BOOK = default_presets()


def test_controls_change_by_parts_of_their_range_and_stay_inside() -> None:
    controls = builtin_face().controls
    pose = {"zygomaticus_major_l": 0.9, "zygomaticus_major_r": 0.9, "jaw_pitch": 6.0}
    found = {each.name: each for each in intensity_parameters(pose, "joy", controls)}
    assert found.keys() == {"joy.zygomaticus_major", "joy.jaw_pitch"}
    smile, jaw = found["joy.zygomaticus_major"], found["joy.jaw_pitch"]
    assert (smile.low, smile.high, smile.start) == pytest.approx((-0.3, 0.1, 0.0))
    assert (jaw.low, jaw.high) == pytest.approx((-5.4, 5.4))
    one_sided = intensity_parameters(pose, "joy", controls, mirror=False)
    assert len(one_sided) == 3


def test_unequal_sides_keep_parameters_of_their_own() -> None:
    pose = {"risorius_l": 0.9, "risorius_r": 0.2}
    found = intensity_parameters(pose, "fear", builtin_face().controls)
    assert [each.name for each in found] == ["fear.risorius_l", "fear.risorius_r"]


def test_a_book_changes_where_it_is_told_and_nowhere_else() -> None:
    values = {"joy.zygomaticus_major": -0.25, "joy.lid_lower_l": 0.1, "zygomaticus_major.reach": 2}
    changed = apply_intensities(BOOK, values)
    for name, pose in BOOK.emotions.items():
        if name != "joy":
            assert changed.emotions[name] == pose
    joy, before = changed.emotions["joy"], BOOK.emotions["joy"]
    different = {control for control in joy if joy[control] != before[control]}
    assert different == {"zygomaticus_major_l", "zygomaticus_major_r", "lid_lower_l"}
    assert joy["zygomaticus_major_r"] == before["zygomaticus_major_r"] - 0.25
    assert changed.arkit == BOOK.arkit


def test_candidates_are_the_poses_of_the_changed_book() -> None:
    face = builtin_face()
    candidates = IntensityCandidates(face, BOOK, "anger")
    assert (candidates.positions({}) == face.pose(expression(face, "anger"))).all()
    values = {"anger.corrugator": -0.2, "anger.lid_lower": 0.15}
    book = apply_intensities(BOOK, values)
    pose = book.fit(book.emotions["anger"], face.controls).pose
    assert (candidates.positions(values) == face.pose(pose)).all()


def test_muscles_and_intensities_are_tuned_together() -> None:
    face = builtin_face()
    pose = expression(face, "anger")
    muscles = MuscleCandidates(face, ("corrugator_l", "corrugator_r"), pose, 130.0)
    both = IntensityCandidates(muscles, BOOK, "anger")
    assert both.genome.names[: len(muscles.genome)] == muscles.genome.names
    assert both.genome.names[-1].startswith("anger.")
    stronger = {"corrugator.strength": 1.2, "anger.corrugator": -0.3}
    made = both.positions(stronger)
    weaker = {**pose, **{name: pose[name] - 0.3 for name in muscles.names}}
    wanted = face.with_muscles(muscles.muscles(stronger)).pose(weaker)
    assert np.allclose(made, wanted, rtol=0.0, atol=1e-12 * np.ptp(made))
