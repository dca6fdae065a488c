"""Places on the wrong sheet are found and their motion comes from around them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from risorius.cloning.evening import evening, place_stretch
from risorius.cloning.polyline import arched, interpolated
from risorius.cloning.seam_zones import SeamZone
from risorius.mesh import TriMesh

COUNT = 13
MIDDLE = COUNT * COUNT // 2


def sheet() -> TriMesh:
    x, y = np.meshgrid(np.arange(COUNT, dtype=float), np.arange(COUNT, dtype=float))
    points = np.stack([x.ravel(), y.ravel(), 0.0 * x.ravel()], axis=1)
    at = np.arange(COUNT * COUNT).reshape(COUNT, COUNT)
    a, b, c, d = at[:-1, :-1], at[:-1, 1:], at[1:, 1:], at[1:, :-1]
    faces = [np.stack(t, axis=-1).reshape(-1, 3) for t in ((a, b, c), (a, c, d))]
    return TriMesh(points, np.concatenate(faces).astype(np.int32))


def places(astray: int | None) -> tuple[np.ndarray, np.ndarray]:
    """Return every vertex on itself, but the middle one on vertex `astray`."""
    own = np.arange(COUNT * COUNT, dtype=np.int32)
    if astray is not None:
        own[MIDDLE] = astray
    corners = np.stack([own, (own + 1) % len(own), (own + COUNT) % len(own)], axis=1)
    return corners.astype(np.int32), np.tile([1.0, 0.0, 0.0], (len(own), 1))


def zone() -> SeamZone:
    everything = np.ones(COUNT * COUNT, bool)
    return SeamZone(everything, everything, ordinary=1.1, bend=1.0)


def test_places_that_lie_as_their_vertices_do_are_left_alone() -> None:
    mesh, (corners, bary) = sheet(), places(None)
    assert not place_stretch(zone(), mesh, mesh, corners, bary).any()
    even = evening([zone()], mesh, mesh, corners, bary)
    assert (even.toarray() == np.eye(COUNT * COUNT)).all()


def test_a_place_far_from_those_around_it_is_told_by_its_stretch() -> None:
    mesh, (corners, bary) = sheet(), places(MIDDLE + 4)
    excess = place_stretch(zone(), mesh, mesh, corners, bary)
    assert excess.argmax() == MIDDLE
    assert excess[MIDDLE] > 1.5
    far = np.linalg.norm(mesh.positions - mesh.positions[MIDDLE], axis=1) > 1.5
    assert not excess[far].any()
    nowhere = replace(zone(), target=np.zeros(COUNT * COUNT, bool))
    assert not place_stretch(nowhere, mesh, mesh, corners, bary).any()


def test_its_motion_is_made_from_its_neighbours() -> None:
    mesh, (corners, bary) = sheet(), places(MIDDLE + 4)
    even = evening([zone()], mesh, mesh, corners, bary)
    assert np.asarray(even.sum(axis=1)).ravel() == pytest.approx(1.0, abs=1e-4)
    field = mesh.positions[:, 0] + 2.0 * mesh.positions[:, 1]
    carried = field.copy()
    carried[MIDDLE] = field[MIDDLE + 4]
    made = even @ carried
    assert abs(made[MIDDLE] - field[MIDDLE]) < 0.1 * abs(carried[MIDDLE] - field[MIDDLE])
    far = np.linalg.norm(mesh.positions - mesh.positions[MIDDLE], axis=1) > 5.7
    assert (made[far] == carried[far]).all()


def test_a_line_of_few_vertices_opens_as_an_ellipse() -> None:
    place = np.array([0.0, 0.3, 0.5, 0.8, 1.0])
    wanted = np.linspace(0.0, 1.0, 21)
    ellipse = 9.0 * np.sqrt(place * (1.0 - place))[:, None]
    made = arched(ellipse, place, wanted)[:, 0]
    assert made == pytest.approx(9.0 * np.sqrt(wanted * (1.0 - wanted)), abs=1e-12)
    straight = (2.0 + 5.0 * place)[:, None]
    assert arched(straight, place, wanted)[:, 0] == pytest.approx(2.0 + 5.0 * wanted)


def test_a_line_of_many_vertices_is_interpolated_as_it_is() -> None:
    place = np.linspace(0.0, 1.0, 30)
    values = np.sin(np.pi * place)[:, None]
    wanted = np.linspace(0.0, 1.0, 77)
    assert (arched(values, place, wanted) == interpolated(values, place, wanted)).all()
