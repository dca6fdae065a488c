"""The committed meshes and landmarks of the default anatomy are fit for use."""

from __future__ import annotations

import json
from importlib.resources import files

import numpy as np
import pytest

from risorius.io.obj import read_obj
from risorius.landmarks.feature_points import feature_points
from risorius.mesh.core import TriMesh
from risorius.mesh.topology import report
from risorius.mesh.volume import capped_volume
from risorius.spatial.closest import closest_points, winding_numbers
from tests.anatomy.crossings import crossing_faces

ASSETS = files("risorius.anatomy").joinpath("assets")
HEAD = read_obj(str(ASSETS.joinpath("head.obj")))[0]
SKULL = read_obj(str(ASSETS.joinpath("skull.obj")))[0]
HEAD_MARKS = json.loads(ASSETS.joinpath("head.landmarks.json").read_text("ascii"))
SKULL_MARKS = json.loads(ASSETS.joinpath("skull.landmarks.json").read_text("ascii"))

# pieces of each closed part
CLOSED = {
    "eye_left": 1,
    "eye_right": 1,
    "teeth_upper": 14,
    "teeth_lower": 14,
    "gums_upper": 1,
    "gums_lower": 1,
    "tongue": 1,
}
GROUPS = {
    "face", "neck", "scalp", "mouth_bag", "vermilion_upper", "vermilion_lower", "ear_left",
    "ear_right", "lid_upper_left", "lid_lower_left", "lid_upper_right", "lid_lower_right",
}  # fmt: skip


def _label_of_triangle(mesh, labels):
    return np.array(labels.names, dtype=object)[labels.of_polygon[mesh.triangle_polygon]]


def _part(mesh, name, *, groups=None, without=()):
    """Return the compact triangles of an object, or of some of its groups."""
    chosen = _label_of_triangle(mesh, mesh.objects) == name
    group = _label_of_triangle(mesh, mesh.groups)
    if groups is not None:
        chosen &= np.isin(group, groups)
    chosen &= ~np.isin(group, without)
    used, faces = np.unique(mesh.triangles[chosen], return_inverse=True)
    return TriMesh(mesh.positions[used], faces.reshape(-1, 3))


def _vertices(groups):
    chosen = np.isin(_label_of_triangle(HEAD, HEAD.groups), groups)
    return np.unique(HEAD.triangles[chosen])


def _place(name):
    return HEAD.positions[HEAD_MARKS["landmarks"][name]["vertex"]]


SKIN = _part(HEAD, "skin")
OUTSIDE = _part(HEAD, "skin", without=["mouth_bag"])
BAG = _part(HEAD, "skin", groups=["mouth_bag"])


def test_skin_is_one_sphere_open_at_the_eyes_and_the_neck_only():
    topology = report(SKIN)
    assert topology.component_count == 1
    assert topology.euler == 2 - 3
    centres = sorted(
        (SKIN.positions[loop].mean(axis=0) for loop in topology.boundary_loops), key=lambda c: c[0]
    )
    right, neck, left = centres
    np.testing.assert_allclose(right * [-1, 1, 1], left, atol=1e-9)
    assert left[0] > 20.0
    assert neck[1] == pytest.approx(SKIN.positions[:, 1].min())


@pytest.mark.parametrize("name", CLOSED)
def test_part_is_closed_and_has_its_pieces(name):
    topology = report(_part(HEAD, name))
    assert topology.is_closed
    assert topology.component_count == CLOSED[name]
    assert topology.euler == 2 * CLOSED[name]


@pytest.mark.parametrize(("name", "euler"), [("cranium", -10), ("mandible", 2)])
def test_bone_is_closed(name, euler):
    topology = report(_part(SKULL, name))
    assert topology.is_closed
    assert topology.component_count == 1
    assert topology.euler == euler


@pytest.mark.parametrize(
    ("mesh", "name"),
    [(HEAD, "skin"), *((HEAD, name) for name in CLOSED), (SKULL, "cranium"), (SKULL, "mandible")],
)
def test_part_is_manifold_and_faces_outwards(mesh, name):
    part = _part(mesh, name)
    topology = report(part)
    assert topology.is_manifold
    assert not len(topology.inconsistent_edges)
    assert not len(topology.degenerate_faces)
    assert capped_volume(part.positions, part.faces) > 0


@pytest.mark.parametrize("mesh", [HEAD, SKULL])
def test_mirror_image_is_exact(mesh):
    place = {tuple(p): k for k, p in enumerate((mesh.positions + 0.0).tolist())}
    image = np.array([place[(-x + 0.0, y, z)] for x, y, z in (mesh.positions + 0.0).tolist()])
    np.testing.assert_array_equal(image[image], np.arange(len(image)))
    bounds = list(zip(mesh.offsets[:-1], mesh.offsets[1:]))
    polygons = {tuple(np.sort(mesh.corners[a:b])) for a, b in bounds}
    assert all(tuple(np.sort(image[mesh.corners[a:b]])) in polygons for a, b in bounds)


@pytest.mark.parametrize("part", [SKIN, _part(SKULL, "cranium"), _part(SKULL, "mandible")])
def test_no_triangle_passes_through_another(part):
    assert len(crossing_faces(part.positions, part.faces)) == 0


def test_an_upper_lip_pushed_into_the_lower_one_is_noticed():
    pushed = SKIN.positions.copy()
    pushed[HEAD_MARKS["landmarks"]["2.2"]["vertex"]] -= [0.0, 1.0, 0.0]
    assert len(crossing_faces(pushed, SKIN.faces)) > 0


@pytest.mark.parametrize("name", ["cranium", "mandible"])
def test_bone_lies_under_the_skin_at_a_human_depth(name):
    bone = _part(SKULL, name).positions
    assert (winding_numbers(OUTSIDE, bone) > 0.5).all()
    depth = closest_points(OUTSIDE, bone).distance
    assert depth.min() > 2.0
    least, middle = np.percentile(depth, [5, 50])
    assert 3.5 < least < 6.0
    assert 8.0 < middle < 16.0


def test_lips_share_only_the_corners_and_leave_a_gap():
    upper, lower = _vertices(["vermilion_upper"]), _vertices(["vermilion_lower"])
    shared = HEAD.positions[np.intersect1d(upper, lower)]
    corner = _place("2.4")
    assert (np.abs(np.abs(shared[:, 0]) - corner[0]) < 3.0).all()
    own = np.setdiff1d(lower, upper)
    gap = closest_points(_part(HEAD, "skin", groups=["vermilion_upper"]), HEAD.positions[own])
    assert 0.01 < gap.distance.min() < 0.2
    middle = _place("2.2") - _place("2.3")
    np.testing.assert_allclose(middle, [0.0, 0.06, 0.0], atol=0.005)


@pytest.mark.parametrize(
    "name", ["teeth_upper", "teeth_lower", "gums_upper", "gums_lower", "tongue"]
)
def test_part_lies_inside_the_mouth_bag(name):
    points = _part(HEAD, name).positions
    # the bag's faces look into the mouth, away from the flesh
    assert (winding_numbers(BAG, points) < -0.5).all()
    assert closest_points(BAG, points).distance.min() > (1.0 if "teeth" in name else 0.5)


@pytest.mark.parametrize("side", ["left", "right"])
def test_lids_stay_off_the_eyeball(side):
    eye = _part(HEAD, f"eye_{side}")
    lids = _part(HEAD, "skin", groups=[f"lid_upper_{side}", f"lid_lower_{side}"])
    assert (winding_numbers(eye, lids.positions) < 0.5).all()
    assert 0.05 < closest_points(eye, lids.positions).distance.min() < 1.0


def test_every_landmark_of_the_standard_is_there_and_on_its_side():
    marks = HEAD_MARKS["landmarks"]
    assert set(feature_points()) - set(marks) == {"11.5"}
    for point in feature_points().values():
        if point.name == "11.5" or point.part.startswith("teeth"):
            continue
        x = _place(point.name)[0]
        assert {"left": x > 0, "right": x < 0, "centre": x == 0}[point.side], point.name
        np.testing.assert_array_equal(_place(point.mirror), _place(point.name) * [-1, 1, 1])


def test_landmarks_lie_on_the_part_that_the_table_names():
    whose = _label_of_triangle(HEAD, HEAD.objects)
    for name in HEAD_MARKS["landmarks"]:
        vertex = HEAD_MARKS["landmarks"][name]["vertex"]
        owner = whose[(HEAD.triangles == vertex).any(axis=1)]
        part = feature_points()[name].part
        assert set(owner) == {part if part in HEAD.objects.names else "skin"}, name


def test_bone_landmarks_come_in_mirrored_pairs():
    marks = SKULL_MARKS["landmarks"]
    assert {"condyle_l", "condyle_r", "gonion_l", "gonion_r", "nasion", "pogonion"} <= set(marks)
    place = {
        name: np.array(mark["bary"]) @ SKULL.positions[SKULL.triangles[mark["face"]]]
        for name, mark in marks.items()
    }
    for name, point in place.items():
        if name.endswith("_l"):
            assert point[0] > 0
            np.testing.assert_allclose(place[name[:-1] + "r"], point * [-1, 1, 1], atol=1e-9)
        elif not name.endswith("_r"):
            assert point[0] == 0.0


def test_groups_and_materials_are_there():
    skin = np.unique(HEAD.groups.of_polygon[HEAD.objects.polygons("skin")])
    assert {HEAD.groups.names[k] for k in skin} == GROUPS
    assert {"skin", "lips", "mouth", "sclera", "iris", "pupil", "teeth", "gums", "tongue"} <= set(
        HEAD.materials.names
    )


def test_lids_lips_and_bag_are_quads():
    sizes = np.diff(HEAD.offsets)
    for group in ("vermilion_upper", "vermilion_lower", "lid_upper_left", "lid_lower_right"):
        assert (sizes[HEAD.groups.polygons(group)] == 4).all(), group


def test_texture_coordinates_stay_in_the_unit_square_and_do_not_fold():
    skin = np.isin(HEAD.triangle_polygon, HEAD.objects.polygons("skin"))
    uv = HEAD.uvs[HEAD.uv_corners[HEAD.triangle_corners[skin]]]
    assert uv.min() >= 0.0
    assert uv.max() <= 1.0
    u, v = uv[:, 1] - uv[:, 0], uv[:, 2] - uv[:, 0]
    folded = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0] <= 0
    assert folded.mean() < 0.002


def test_sizes_stay_in_budget():
    assert 5000 <= SKIN.vertex_count <= 8000
    assert len(_vertices(["ear_left", "ear_right"])) <= 900
    assert len(ASSETS.joinpath("head.obj").read_bytes()) < 1_500_000


@pytest.mark.parametrize(("side", "name"), [("left", "3.5"), ("right", "3.6")])
def test_eye_texture_is_centred_on_the_pupil(side, name):
    pupil = HEAD_MARKS["landmarks"][name]["vertex"]
    np.testing.assert_array_equal(HEAD.uvs[HEAD.uv_corners[HEAD.corners == pupil]], 0.5)
    iris = np.isin(HEAD.triangle_polygon, HEAD.materials.polygons("iris"))
    iris &= np.isin(HEAD.triangle_polygon, HEAD.objects.polygons(f"eye_{side}"))
    offset = HEAD.uvs[HEAD.uv_corners[HEAD.triangle_corners[iris].ravel()]] - 0.5
    assert np.linalg.norm(offset, axis=1).max() == pytest.approx(0.5 * 28 / 180, abs=1e-4)
