"""What can be seen."""

from __future__ import annotations

import numpy as np
import pytest

from risorius.errors import ShapeError
from risorius.spatial.raycast import Scene
from risorius.spatial.visibility import visible_along, visible_from
from tests.mesh.shapes import grid, sphere


def test_the_near_half_of_a_sphere_is_visible():
    mesh = sphere(3, radius=80.0)
    seen = visible_along(Scene([mesh]), mesh.positions, [0, 0, 2])
    z = mesh.positions[:, 2] / 80.0
    assert seen[z > 0.15].all()
    assert not seen[z < -0.15].any()


def test_from_a_near_eye_less_is_visible():
    mesh = sphere(3)
    seen = visible_from(Scene([mesh]), mesh.positions, [0, 0, 2.0])
    horizon = 0.5
    assert seen[mesh.positions[:, 2] > horizon + 0.1].all()
    assert not seen[mesh.positions[:, 2] < horizon - 0.1].any()


def test_an_obstacle_hides_what_is_behind_it():
    wall = grid(2, 2)
    points = np.array([[0.4, 0.3, -1], [0.4, 0.3, 1], [3, 3, -1]])
    assert visible_along(Scene([wall]), points, [0, 0, 1]).tolist() == [False, True, True]
    assert visible_from(Scene([wall]), points, [0.5, 0.5, 5]).tolist() == [False, True, True]
    assert visible_along(Scene([wall]), points, [0, 0, -1]).tolist() == [True, False, True]


def test_points_far_from_the_scene_are_judged_as_well():
    wall = grid(2, 2)
    points = np.array([[0.4, 0.3, -900.0], [0.4, 0.3, 900.0]])
    assert visible_along(Scene([wall]), points, [0, 0, 1]).tolist() == [False, True]


def test_the_eye_sees_itself():
    assert visible_from(Scene([grid()]), [[1.0, 2.0, 3.0]], [1.0, 2.0, 3.0]).all()


def test_two_eyes_are_refused():
    with pytest.raises(ShapeError, match="eye: expected one position"):
        visible_from(Scene([grid()]), [[0, 0, 0]], [[0, 0, 1], [0, 0, 2]])
