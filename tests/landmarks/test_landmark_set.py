from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from risorius.errors import LandmarkError
from risorius.landmarks import Landmark, LandmarkSet, LandmarkSpec, resolve
from risorius.mesh.polygon_mesh import PolygonMesh
from tests.synthetic import landmark_points, landmark_set, quad_mesh


def test_a_set_gives_places_and_vertices_by_name() -> None:
    marks = landmark_set()
    assert len(marks) == len(landmark_points())
    for vertex, (name, place) in enumerate(landmark_points().items()):
        assert name in marks
        assert marks.vertex(name) == vertex
        np.testing.assert_array_equal(marks.position(name), place)
    np.testing.assert_array_equal(
        marks.positions(("9.3", "2.1")), [landmark_points()["9.3"], landmark_points()["2.1"]]
    )
    assert marks.positions(()).shape == (0, 3)


def test_a_missing_landmark_is_named() -> None:
    with pytest.raises(LandmarkError, match=r"landmarks: '7\.1' is missing; add it to the file"):
        landmark_set().position("7.1")


def test_asking_for_a_missing_landmark_with_a_default_does_not_raise() -> None:
    marks = landmark_set()
    assert marks.get("7.1") is None
    assert marks.get("7.1", 5) == 5
    assert marks.get("2.1") is marks["2.1"]


def test_missing_and_common_names_keep_their_order() -> None:
    marks = landmark_set()
    assert marks.missing(("7.1", "2.1", "6.1")) == ("7.1", "6.1")
    assert marks.common({"9.3", "2.1", "7.1"}) == ("2.1", "9.3")


def test_a_landmark_is_the_weighted_mean_of_its_vertices_and_follows_them() -> None:
    mark = Landmark("9.3", (0, 2, 3), (0.2, 0.5, 0.3))
    positions = np.arange(12.0).reshape(4, 3)
    np.testing.assert_allclose(
        mark.at(positions), 0.2 * positions[0] + 0.5 * positions[2] + 0.3 * positions[3]
    )
    assert mark.vertex == 2
    shift = np.array([1.0, 2.0, 3.0])
    moved = LandmarkSet([mark], positions).at(positions + shift)
    np.testing.assert_allclose(moved.position("9.3"), mark.at(positions) + shift)


def test_flipping_exchanges_sides_and_twice_changes_nothing() -> None:
    marks = landmark_set()
    flipped = marks.flipped()
    np.testing.assert_array_equal(flipped.position("3.7"), marks.position("3.12"))
    np.testing.assert_array_equal(flipped.position("2.1"), marks.position("2.1"))
    assert dict(flipped.flipped()) == dict(marks)


MESH = quad_mesh()


def test_specs_are_bound_by_vertex_by_face_and_by_position() -> None:
    specs = {
        "2.1": LandmarkSpec(vertex=4, confidence="guess"),
        "9.3": LandmarkSpec(face=1, bary=(0.5, 0.25, 0.25)),
        "8.3": LandmarkSpec(position=(2.9, 0.45, 0.05)),
    }
    marks = resolve(specs, MESH)
    assert marks["2.1"] == Landmark("2.1", (4,), (1.0,), "guess")
    corners = MESH.positions[[0, 2, 3]]
    np.testing.assert_allclose(marks.position("9.3"), np.array([0.5, 0.25, 0.25]) @ corners)
    assert marks.vertex("8.3") == 6


def test_a_vertex_is_preferred_to_a_position() -> None:
    marks = resolve({"2.1": LandmarkSpec(vertex=1, position=(0.0, 0.0, 0.0))}, MESH)
    assert marks.vertex("2.1") == 1


def test_a_position_is_never_bound_to_a_vertex_without_faces() -> None:
    loose = [[0.1, 0.1, 0.0]]
    positions = np.vstack([loose, MESH.positions])
    mesh = PolygonMesh(positions, MESH.corners + 1, MESH.offsets)
    assert resolve({"2.1": LandmarkSpec(position=(0.1, 0.11, 0.0))}, mesh).vertex("2.1") == 1


@given(st.integers(0, 7))
def test_the_own_place_of_a_vertex_binds_to_it(vertex: int) -> None:
    x, y, z = MESH.positions[vertex].tolist()
    assert resolve({"2.1": LandmarkSpec(position=(x, y, z))}, MESH).vertex("2.1") == vertex


@pytest.mark.parametrize(
    ("spec", "message"),
    [
        (LandmarkSpec(vertex=8), "'2.1' names vertex 8, the mesh has 8; is this the landmark file"),
        (LandmarkSpec(vertex=-1), "'2.1' names vertex -1"),
        (LandmarkSpec(face=6, bary=(1.0, 0.0, 0.0)), "'2.1' names triangle 6, the mesh has 6"),
        (LandmarkSpec(face=0, bary=(0.9, 0.9, 0.9)), "the three shares must be 0 or more and sum"),
        (LandmarkSpec(face=0, bary=(1.5, -0.5, 0.0)), "the three shares must be 0 or more and sum"),
        (LandmarkSpec(face=0, bary=(float("nan"), 0.5, 0.5)), "the three shares must be"),
        (LandmarkSpec(position=(3.5, 2.5, 0.0)), "off the mesh .* must be in the mesh's own unit"),
        (LandmarkSpec(position=(0.0, float("nan"), 0.0)), "'2.1' at .* is not finite"),
        (LandmarkSpec(face=0), "'2.1' has no vertex, face \\+ bary or position"),
        (LandmarkSpec(), "'2.1' has no vertex"),
    ],
)
def test_a_spec_that_does_not_fit_the_mesh_is_refused(spec: LandmarkSpec, message: str) -> None:
    with pytest.raises(LandmarkError, match=message):
        resolve({"2.1": spec}, MESH)


def test_a_mesh_without_faces_carries_no_landmarks() -> None:
    mesh = PolygonMesh.from_polygons(np.zeros((3, 3)), [])
    with pytest.raises(LandmarkError, match="the mesh has no faces to carry landmarks"):
        resolve({"2.1": LandmarkSpec(vertex=0)}, mesh)
