"""Faces that are not shown, and muscles that belong to an expression."""

from __future__ import annotations

import numpy as np
import pytest

from risorius.anatomy.template import builtin_head
from risorius.tuning.companions import companions_of
from risorius.tuning.plausible import Plausible
from tests.face_fixtures import builtin_face

HEAD = builtin_head()


@pytest.fixture(scope="module")
def judge() -> Plausible:
    return Plausible.of(HEAD)


def _cheek(radius: float) -> np.ndarray:
    """Return the vertices near the middle of the left cheek, of the whole head."""
    skin = HEAD.skin.mesh.positions
    middle = skin[np.argmin(np.linalg.norm(skin - [45.0, -40.0, 75.0], axis=1))]
    return np.flatnonzero(np.linalg.norm(HEAD.positions - middle, axis=1) < radius)


def test_the_head_at_rest_and_turned_as_a_whole_has_no_faults(judge: Plausible) -> None:
    assert judge.faults(HEAD.positions) == 0.0
    assert judge.faults(1.1 * HEAD.positions + 5.0) == 0.0
    assert judge(HEAD.positions)


@pytest.mark.parametrize("pose", [{"jaw_pitch": 12.0}, {"zygomaticus_major_l": 0.8}])
def test_what_a_good_face_does_is_plausible(judge: Plausible, pose: dict[str, float]) -> None:
    first = builtin_face().pose(pose)
    assert Plausible.of(HEAD, first)(first)
    assert judge.faults(first) < 0.01


def test_torn_and_folded_skin_is_told(judge: Plausible) -> None:
    torn, folded = HEAD.positions.copy(), HEAD.positions.copy()
    torn[_cheek(12.0)] += [0.0, 0.0, 40.0]
    rows = _cheek(16.0)
    centre = folded[rows].mean(axis=0)
    folded[rows] = centre + (folded[rows] - centre) * [-1.0, 1.0, 1.0]
    for wrong in (torn, folded):
        assert judge.faults(wrong) > 0.001
        assert not judge(wrong)
        assert not Plausible.of(HEAD, HEAD.positions)(wrong)


def test_a_smile_has_the_muscles_around_the_mouth_corner_as_companions() -> None:
    pose = {"zygomaticus_major_l": 1.0, "zygomaticus_major_r": 1.0}
    found = companions_of(builtin_face(), pose)
    assert {"risorius_l", "risorius_r", "buccinator_l"} <= set(found)
    assert not set(found) & {"zygomaticus_major_l", "corrugator_l", "frontalis_inner_l"}
    assert not any(name.startswith(("jaw", "lid", "gaze", "tongue")) for name in found)


def test_brows_have_other_companions_than_mouths() -> None:
    found = companions_of(builtin_face(), {"corrugator_l": 0.8, "corrugator_r": 0.8})
    assert "frontalis_inner_l" in found
    assert not set(found) & {"risorius_l", "depressor_anguli_l", "mentalis_l"}
