"""Rigs as folders of OBJ files, and the OBJ text itself."""

import json
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from risorius import _formats
from risorius.errors import FormatError, RisoriusWarning
from risorius.io.obj import parse_obj, read_obj
from risorius.io.obj_folder import read_obj_folder, write_obj_folder
from risorius.io.obj_text import ObjText
from risorius.mesh.polygon_mesh import Labels, PolygonMesh
from risorius.rig.rig import MorphTarget, Rig
from tests.io.rigs import assert_same_rig, make_mesh, make_rig


def assert_same_mesh(found: PolygonMesh, expected: PolygonMesh) -> None:
    for name in ("positions", "corners", "offsets", "uvs", "uv_corners"):
        np.testing.assert_array_equal(getattr(found, name), getattr(expected, name), name)
    for name in ("objects", "groups", "materials"):
        assert getattr(found, name).names == getattr(expected, name).names
        labels = getattr(expected, name).of_polygon
        np.testing.assert_array_equal(getattr(found, name).of_polygon, labels)


def test_a_mesh_comes_back_bit_by_bit():
    assert_same_mesh(parse_obj(ObjText(make_mesh()).neutral(), "x"), make_mesh())


@given(st.lists(st.tuples(*[st.floats(-3e38, 3e38)] * 3), min_size=1))
def test_every_finite_number_comes_back(rows):
    positions = np.array(rows)
    mesh = PolygonMesh.from_polygons(positions, [[0, 0, 0]])
    found = parse_obj(ObjText(mesh).neutral(), "x").positions
    np.testing.assert_array_equal(found, positions)
    np.testing.assert_array_equal(np.signbit(found), np.signbit(positions))


@given(st.lists(st.integers(-1, 2), min_size=1, max_size=12), st.sampled_from(["o", "g", "m"]))
def test_every_order_of_labels_comes_back(labels, kind):
    order = list(dict.fromkeys(label for label in labels if label >= 0))
    index = np.array([order.index(v) if v >= 0 else -1 for v in labels], np.int32)
    named = Labels(tuple(f"name {v}" for v in order), index) if order else Labels()
    key = {"o": "objects", "g": "groups", "m": "materials"}[kind]
    mesh = PolygonMesh.from_polygons(np.eye(3), [[0, 1, 2]] * len(labels))
    mesh = PolygonMesh(mesh.positions, mesh.corners, mesh.offsets, **{key: named})
    assert_same_mesh(parse_obj(ObjText(mesh).neutral(), "x"), mesh)


def test_names_cannot_break_the_lines():
    mesh = PolygonMesh.from_polygons(np.eye(3), [[0, 1, 2]])
    labels = Labels(("evil\nv 1 2 3\\",), np.zeros(1, np.int32))
    mesh = PolygonMesh(mesh.positions, mesh.corners, mesh.offsets, materials=labels)
    found = parse_obj(ObjText(mesh).neutral(), "x")
    assert found.vertex_count == 3
    assert found.polygon_count == 1


def test_a_rig_comes_back(tmp_path: Path):
    rig = make_rig()
    rig.save(tmp_path / "a.obj")
    assert_same_rig(Rig.load(tmp_path / "a.obj"), rig, rounding=1e-15)


def test_every_file_is_a_whole_head_in_its_pose(tmp_path: Path):
    rig = make_rig()
    write_obj_folder(rig, tmp_path / "rig")
    names = sorted(path.name for path in (tmp_path / "rig").iterdir())
    assert names == [
        "jawOpen.obj",
        "mouthSmileLeft.obj",
        "neutral.obj",
        "noseSneer.obj",
        "rig.json",
    ]
    mesh, _ = _formats.read_head(tmp_path / "rig" / "jawOpen.obj")
    np.testing.assert_array_equal(mesh.positions, rig.posed({"jawOpen": 1.0}))
    assert mesh.groups.names == rig.mesh.groups.names


def test_the_same_rig_gives_the_same_bytes(tmp_path: Path):
    for name in ("a", "b"):
        write_obj_folder(make_rig(), tmp_path / name)
    for file in (tmp_path / "a").iterdir():
        assert file.read_bytes() == (tmp_path / "b" / file.name).read_bytes()


def test_names_that_no_file_may_have_get_safe_ones(tmp_path: Path):
    names = ["../up", "a/b", "A/B", "neutral", "NEUTRAL", "", "...", "ü", "x" * 300]
    move = np.array([[0.0, 0.0, 1.0]])
    targets = tuple(MorphTarget(name, np.array([0], np.int32), move) for name in names)
    mesh = PolygonMesh.from_polygons(np.eye(3), [[0, 1, 2]])
    write_obj_folder(Rig(mesh, targets), tmp_path / "rig")
    files = [path.name.lower() for path in (tmp_path / "rig").iterdir()]
    assert len(set(files)) == len(names) + 2
    assert read_obj_folder(tmp_path / "rig").names == tuple(names)
    assert [path.name for path in tmp_path.iterdir()] == ["rig"]


def test_an_older_rig_is_replaced_and_nothing_of_it_stays(tmp_path: Path):
    write_obj_folder(make_rig(), tmp_path / "rig")
    write_obj_folder(make_rig().subset(["jawOpen"]), tmp_path / "rig")
    names = sorted(path.name for path in (tmp_path / "rig").iterdir())
    assert names == ["jawOpen.obj", "neutral.obj", "rig.json"]


@pytest.mark.parametrize("with_rig", [True, False])
def test_a_folder_with_other_files_is_never_replaced(tmp_path: Path, with_rig: bool):
    folder = tmp_path / "rig"
    if with_rig:
        write_obj_folder(make_rig(), folder)
    folder.mkdir(exist_ok=True)
    (folder / "precious.blend").write_bytes(b"years of work")
    with pytest.raises(FormatError, match=r"precious\.blend.*choose a new folder"):
        write_obj_folder(make_rig(), folder)
    assert (folder / "precious.blend").read_bytes() == b"years of work"


def test_a_file_in_the_way_is_never_replaced(tmp_path: Path):
    (tmp_path / "a.obj").write_bytes(b"a head")
    with pytest.raises(FormatError, match="is a file"):
        write_obj_folder(make_rig(), tmp_path / "a.obj")
    assert (tmp_path / "a.obj").read_bytes() == b"a head"


def test_folders_of_other_programs_are_read_by_name(tmp_path: Path):
    text = ObjText(make_mesh())
    (tmp_path / "Base.obj").write_bytes(text.neutral())
    moved = make_mesh().positions[:2] + 0.5
    (tmp_path / "smile.OBJ").write_bytes(text.shape(np.arange(2, dtype=np.int32), moved))
    (tmp_path / "notes.txt").write_text("x")
    with pytest.warns(RisoriusWarning, match="unit and landmarks are unknown"):
        rig = read_obj_folder(tmp_path)
    assert rig.names == ("smile",)
    assert rig.targets[0].vertices.tolist() == [0, 1]


def test_a_folder_without_a_neutral_is_refused(tmp_path: Path):
    (tmp_path / "smile.obj").write_bytes(ObjText(make_mesh()).neutral())
    with pytest.raises(FormatError, match=r"neither rig\.json nor neutral\.obj"):
        Rig.load(tmp_path)
    with pytest.raises(FormatError, match="a folder of OBJ files was expected"):
        read_obj_folder(tmp_path / "smile.obj")


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"neutral": "../x.obj"}, "is no name of a file in this folder"),
        ({"neutral": "absent.obj"}, "no such file"),
        ({"shapes": {"a": "/etc/passwd"}}, "is no name of a file in this folder"),
        ({"shapes": {"a": 1}}, "expected a text"),
        ({"shapes": {"a": "small.obj"}}, "has 1 vertices, the neutral has"),
        ({"version": 9}, "update risorius"),
        ({"part_of_vertex": [[0, 2]]}, "expected 67 values"),
    ],
)
def test_a_malformed_table_is_refused(tmp_path: Path, changes: dict, message: str):
    folder = tmp_path / "rig"
    write_obj_folder(make_rig(), folder)
    (folder / "small.obj").write_text("v 0 0 0\n")
    table = json.loads((folder / "rig.json").read_text())
    (folder / "rig.json").write_text(json.dumps({**table, **changes}))
    with pytest.raises(FormatError, match=message):
        read_obj_folder(folder)


@pytest.mark.real
@pytest.mark.parametrize(
    "name", ["ict_facekit/ict_neutral.obj", "makehuman_head/asian_male_old.obj"]
)
def test_the_real_heads_come_back_bit_by_bit(real_data: Path, name: str):
    mesh, _ = read_obj(real_data / name)
    assert_same_mesh(parse_obj(ObjText(mesh).neutral(), "x"), mesh)
