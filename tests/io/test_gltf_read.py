"""glTF files of other programs, made by hand."""

import base64
import json
from pathlib import Path

import numpy as np
import pytest

from risorius import _formats
from risorius.errors import RisoriusWarning
from risorius.io.gltf import read_gltf_head, read_gltf_rig
from tests.io.glb import Maker

CORNERS = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [2, 1, 0]]
TURN = [0.0, 0.0, np.sqrt(0.5), np.sqrt(0.5)]  # a quarter about +Z


def read(maker: Maker, tmp_path: Path):
    path = tmp_path / "x.glb"
    path.write_bytes(maker.glb())
    return read_gltf_head(path)[0]


@pytest.mark.parametrize("dtype", ["<u1", "<u2", "<u4"])
def test_indices_of_every_size_are_read(tmp_path: Path, dtype: str):
    maker = Maker()
    maker.primitive(CORNERS, np.array([0, 1, 2, 0, 2, 3], dtype))
    mesh = read(maker, tmp_path)
    assert mesh.triangles.tolist() == [[0, 1, 2], [0, 2, 3]]
    assert mesh.positions.tolist() == CORNERS


@pytest.mark.parametrize(
    ("mode", "indices", "expected"),
    [
        (4, None, [[0, 1, 2]]),
        (5, [0, 1, 3, 2, 4], [[0, 1, 3], [1, 2, 3], [3, 2, 4]]),
        (6, [0, 1, 2, 3], [[0, 1, 2], [0, 2, 3]]),
    ],
)
def test_strips_and_fans_become_triangles(tmp_path: Path, mode: int, indices, expected):
    maker = Maker()
    positions = CORNERS[:3] if indices is None else CORNERS
    indices = None if indices is None else np.array(indices, "<u2")
    maker.primitive(positions, indices, mode=mode)
    assert read(maker, tmp_path).triangles.tolist() == expected


def test_points_and_lines_are_passed_over(tmp_path: Path):
    maker = Maker()
    maker.primitive(CORNERS, mode=0)
    maker.primitive(CORNERS[:3])
    maker.primitive(CORNERS[:4], mode=1)
    assert read(maker, tmp_path).vertex_count == 3


def test_interleaved_attributes_are_read_with_their_stride(tmp_path: Path):
    table = np.zeros(3, [("position", "<f4", 3), ("uv", "<f4", 2), ("pad", "<f4")])
    table["position"] = CORNERS[:3]
    table["uv"] = [[0, 0], [1, 0.25], [0.5, 1]]
    maker = Maker()
    view = maker.view(table.tobytes(), byteStride=24)
    for kind, offset in (("VEC3", 0), ("VEC2", 12)):
        maker.document["accessors"].append(
            {
                "bufferView": view,
                "byteOffset": offset,
                "componentType": 5126,
                "count": 3,
                "type": kind,
            }
        )
    attributes = {"POSITION": 0, "TEXCOORD_0": 1}
    maker.document["meshes"][0]["primitives"].append({"attributes": attributes})
    mesh = read(maker, tmp_path)
    assert mesh.positions.tolist() == CORNERS[:3]
    assert mesh.uvs.tolist() == [[0, 1], [1, 0.75], [0.5, 0]]
    assert mesh.uv_corners.tolist() == [0, 1, 2]


@pytest.mark.parametrize(
    ("dtype", "normalised", "scale"),
    [("<i1", True, 127), ("<i2", True, 32767), ("<u2", True, 65535), ("<i2", False, 1)],
)
def test_quantised_positions_are_unfolded(tmp_path: Path, dtype: str, normalised: bool, scale: int):
    raw = np.array([[0, 0, 0, 0], [100, 0, 0, 0], [0, 100, 127, 0]], dtype)
    maker = Maker()
    maker.document["extensionsRequired"] = ["KHR_mesh_quantization"]
    view = maker.view(raw.tobytes(), byteStride=raw.itemsize * 4)
    component = {"<i1": 5120, "<i2": 5122, "<u2": 5123}[dtype]
    accessor = {"bufferView": view, "componentType": component, "count": 3, "type": "VEC3"}
    maker.document["accessors"].append({**accessor, "normalized": normalised})
    maker.document["meshes"][0]["primitives"].append({"attributes": {"POSITION": 0}})
    np.testing.assert_allclose(read(maker, tmp_path).positions, raw[:, :3] / scale, rtol=1e-12)


def test_the_lowest_signed_integer_is_minus_one_like_its_neighbour(tmp_path: Path):
    maker = Maker()
    index = maker.accessor(np.array([[-128, -127, 127]] * 3, "<i1"), normalized=True)
    maker.document["meshes"][0]["primitives"].append({"attributes": {"POSITION": index}})
    assert read(maker, tmp_path).positions[0].tolist() == [-1, -1, 1]


@pytest.mark.parametrize("with_base", [True, False])
def test_sparse_accessors_replace_rows(tmp_path: Path, with_base: bool):
    maker = Maker()
    base = maker.accessor(np.asarray(CORNERS[:3], "<f4"))
    accessor = maker.document["accessors"][base]
    if not with_base:
        del accessor["bufferView"]
    accessor["sparse"] = {
        "count": 2,
        "indices": {
            "bufferView": maker.view(np.array([0, 2], "<u1").tobytes()),
            "componentType": 5121,
        },
        "values": {"bufferView": maker.view(np.array([[7, 7, 7], [8, 8, 8]], "<f4").tobytes())},
    }
    maker.document["meshes"][0]["primitives"].append({"attributes": {"POSITION": base}})
    middle = CORNERS[1] if with_base else [0, 0, 0]
    assert read(maker, tmp_path).positions.tolist() == [[7, 7, 7], middle, [8, 8, 8]]


def test_nodes_place_their_meshes_and_a_mesh_may_stand_twice(tmp_path: Path):
    maker = Maker()
    maker.primitive(CORNERS[:3])
    maker.document["nodes"] = [
        {"children": [2, 1], "translation": [10, 0, 0]},
        {"name": "eye_right", "mesh": 0, "scale": [2, 2, 2], "rotation": TURN},
        {"name": "eye_left", "mesh": 0, "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 5, 0, 1]},
    ]
    mesh = read(maker, tmp_path)
    assert mesh.objects.names == ("eye_left", "eye_right")
    np.testing.assert_allclose(mesh.positions[:3] - [10, 5, 0], CORNERS[:3], atol=1e-12)
    expected = [[10, 0, 0], [10, 2, 0], [8, 2, 0]]
    np.testing.assert_allclose(mesh.positions[3:], expected, atol=1e-12)
    assert mesh.triangles.tolist() == [[0, 1, 2], [3, 4, 5]]


def test_a_mirrored_node_keeps_its_faces_outside(tmp_path: Path):
    maker = Maker()
    maker.primitive(CORNERS[:3])
    maker.document["nodes"] = [{"mesh": 0, "scale": [-1, 1, 1]}]
    mesh = read(maker, tmp_path)
    a, b, c = mesh.positions[mesh.triangles[0]]
    assert np.cross(b - a, c - a)[2] > 0


def morphing(names: object = None, *, quarter: bool = False) -> Maker:
    maker = Maker()
    dense = maker.accessor(np.array([[0, 0, 1], [0, 0, 0], [0, 2, 0]], "<f4"))
    maker.primitive(CORNERS[:3], targets=[{"POSITION": dense}, {"NORMAL": dense}])
    if names is not None:
        maker.document["meshes"][0]["extras"] = {"targetNames": names}
    if quarter:
        maker.document["nodes"][0]["rotation"] = TURN
    return maker


def test_targets_have_the_names_of_the_mesh(tmp_path: Path):
    targets = read(morphing(["smile", "wrinkle"]), tmp_path).targets
    assert targets["smile"].tolist() == [[0, 0, 1], [0, 0, 0], [0, 2, 0]]
    assert not targets["wrinkle"].any()


def test_targets_turn_with_their_node(tmp_path: Path):
    targets = read(morphing(["smile", "x"], quarter=True), tmp_path).targets
    np.testing.assert_allclose(targets["smile"][2], [-2, 0, 0], atol=1e-12)


@pytest.mark.parametrize(
    ("names", "expected"),
    [
        (None, ("target_0", "target_1")),
        (["smile"], ("smile", "target_1")),
        (["smile", "smile"], ("smile", "smile_2")),
    ],
)
def test_missing_and_doubled_names_are_made_up(tmp_path: Path, names, expected):
    assert tuple(read(morphing(names), tmp_path).targets) == expected


def test_targets_of_one_name_in_several_meshes_are_one(tmp_path: Path):
    maker = morphing(["smile", "x"])
    maker.document["meshes"].append(
        {**maker.document["meshes"][0], "extras": {"targetNames": ["x", "smile"]}}
    )
    maker.document["nodes"] = [{"mesh": 0, "name": "skin"}, {"mesh": 1, "name": "teeth"}]
    maker.document["scenes"][0]["nodes"] = [0, 1]
    path = tmp_path / "x.glb"
    path.write_bytes(maker.glb())
    rig = read_gltf_rig(path)
    assert rig.names == ("smile", "x")
    assert rig.by_name["smile"].vertices.tolist() == [0, 2]
    assert rig.by_name["x"].vertices.tolist() == [3, 5]
    assert rig.part_names == ("skin", "teeth")
    assert rig.part_of_vertex.tolist() == [0, 0, 0, 1, 1, 1]
    assert rig.frame.unit == "m"


def test_materials_label_the_polygons(tmp_path: Path):
    maker = Maker()
    maker.document["materials"] = [{"name": "skin"}, {}]
    for material in ({"material": 0}, {"material": 1}, {}):
        maker.primitive(CORNERS[:3], **material)
    mesh = read(maker, tmp_path)
    assert mesh.materials.names == ("skin",)
    assert mesh.materials.of_polygon.tolist() == [0, -1, -1]


def test_a_skinned_mesh_is_read_at_rest_with_a_note(tmp_path: Path):
    maker = Maker()
    maker.primitive(CORNERS[:3])
    inverse = np.eye(4, dtype="<f4")
    inverse[3, 1] = -3.0  # column-major: moves down by 3
    index = maker.accessor(inverse.reshape(1, 16))
    maker.document["nodes"] = [
        {"mesh": 0, "skin": 0, "translation": [99, 99, 99]},
        {"translation": [0, 3, 1], "scale": [1, 1, 1]},
    ]
    maker.document["skins"] = [{"joints": [1], "inverseBindMatrices": index}]
    maker.document["scenes"][0]["nodes"] = [0, 1]
    with pytest.warns(RisoriusWarning, match=r"1 skin\(s\) left out"):
        mesh = read(maker, tmp_path)
    assert mesh.positions.tolist() == [[x, y, z + 1] for x, y, z in CORNERS[:3]]


def test_without_scenes_all_roots_are_shown(tmp_path: Path):
    maker = Maker()
    maker.primitive(CORNERS[:3])
    del maker.document["scenes"], maker.document["scene"]
    maker.document["nodes"] = [{"mesh": 0}, {"children": [0], "translation": [1, 0, 0]}]
    assert read(maker, tmp_path).positions[0].tolist() == [1, 0, 0]


def test_buffers_may_stand_inside_or_beside_the_file(tmp_path: Path):
    maker = Maker()
    maker.primitive(CORNERS[:3])
    (tmp_path / "inside.gltf").write_bytes(maker.gltf())
    (tmp_path / "beside.gltf").write_bytes(maker.gltf("my%20data.bin"))
    (tmp_path / "my data.bin").write_bytes(maker.data)
    for name in ("inside.gltf", "beside.gltf"):
        mesh, landmarks = _formats.read_head(tmp_path / name)
        assert mesh.positions.tolist() == CORNERS[:3]
        assert landmarks == {}


def test_a_byte_order_mark_before_the_json_does_no_harm(tmp_path: Path):
    maker = Maker()
    maker.primitive(CORNERS[:3])
    (tmp_path / "x.gltf").write_bytes(b"\xef\xbb\xbf" + maker.gltf())
    assert read_gltf_head(tmp_path / "x.gltf")[0].vertex_count == 3


def test_harmless_extensions_may_be_required(tmp_path: Path):
    maker = Maker()
    maker.primitive(CORNERS[:3])
    maker.document["extensionsRequired"] = ["KHR_materials_unlit", "KHR_texture_transform"]
    assert read(maker, tmp_path).vertex_count == 3


def test_extra_bytes_and_chunks_behind_a_glb_do_no_harm(tmp_path: Path):
    maker = Maker()
    maker.primitive(CORNERS[:3])
    (tmp_path / "x.glb").write_bytes(maker.glb() + b"trailing")
    assert read_gltf_head(tmp_path / "x.glb")[0].vertex_count == 3


def test_the_hand_made_files_are_as_they_should_be():
    maker = Maker()
    maker.primitive(CORNERS[:3])
    document = json.loads(maker.gltf())
    data = base64.b64decode(document["buffers"][0]["uri"].partition(",")[2])
    assert np.frombuffer(data, "<f4").reshape(-1, 3).tolist() == CORNERS[:3]
