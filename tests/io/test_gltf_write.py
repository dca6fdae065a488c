"""Rigs written as GLB, looked at from outside."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from risorius.errors import FormatError
from risorius.io.gltf import write_glb
from risorius.io.gltf.write import glb_bytes
from risorius.mesh.normals import vertex_normals
from risorius.mesh.polygon_mesh import PolygonMesh
from risorius.rig.rig import MorphTarget, Rig
from tests.io.glb import unpack, values
from tests.io.rigs import EYE, SKIN, TEETH, make_mesh, make_rig, make_seam_rig

FLOAT32 = 1e-6


class Glb:
    """A written rig, by part and primitive."""

    def __init__(self, rig: Rig, **options: bool) -> None:
        self.json, self.binary = unpack(glb_bytes(rig, "x.glb", **options))
        self.meshes = {mesh["name"]: mesh for mesh in self.json["meshes"]}

    def read(self, index: int) -> np.ndarray:
        return values(self.json, self.binary, index)

    def attribute(self, part: str, name: str, primitive: int = 0) -> np.ndarray:
        return self.read(self.meshes[part]["primitives"][primitive]["attributes"][name])

    def target(self, part: str, index: int, name: str, primitive: int = 0) -> np.ndarray:
        return self.read(self.meshes[part]["primitives"][primitive]["targets"][index][name])

    def source(self, part: str, primitive: int = 0) -> np.ndarray:
        return self.attribute(part, "_SOURCE_VERTEX", primitive)[:, 0].astype(int)


@pytest.fixture(scope="module")
def rig() -> Rig:
    return make_rig()


@pytest.fixture(scope="module")
def glb(rig: Rig) -> Glb:
    return Glb(rig)


def test_there_is_one_node_per_part_and_one_primitive_per_material(glb: Glb):
    assert [node["name"] for node in glb.json["nodes"]] == ["skin", "eye_left", "teeth_lower"]
    assert glb.json["scenes"][0]["nodes"] == [0, 1, 2]
    names = [material["name"] for material in glb.json["materials"]]
    assert names == ["Face", "Lips ü", "eye_left", "enamel"]
    used = [primitive["material"] for primitive in glb.meshes["skin"]["primitives"]]
    assert [names[index] for index in used] == ["Face", "Lips ü"]


def test_every_part_that_moves_carries_all_targets_in_one_order(glb: Glb, rig: Rig):
    for part in ("skin", "teeth_lower"):
        mesh = glb.meshes[part]
        assert mesh["extras"]["targetNames"] == list(rig.names)
        assert mesh["weights"] == [0.0] * len(rig.targets)
        assert all(len(p["targets"]) == len(rig.targets) for p in mesh["primitives"])
    still = glb.meshes["eye_left"]
    assert "weights" not in still
    assert "extras" not in still
    assert "targets" not in still["primitives"][0]


def test_positions_and_displacements_are_those_of_the_input(glb: Glb, rig: Rig):
    for part, count in (("skin", 2), ("teeth_lower", 1)):
        for primitive in range(count):
            source = glb.source(part, primitive)
            expected = rig.mesh.positions[source]
            found = glb.attribute(part, "POSITION", primitive)
            np.testing.assert_allclose(found, expected, rtol=0, atol=10 * FLOAT32)
            for index, target in enumerate(rig.targets):
                deltas = target.dense(rig.mesh.vertex_count)[source]
                found = glb.target(part, index, "POSITION", primitive)
                np.testing.assert_allclose(found, deltas, rtol=0, atol=FLOAT32)


def test_targets_that_do_nothing_to_a_part_share_their_zeros(glb: Glb):
    targets = glb.meshes["teeth_lower"]["primitives"][0]["targets"]
    smile, jaw, sneer = (target["POSITION"] for target in targets)
    assert smile == sneer != jaw
    assert not glb.read(smile).any()


def test_every_accessor_stands_on_a_buffer_view_as_importers_of_engines_need(glb: Glb):
    assert all("bufferView" in accessor for accessor in glb.json["accessors"])
    used = [accessor["bufferView"] for accessor in glb.json["accessors"]]
    for view in {view for view in used if used.count(view) > 1}:
        assert glb.json["bufferViews"][view]["byteStride"] == 12


def test_vertices_are_split_at_the_uv_seam_and_nowhere_else(glb: Glb):
    sources = np.concatenate([glb.source("skin", 0), glb.source("skin", 1)])
    per_primitive = [np.unique(glb.source("skin", p), return_counts=True) for p in (0, 1)]
    x = make_mesh().positions[:, 0]
    for vertices, counts in per_primitive:
        np.testing.assert_array_equal(vertices[counts == 2], vertices[x[vertices] == 0.0])
        assert counts.max() == 2
    assert set(sources.tolist()) == set(SKIN.tolist())


def test_texture_coordinates_run_downwards(glb: Glb, rig: Rig):
    mesh = rig.mesh
    wanted = {(v, tuple(mesh.uvs[uv])) for v, uv in zip(mesh.corners, mesh.uv_corners) if uv >= 0}
    found = set()
    for primitive in (0, 1):
        uvs = glb.attribute("skin", "TEXCOORD_0", primitive)
        found |= {
            (v, (round(float(u), 5), round(1 - float(w), 5)))
            for v, (u, w) in zip(glb.source("skin", primitive), uvs)
        }
    assert found == {(v, (round(u, 5), round(w, 5))) for v, (u, w) in wanted}
    assert "TEXCOORD_0" not in glb.meshes["eye_left"]["primitives"][0]["attributes"]


def test_normals_are_smooth_across_seams_and_materials_but_not_across_parts(glb: Glb, rig: Rig):
    triangles = rig.mesh.triangles
    for part, own in (("skin", SKIN), ("eye_left", EYE)):
        faces = triangles[np.isin(triangles, own).all(axis=1)]
        expected = vertex_normals(rig.mesh.positions, faces)
        for primitive in range(len(glb.meshes[part]["primitives"])):
            found = glb.attribute(part, "NORMAL", primitive)
            np.testing.assert_allclose(found, expected[glb.source(part, primitive)], atol=FLOAT32)


def test_morphed_normals_are_those_of_the_moved_mesh(glb: Glb, rig: Rig):
    triangles = rig.mesh.triangles
    faces = triangles[np.isin(triangles, SKIN).all(axis=1)]
    for index, target in enumerate(rig.targets):
        expected = vertex_normals(rig.posed({target.name: 1.0}), faces)
        for primitive in (0, 1):
            source = glb.source("skin", primitive)
            turned = glb.attribute("skin", "NORMAL", primitive)
            turned = turned + glb.target("skin", index, "NORMAL", primitive)
            np.testing.assert_allclose(turned, expected[source], atol=2e-4)
    assert np.abs(glb.target("skin", 1, "NORMAL")).max() > 0.05


@pytest.mark.parametrize("apart", [False, True])
def test_twin_vertices_share_a_normal_unless_they_part(apart: bool):
    glb = Glb(make_seam_rig(apart=apart))
    normals = glb.attribute("skin", "NORMAL")
    source = glb.source("skin")
    same = np.allclose(normals[source == 1], normals[source == 4], atol=FLOAT32)
    assert same is not apart


def test_a_concave_polygon_is_cut_without_overlap(glb: Glb, rig: Rig):
    primitive = glb.meshes["teeth_lower"]["primitives"][0]
    triangles = glb.source("teeth_lower")[glb.read(primitive["indices"]).reshape(-1, 3)]
    points = rig.mesh.positions[triangles]
    areas = np.cross(points[:, 1] - points[:, 0], points[:, 2] - points[:, 0])[:, 2] / 2
    assert (areas > 0).all()
    pentagon = 2.5 * np.sin(2 * np.pi / 5)
    assert areas.sum() == pytest.approx(0.04 * (1.4 + pentagon))
    assert len(triangles) == 2 + 3


def test_bounds_are_exactly_those_of_the_stored_numbers(glb: Glb):
    bounded = [i for i, a in enumerate(glb.json["accessors"]) if "min" in a]
    assert len(bounded) > 6
    for index in bounded:
        found, accessor = glb.read(index), glb.json["accessors"][index]
        assert found.min(axis=0).tolist() == accessor["min"]
        assert found.max(axis=0).tolist() == accessor["max"]


def test_a_few_moved_vertices_are_stored_sparsely_and_many_in_full():
    mesh = make_mesh()
    deltas = np.zeros((mesh.vertex_count, 3))
    deltas[2] = 1.0
    few = MorphTarget.from_dense("few", deltas)
    deltas[SKIN] = 1.0
    many = MorphTarget.from_dense("many", deltas)
    glb = Glb(replace(make_rig(mesh), targets=(few, many)))
    indices = [t["POSITION"] for t in glb.meshes["skin"]["primitives"][0]["targets"]]
    assert ["sparse" in glb.json["accessors"][i] for i in indices] == [True, False]


def test_more_than_65535_vertices_need_long_indices():
    side = 270
    x, y = np.meshgrid(np.arange(side, dtype=float), np.arange(side, dtype=float))
    positions = np.stack([x.ravel(), y.ravel(), 0 * x.ravel()], axis=1)
    first = (np.arange(side - 1)[:, None] * side + np.arange(side - 1)).ravel()
    corners = np.stack([first, first + 1, first + 1 + side, first + side], axis=1)
    offsets = np.arange(0, corners.size + 1, 4, dtype=np.int32)
    mesh = PolygonMesh(positions, corners.ravel().astype(np.int32), offsets)
    target = MorphTarget("up", np.array([70000], np.int32), np.array([[0.0, 0, 1]]))
    glb = Glb(Rig(mesh, (target,)))
    primitive = glb.meshes["head"]["primitives"][0]
    assert glb.json["accessors"][primitive["indices"]]["componentType"] == 5125
    assert np.flatnonzero(glb.target("head", 0, "POSITION")[:, 2]).tolist() == [70000]


def test_the_animation_shows_one_shape_after_the_other(rig: Rig):
    glb = Glb(rig, animation=True)
    animation = glb.json["animations"][0]
    nodes = [channel["target"]["node"] for channel in animation["channels"]]
    assert [glb.json["nodes"][node]["name"] for node in nodes] == ["skin", "teeth_lower"]
    sampler = animation["samplers"][0]
    times = glb.read(sampler["input"])[:, 0]
    weights = glb.read(sampler["output"]).reshape(len(times), 3)
    np.testing.assert_array_equal(times, np.arange(7) * 0.5)
    np.testing.assert_array_equal(weights[1::2], np.eye(3))
    assert not weights[::2].any()


def test_metres_turn_the_head_upright_and_to_scale(rig: Rig):
    glb = Glb(rig, metres=True)
    (root,) = glb.json["scenes"][0]["nodes"]
    node = glb.json["nodes"][root]
    matrix = np.array(node["matrix"]).reshape(4, 4).T
    assert len(node["children"]) == 3
    found = glb.attribute("skin", "POSITION") @ matrix[:3, :3].T + matrix[:3, 3]
    expected = rig.frame.to_canonical(rig.mesh.positions[glb.source("skin")]) / 1000
    np.testing.assert_allclose(found, expected, atol=1e-7)


def test_the_same_rig_gives_the_same_bytes():
    options = {"animation": True, "metres": True}
    assert glb_bytes(make_rig(), "x", **options) == glb_bytes(make_rig(), "x", **options)


def test_thin_and_open_parts_show_both_sides(glb: Glb):
    both = {m["name"]: m.get("doubleSided", False) for m in glb.json["materials"]}
    assert both == {"Face": True, "Lips ü": True, "eye_left": False, "enamel": False}


def test_a_rig_without_parts_or_targets_is_one_still_head():
    mesh = PolygonMesh.from_polygons(np.eye(3), [[0, 1, 2]])
    glb = Glb(Rig(mesh, ()), animation=True)
    assert list(glb.meshes) == ["head"]
    assert "animations" not in glb.json
    assert "targets" not in glb.meshes["head"]["primitives"][0]


def test_polygons_of_two_corners_do_no_harm():
    glb = Glb(Rig(PolygonMesh.from_polygons(np.eye(3), [[0, 1]]), ()))
    primitive = glb.meshes["head"]["primitives"][0]
    assert glb.read(primitive["indices"]).ravel().tolist() == [0, 0, 0]
    assert np.linalg.norm(glb.attribute("head", "NORMAL"), axis=1).tolist() == [1.0, 1.0]


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ("positions", "the neutral: row 5"),
        ("deltas", "target 'jawOpen': row 0"),
        ("corners", "needs polygons"),
    ],
)
def test_what_cannot_be_written_is_refused_and_the_old_file_stays(
    tmp_path: Path, change: str, message: str
):
    rig = make_rig()
    if change == "positions":
        rig.mesh.positions[5, 1] = np.nan
    elif change == "deltas":
        rig.by_name["jawOpen"].deltas[0, 0] = 1e39
    else:
        rig = Rig(PolygonMesh.from_polygons(np.eye(3), []), ())
    path = tmp_path / "a.glb"
    path.write_bytes(b"old")
    with pytest.raises(FormatError, match=message):
        write_glb(rig, path)
    assert path.read_bytes() == b"old"
    assert [file.name for file in tmp_path.iterdir()] == ["a.glb"]


def test_teeth_and_skin_move_together(glb: Glb):
    assert np.unique(glb.target("teeth_lower", 1, "POSITION")[:, 1]).tolist() == [-0.5]
    assert set(glb.source("teeth_lower").tolist()) == set(TEETH.tolist())
