from __future__ import annotations

import numpy as np
import pytest

from risorius.anatomy.jaw import JawPose
from risorius.layered.faithful.teeth import Arch, Teeth
from risorius.spatial.hull import convex_hull


class _Jaw:
    """Turns by the pitch about the x axis, in degrees."""

    def move(self, points: np.ndarray, pose: JawPose) -> np.ndarray:
        angle = np.radians(pose.pitch)
        c, s = np.cos(angle), np.sin(angle)
        return points @ np.array([(1, 0, 0), (0, c, -s), (0, s, c)]).T


def _box(*, is_lower: bool = False) -> Arch:
    corners = np.array([(x, y, z) for x in (-2.0, 2) for y in (-1.0, 1) for z in (-3.0, 3)])
    hull = convex_hull(corners)
    forward = np.array([0.0, 0.0, 1.0])
    touched = np.arange(4, dtype=np.int32)
    return Arch(hull.plane_normals, hull.plane_offsets, forward, touched, corners, is_lower)


POINTS = np.array([(0.0, 0, 2.0), (0, 0, 4.0), (3.0, 0, 0), (0.5, 0.5, -2.0)])


def test_skin_inside_leaves_forwards() -> None:
    distance, plane = _box().exits(POINTS)
    np.testing.assert_allclose(distance, (1.0, 0.0, 0.0, 5.0), atol=1e-12)
    np.testing.assert_allclose(_box().normals[plane[0]], (0, 0, 1))


def test_contacts_name_only_the_skin_that_is_inside() -> None:
    contacts = Teeth((_box(),)).contacts(POINTS)
    assert contacts is not None
    assert contacts.particles.tolist() == [0, 3]
    np.testing.assert_allclose(contacts.points[:, 2], 3.0)
    assert Teeth((_box(),)).contacts(POINTS + [0.0, 9.0, 0.0]) is None
    assert Teeth(()).contacts(POINTS) is None


def test_what_is_pushed_out_lies_on_the_surface_and_the_rest_stays() -> None:
    pushed = Teeth((_box(),)).pushed_out(POINTS)
    assert _box().depth(pushed).max() < 1e-9
    np.testing.assert_array_equal(pushed[1:3], POINTS[1:3])


def test_only_the_lower_row_moves_with_the_jaw() -> None:
    teeth = Teeth((_box(), _box(is_lower=True)))
    upper, lower = teeth.moved(_Jaw(), JawPose(30.0)).arches  # pyright: ignore
    np.testing.assert_array_equal(upper.normals, _box().normals)
    turned = _Jaw().move(POINTS, JawPose(30.0))
    np.testing.assert_allclose(lower.depth(turned), _box().depth(POINTS), atol=1e-12)
    np.testing.assert_allclose(lower.exits(turned)[0], _box().exits(POINTS)[0], atol=1e-9)


@pytest.mark.parametrize("pose", [JawPose()])
def test_at_rest_nothing_is_made_anew(pose: JawPose) -> None:
    arch = _box(is_lower=True)
    assert arch.moved(_Jaw(), pose) is arch  # pyright: ignore
