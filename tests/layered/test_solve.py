"""Controls are found back from the shapes that they make."""

from __future__ import annotations

import numpy as np
import pytest

from risorius.errors import LandmarkError, ShapeError
from risorius.layered import landmark_target, solve_pose
from tests.layered.faces import builtin_layered


def _skin_vertices() -> np.ndarray:
    return np.unique(builtin_layered().head.skin.first_source()).astype(np.int32)


def test_a_pose_is_found_back_from_its_shape() -> None:
    face, vertices = builtin_layered(), _skin_vertices()
    pose = {"zygomaticus_major_l": 0.6, "corrugator_r": 0.4, "lid_upper_l": 0.5, "jaw_pitch": 4.0}
    found = face.solve(face.displace(pose)[vertices], vertices)
    assert found.explained > 0.995
    assert found.residual < 0.05
    for name, value in pose.items():
        assert found.pose[name] == pytest.approx(value, abs=0.1 * max(value, 1.0))


def test_controls_stay_inside_their_ranges() -> None:
    face, vertices = builtin_layered(), _skin_vertices()
    twice = 2.5 * face.displace({"zygomaticus_major_l": 1.0, "zygomaticus_major_r": 1.0})
    found = solve_pose(face, twice[vertices], vertices, together=True)
    ranges = {control.name: control for control in face.controls}
    assert found.explained < 0.95
    for name, value in found.pose.items():
        assert ranges[name].low - 1e-9 <= value <= ranges[name].high + 1e-9


def test_together_moves_both_sides_alike() -> None:
    face, vertices = builtin_layered(), _skin_vertices()
    found = solve_pose(face, face.displace({"risorius_l": 1.0})[vertices], vertices, together=True)
    assert found.pose["risorius_l"] == found.pose["risorius_r"]


def test_a_few_landmarks_are_enough_to_lift_the_brows() -> None:
    face = builtin_layered()
    marks = face.head.landmarks
    places = {name: marks.position(name) + [0.0, 4.0, 0.0] for name in ("4.1", "4.2", "4.3", "4.4")}
    target, vertices = landmark_target(face, places)
    found = face.solve(target, vertices, together=True)
    assert found.explained > 0.9
    assert sum(value for name, value in found.pose.items() if "frontalis" in name) > 0.5


def test_targets_of_the_wrong_shape_or_name_are_refused() -> None:
    face = builtin_layered()
    with pytest.raises(ShapeError, match=r"target: expected shape \(3, 3\)"):
        face.solve(np.zeros((2, 3)), np.arange(3, dtype=np.int32))
    with pytest.raises(ShapeError, match=r"weights: expected shape \(3,\)"):
        face.solve(np.zeros((3, 3)), np.arange(3, dtype=np.int32), weights=np.ones(2))
    with pytest.raises(LandmarkError, match="nowhere"):
        landmark_target(face, {"nowhere": np.zeros(3)})
