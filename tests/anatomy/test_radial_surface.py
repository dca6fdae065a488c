"""The table of an eyeball's surface: its outside, all round, also when it has turned."""

from __future__ import annotations

import numpy as np
import pytest

from risorius.anatomy.eyes import Eyeball
from risorius.anatomy.radial_surface import RadialSurface
from risorius.mesh.core import TriMesh
from tests.synthetic import sphere

CENTRE = np.array([3.0, 4.0, 5.0])


def _ball(radius: float, *, rows: int = 40, columns: int = 60) -> TriMesh:
    points, polygons = sphere(tuple(CENTRE), (radius,) * 3, rows=rows, columns=columns)
    faces = [(p[0], p[k], p[k + 1]) for p in polygons for k in range(1, len(p) - 1)]
    return TriMesh(points, np.array(faces))


def _eye() -> TriMesh:
    """Return a ball with a cornea of 1.5 mm."""
    ball = _ball(12.0)
    arm = (ball.positions - CENTRE) / 12.0
    bulge = 1.5 * np.clip((arm[:, 2] - 0.8) / 0.2, 0.0, 1.0)
    return ball.at(ball.positions + bulge[:, None] * arm)


def _arms() -> np.ndarray:
    return np.random.default_rng(1).normal(size=(300, 3))


def test_a_ball_is_its_radius_in_every_direction_also_behind() -> None:
    surface = RadialSurface.of_mesh(_ball(12.0), CENTRE)
    np.testing.assert_allclose(surface.radius(_arms()), 12.0, rtol=4e-3)


def test_what_lies_inside_the_eye_does_not_count() -> None:
    outer, inner = _ball(12.0), _ball(9.0)
    both = TriMesh(
        np.concatenate([inner.positions, outer.positions]),
        np.concatenate([inner.faces, outer.faces + inner.vertex_count]),
    )
    expected = RadialSurface.of_mesh(outer, CENTRE).table
    np.testing.assert_allclose(RadialSurface.of_mesh(both, CENTRE).table, expected, rtol=1e-9)


def test_an_open_back_takes_the_nearest_radius() -> None:
    whole = _ball(12.0)
    ahead = (whole.positions[whole.faces][:, :, 2] > CENTRE[2] - 4.0).all(axis=1)
    surface = RadialSurface.of_mesh(TriMesh(whole.positions, whole.faces[ahead]), CENTRE)
    np.testing.assert_allclose(surface.radius(_arms()), 12.0, rtol=4e-3)


@pytest.mark.parametrize(("yaw", "pitch"), [(30.0, 0.0), (0.0, -25.0), (-35.0, 20.0)])
def test_the_cornea_goes_with_the_gaze(yaw: float, pitch: float) -> None:
    eye = _eye()
    turned = eye.at(Eyeball(CENTRE, 12.0, True).turn(eye.positions, yaw=yaw, pitch=pitch))
    arms = _arms()
    arms = arms[arms[:, 2] > 0.0]
    expected = RadialSurface.of_mesh(turned, CENTRE).radius(arms)
    surface = RadialSurface.of_mesh(eye, CENTRE)
    assert np.ptp(expected) > 1.0
    np.testing.assert_allclose(surface.radius(arms, yaw=yaw, pitch=pitch), expected, atol=0.12)
    assert np.abs(surface.radius(arms) - expected).max() > 0.8
