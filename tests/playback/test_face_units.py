from __future__ import annotations

import numpy as np
import pytest

from risorius.anatomy.template import builtin_head
from risorius.errors import LandmarkError
from risorius.landmarks.landmark_set import LandmarkSet
from risorius.playback import face_units


def test_units_are_the_lengths_of_the_standard_over_1024() -> None:
    marks = builtin_head().landmarks
    units = face_units(marks)
    at = marks.position
    assert units["MW"] * 1024 == pytest.approx(at("8.3")[0] - at("8.4")[0])
    assert units["MNS"] * 1024 == pytest.approx(at("9.15")[1] - at("2.2")[1])
    assert units["ES"] * 1024 == pytest.approx(at("3.5")[0] - at("3.6")[0])
    assert units["AU"] == 1e-5


def test_units_grow_with_the_head_and_angles_do_not() -> None:
    head = builtin_head()
    small, large = face_units(head.landmarks), face_units(head.landmarks.at(2 * head.positions))
    for name, unit in small.items():
        assert large[name] == pytest.approx(unit if name == "AU" else 2 * unit)


def test_without_pupils_the_lids_stand_for_them() -> None:
    head = builtin_head()
    kept = [mark for mark in head.landmarks.values() if mark.name not in ("3.5", "3.6")]
    units = face_units(LandmarkSet(kept, head.positions))
    assert units["ES"] == pytest.approx(face_units(head.landmarks)["ES"], rel=0.1)


def test_missing_landmarks_are_named() -> None:
    head = builtin_head()
    kept = [mark for mark in head.landmarks.values() if mark.name not in ("9.15", "8.4")]
    with pytest.raises(LandmarkError, match=r"9.15, 8.4 missing"):
        face_units(LandmarkSet(kept, head.positions))


def test_a_head_upside_down_is_refused() -> None:
    head = builtin_head()
    turned = head.landmarks.at(head.positions * np.array([1.0, -1.0, 1.0]))
    with pytest.raises(LandmarkError, match="the unit IRISD measures"):
        face_units(turned)
