from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from risorius.errors import FormatError, LandmarkError, MeshError, ParameterError
from risorius.head import Head, HeadOptions
from risorius.landmarks import LandmarkSpec, mirror_name
from risorius.mesh.polygon_mesh import PolygonMesh
from tests.face_fixtures import made_up_head
from tests.synthetic import assemble, head_pieces, head_specs, placed_specs

PIECES, SPECS = head_pieces("bag"), head_specs("bag")
MESH = assemble(PIECES)
HEAD = made_up_head()


def _at(positions: np.ndarray) -> PolygonMesh:
    return PolygonMesh(positions, MESH.corners, MESH.offsets, objects=MESH.objects)


def test_a_head_keeps_its_input_and_knows_its_parts() -> None:
    head = Head.from_mesh(MESH, SPECS)
    assert head.source is MESH
    assert head.vertex_count == MESH.vertex_count
    assert set(head.parts) == set(PIECES)
    assert head.skin is head.parts["skin"]
    assert head.part("tongue") is head.parts["tongue"]
    assert head.part("gums") is None


def test_every_used_vertex_belongs_to_exactly_one_part() -> None:
    owners = np.zeros(HEAD.vertex_count, int)
    for part in HEAD.parts.values():
        owners[part.source] += 1
    np.testing.assert_array_equal(owners, 1)


def test_the_parts_stand_in_the_canonical_frame() -> None:
    for part in HEAD.parts.values():
        np.testing.assert_array_equal(part.mesh.positions, HEAD.positions[part.first_source()])
    eyes = HEAD.landmarks.positions(("3.7", "3.11", "3.8", "3.12"))
    np.testing.assert_allclose(eyes.mean(axis=0), 0.0, atol=1e-9)


@pytest.mark.parametrize("unit", [1.0, 0.1, 0.001])
@pytest.mark.parametrize("axes", ["xyz", "zyx"])
def test_unit_and_axes_of_the_file_do_not_change_the_head(unit: float, axes: str) -> None:
    turn = Rotation.from_euler(axes, [90, 0, 180], degrees=True).as_matrix()
    moved = _at(unit * MESH.positions @ turn.T + (3.0, 4.0, 5.0))
    head = Head.from_mesh(moved, SPECS)
    np.testing.assert_allclose(head.positions, HEAD.positions, atol=1e-9)
    assert set(head.parts) == set(HEAD.parts)
    np.testing.assert_allclose(head.frame.to_input(head.positions), moved.positions, atol=1e-9)


def test_the_height_is_measured_on_the_face_not_on_the_bust() -> None:
    points, polygons = PIECES["skin"]
    shoulders = PIECES | {"shirt": (points - np.array([0.0, 400.0, 0.0]), polygons)}
    head = Head.from_mesh(assemble(shoulders), SPECS)
    assert head.height == HEAD.height
    chin = HEAD.landmarks.position("2.1")
    eyes = HEAD.landmarks.positions(("3.7", "3.12")).mean(axis=0)
    assert head.height == pytest.approx(1.9 * np.linalg.norm(eyes - chin))


def test_a_landmark_is_found_on_the_skin() -> None:
    vertex = HEAD.skin_vertex("2.4")
    np.testing.assert_array_equal(HEAD.skin.mesh.positions[vertex], HEAD.landmarks.position("2.4"))


def test_a_landmark_on_another_part_leads_to_the_nearest_skin() -> None:
    first = len(PIECES["skin"][0])
    specs = SPECS | {"3.1": LandmarkSpec(vertex=first)}
    head = Head.from_mesh(MESH, specs)
    vertex = head.skin_vertex("3.1")
    distance = np.linalg.norm(head.skin.mesh.positions - head.positions[first], axis=1)
    assert vertex == np.argmin(distance)


def test_landmarks_may_be_places_instead_of_vertices() -> None:
    head = Head.from_mesh(MESH, placed_specs("bag"))
    for name in SPECS:
        assert head.skin_vertex(name) == HEAD.skin_vertex(name)


def test_swapped_sides_are_refused_and_flipped_on_request() -> None:
    swapped = {mirror_name(name): spec for name, spec in SPECS.items()}
    with pytest.raises(LandmarkError, match=r"left and right are swapped .*--flip-landmarks"):
        Head.from_mesh(MESH, swapped)
    head = Head.from_mesh(MESH, swapped, options=HeadOptions(flip_landmarks=True))
    assert head.landmarks.vertex("2.4") == HEAD.landmarks.vertex("2.4")
    np.testing.assert_array_equal(head.positions, HEAD.positions)


def test_parts_may_be_named_by_hand() -> None:
    mesh = assemble(PIECES, names={"tongue": "blob"})
    head = Head.from_mesh(mesh, SPECS, options=HeadOptions(parts={"gums": "blob"}))
    assert "gums" in head.parts
    assert "tongue" not in head.parts


def test_options_for_unit_and_axes_are_taken() -> None:
    head = Head.from_mesh(MESH, SPECS, options=HeadOptions(unit="mm", axes="+Y+Z"))
    np.testing.assert_array_equal(head.positions, HEAD.positions)
    with pytest.raises(ParameterError, match="unit: 'miles' is not one of"):
        Head.from_mesh(MESH, SPECS, options=HeadOptions(unit="miles"))


def test_a_cloud_of_points_is_refused() -> None:
    with pytest.raises(MeshError, match="vertices but no faces; export it with polygons"):
        Head.from_mesh(PolygonMesh.from_polygons(MESH.positions, []), SPECS)


def test_landmarks_of_another_mesh_are_refused() -> None:
    specs = SPECS | {"2.1": LandmarkSpec(vertex=MESH.vertex_count)}
    with pytest.raises(LandmarkError, match=r"'2\.1' names vertex \d+, the mesh has \d+"):
        Head.from_mesh(MESH, specs)


def test_no_landmarks_at_all_are_refused_with_what_is_needed() -> None:
    with pytest.raises(LandmarkError, match=r"the frame of the head needs 3\.7 .*add them to the"):
        Head.from_mesh(MESH, {})


def test_a_file_that_is_not_there_is_named(tmp_path) -> None:
    with pytest.raises(FormatError, match=r"nobody\.obj: no such file"):
        Head.load(tmp_path / "nobody.obj")
    (tmp_path / "folder.obj").mkdir()
    with pytest.raises(FormatError, match=r"folder\.obj: is a folder, a file was expected"):
        Head.load(tmp_path / "folder.obj")
