"""glTF files that are broken, cut off or made to harm: one sentence, little memory."""

import json
import tracemalloc
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import risorius.io.gltf.document
from risorius.errors import FormatError
from risorius.io.gltf import read_gltf_head, read_gltf_rig
from risorius.io.gltf.write import glb_bytes
from tests.io.glb import Maker, pack, unpack
from tests.io.rigs import make_rig
from tests.io.test_gltf_read import CORNERS, morphing

Change = Callable[[dict[str, Any]], object]
HUGE = 2**31 - 1
LARGE = {"scale": [1e30] * 3}


def accessor(key: str, value: object, index: int = 0) -> Change:
    return lambda document: document["accessors"][index].__setitem__(key, value)


def view(key: str, value: object) -> Change:
    return lambda document: document["bufferViews"][0].__setitem__(key, value)


def node(**fields: object) -> Change:
    return lambda document: document["nodes"].__setitem__(0, {"mesh": 0, **fields})


def top(key: str, value: object) -> Change:
    return lambda document: document.__setitem__(key, value)


def primitive(key: str, value: object) -> Change:
    return lambda document: document["meshes"][0]["primitives"][0].__setitem__(key, value)


def unbacked(count: int) -> Change:
    return top("accessors", [{"componentType": 5126, "count": count, "type": "VEC3"}] * 2)


def sparse(rows: list[int], **fields: object) -> Change:
    """Make the positions sparse, with row numbers that the file stores in its first bytes."""

    def change(document: dict[str, Any]) -> None:
        document["accessors"][0]["sparse"] = {
            "count": len(rows),
            "indices": {"bufferView": 1, "componentType": 5121},
            "values": {"bufferView": 0},
            **fields,
        }

    return change


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (accessor("count", 4), "4 elements from byte 0 do not fit"),
        (accessor("count", HUGE), "do not fit"),
        (accessor("count", 2**31), "must lie in"),
        (accessor("count", 0), "must lie in"),
        (accessor("count", -1), "must lie in"),
        (accessor("count", True), "whole number"),
        (accessor("count", None), "is missing"),
        (accessor("byteOffset", HUGE), "do not fit"),
        (accessor("byteOffset", -4), "must lie in"),
        (accessor("componentType", 5124), "no component type"),
        (accessor("type", "VEC2"), "expected 3 components"),
        (accessor("type", ["VEC3"]), "expected a text"),
        (accessor("bufferView", 7), r"names bufferViews\[7\], the file has"),
        (accessor("bufferView", "0"), "whole number"),
        (accessor("count", 5, index=1), "do not fit"),
        (accessor("componentType", 5126, index=1), "unsigned integers"),
        (unbacked(HUGE), "without a buffer view"),
        (view("byteLength", 1000), "lie outside its buffer"),
        (view("byteLength", HUGE), "lie outside its buffer"),
        (view("byteOffset", HUGE), "lie outside its buffer"),
        (view("byteStride", 4), "makes elements overlap"),
        (view("byteStride", HUGE), "do not fit"),
        (view("buffer", 3), r"names buffers\[3\]"),
        (view("extensions", {"EXT_meshopt_compression": {}}), "compressed with meshopt"),
        (sparse([0, 2]), "rows must rise"),
        (sparse([0] * 9), "replaces 9 of 3"),
        (sparse([0], indices={"bufferView": 1, "componentType": 5126}), "no type of an index"),
        (sparse([0], indices={"componentType": 5121}), "whole number"),
        (sparse([0], count=HUGE), "replaces"),
        (node(children=[0]), "is reached twice"),
        (node(children=[5]), r"names nodes\[5\]"),
        (node(children=["x"]), "whole number"),
        (node(children={"a": 1}), "expected a list"),
        (node(mesh=9), r"names meshes\[9\]"),
        (node(matrix=[1] * 15), "list of 16 numbers"),
        (node(rotation=[0, 0, 0, 0]), "no rotation"),
        (node(scale=["big", 1, 1]), "expected a number"),
        (node(scale=[1e300, 1, 1]), "must lie within 3e"),
        (top("nodes", [{**LARGE, "children": [1]}, {**LARGE, "mesh": 0}]), "to infinity"),
        (top("scenes", [{"nodes": [0, 0]}]), "is reached twice"),
        (top("scenes", [{"nodes": []}]), "shows no triangles"),
        (top("scene", 4), r"names scenes\[4\]"),
        (top("meshes", [{"primitives": [{}]}]), "has no POSITION"),
        (top("meshes", [{"primitives": [[]]}]), "expected a JSON object"),
        (top("meshes", "none"), "expected a list"),
        (top("asset", {"version": "1.0"}), "only 2.0 is read"),
        (top("asset", {}), "version: is missing"),
        (top("extensionsRequired", ["KHR_draco_mesh_compression"]), "compressed with Draco"),
        (top("extensionsRequired", ["EXT_meshopt_compression"]), "compressed with meshopt"),
        (top("extensionsRequired", ["EXT_mesh_gpu_instancing"]), "needs the extension"),
        (top("buffers", [{"byteLength": HUGE}]), "is it cut off"),
        (top("buffers", [{"byteLength": 60, "uri": "data:text/plain,x"}]), "base64"),
        (top("buffers", [{"byteLength": 60, "uri": "data:;base64,????"}]), "base64"),
        (top("buffers", [{"byteLength": 60, "uri": "data:;base64,AAAA"}]), "holds 3 bytes"),
        (primitive("mode", 7), "no mode"),
        (primitive("indices", 9), r"names accessors\[9\]"),
        (primitive("material", 2), r"names materials\[2\]"),
        (primitive("targets", ["x"]), "expected a JSON object"),
        (primitive("targets", [{"POSITION": 1}]), "expected 3 components"),
        (primitive("attributes", {"POSITION": 0, "TEXCOORD_0": 0}), "expected 2 components"),
        (primitive("attributes", {"POSITION": 0, "_SOURCE_VERTEX": 0}), "expected 1 comp"),
        (primitive("extras", {"targetNames": [1]}), "expected a list of texts"),
    ],
)  # fmt: skip
def test_contradictory_json_is_refused(tmp_path: Path, change: Change, message: str):
    maker = Maker()
    maker.primitive(CORNERS[:3], np.array([2, 0, 1, 0], "<u1")[:3])
    document, binary = unpack(maker.glb())
    change(document)
    path = tmp_path / "x.glb"
    path.write_bytes(pack(document, binary))
    tracemalloc.start()
    with pytest.raises(FormatError, match=message) as caught:
        read_gltf_head(path)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert str(caught.value).startswith(str(path))
    assert peak < 20e6


def test_indices_out_of_range_name_their_row(tmp_path: Path):
    maker = Maker()
    maker.primitive(CORNERS[:3], np.array([0, 1, 3], "<u2"))
    (tmp_path / "x.glb").write_bytes(maker.glb())
    with pytest.raises(FormatError, match="row 2 is 3, the primitive has 3 vertices"):
        read_gltf_head(tmp_path / "x.glb")


@pytest.mark.parametrize(
    ("count", "mode", "message"),
    [(4, 4, "4 corners make no triangles"), (2, 5, "make no triangle")],
)
def test_corners_must_make_triangles(tmp_path: Path, count: int, mode: int, message: str):
    maker = Maker()
    maker.primitive(CORNERS[:count], mode=mode)
    (tmp_path / "x.glb").write_bytes(maker.glb())
    with pytest.raises(FormatError, match=message):
        read_gltf_head(tmp_path / "x.glb")


@pytest.mark.parametrize("value", [np.nan, np.inf])
def test_numbers_that_are_not_finite_name_their_row(tmp_path: Path, value: float):
    maker = Maker()
    maker.primitive([[0, 0, 0], [0, value, 0], [1, 1, 1]])
    (tmp_path / "x.glb").write_bytes(maker.glb())
    with pytest.raises(FormatError, match=r"accessors\[0\]: row 1 is .*finite"):
        read_gltf_head(tmp_path / "x.glb")


def test_targets_of_another_length_are_refused(tmp_path: Path):
    maker = morphing()
    maker.document["accessors"][0]["count"] = 2
    (tmp_path / "x.glb").write_bytes(maker.glb())
    with pytest.raises(FormatError, match="expected 3 elements, not 2"):
        read_gltf_head(tmp_path / "x.glb")


@pytest.mark.parametrize(
    "uri",
    [
        "../secret.bin",
        "%2e%2e/secret.bin",
        "/etc/hostname",
        "file:///etc/hostname",
        "http://localhost/x.bin",
        "sub/../../secret.bin",
        "..\\secret.bin",
        "C:\\secret.bin",
        "link.bin",
        "a\0b",
        "",
    ],
)
def test_nothing_outside_the_folder_is_read(tmp_path: Path, uri: str):
    maker = Maker()
    maker.primitive(CORNERS[:3])
    folder = tmp_path / "model"
    (folder / "sub").mkdir(parents=True)
    (tmp_path / "secret.bin").write_bytes(maker.data)
    (folder / "link.bin").symlink_to(tmp_path / "secret.bin")
    document = json.loads(maker.gltf())
    document["buffers"][0]["uri"] = uri
    (folder / "x.gltf").write_text(json.dumps(document))
    with pytest.raises(FormatError, match="only files in its folder are read"):
        read_gltf_head(folder / "x.gltf")


def test_a_missing_or_self_referring_buffer_is_refused(tmp_path: Path):
    maker = Maker()
    maker.primitive(CORNERS[:3])
    path = tmp_path / "x.gltf"
    path.write_bytes(maker.gltf("absent.bin"))
    with pytest.raises(FormatError, match=r"absent\.bin: no such file"):
        read_gltf_head(path)
    document = json.loads(maker.gltf("x.gltf"))
    document["buffers"][0]["byteLength"] = 1 << 20
    path.write_text(json.dumps(document))
    with pytest.raises(FormatError, match="is it cut off"):
        read_gltf_head(path)


def test_a_long_chain_of_nodes_is_no_danger(tmp_path: Path):
    maker = Maker()
    maker.primitive(CORNERS[:3])
    count = 5000
    chain = [{"children": [i + 1]} for i in range(count)]
    maker.document["nodes"] = [*chain, {"mesh": 0, "translation": [1, 0, 0]}]
    (tmp_path / "x.glb").write_bytes(maker.glb())
    assert read_gltf_head(tmp_path / "x.glb")[0].positions[0].tolist() == [1, 0, 0]
    maker.document["nodes"][-1] = {"children": [count // 2]}
    (tmp_path / "x.glb").write_bytes(maker.glb())
    with pytest.raises(FormatError, match="is reached twice"):
        read_gltf_head(tmp_path / "x.glb")


def test_a_small_file_cannot_unfold_without_limit(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(risorius.io.gltf.document, "_MOST_VALUES", 1 << 22)
    maker = Maker()
    index = maker.accessor(np.ones((60_000, 3), "<f4"))
    primitives = [{"attributes": {"POSITION": index}}] * 2
    maker.document["meshes"][0]["primitives"] = primitives
    maker.document["nodes"] = [{"mesh": 0} for _ in range(20)]
    maker.document["scenes"][0]["nodes"] = list(range(20))
    (tmp_path / "x.glb").write_bytes(maker.glb())
    with pytest.raises(FormatError, match="unfolds to more than"):
        read_gltf_head(tmp_path / "x.glb")


def test_targets_that_cost_no_bytes_cannot_unfold_without_limit(tmp_path: Path):
    maker = Maker()
    maker.document["accessors"].append({"componentType": 5126, "count": 30_000, "type": "VEC3"})
    position = maker.accessor(np.ones((30_000, 3), "<f4"))
    targets = [{"POSITION": 0}] * 3000
    maker.document["meshes"][0]["primitives"] = [
        {"attributes": {"POSITION": position}, "targets": targets}
    ]
    (tmp_path / "x.glb").write_bytes(maker.glb())
    with pytest.raises(FormatError, match="unfolds to more than"):
        read_gltf_head(tmp_path / "x.glb")
    assert len(read_gltf_rig(tmp_path / "x.glb").targets) == 3000


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (b"", "line 1, column 1"),
        (b"[]", "expected a JSON object"),
        (b"glTF", "too few for a GLB"),
        (b"glTF" + bytes(20), "GLB version 0"),
        (b"glTF\x02\0\0\0\xff\0\0\0" + bytes(20), "the file is cut off"),
        (b"glTF\x02\0\0\0\x1c\0\0\0\xff\xff\xff\xffJSON" + bytes(8), "reaches past the end"),
        (b"glTF\x02\0\0\0\x1c\0\0\0\x08\0\0\0BIN\0" + bytes(8), "has no JSON chunk"),
        (b'{"asset":' * 50_000, "nested too deeply"),
    ],
)
def test_broken_containers_are_refused(tmp_path: Path, data: bytes, message: str):
    (tmp_path / "x.glb").write_bytes(data)
    with pytest.raises(FormatError, match=message):
        read_gltf_head(tmp_path / "x.glb")


GOOD, BINARY = unpack(glb_bytes(make_rig(), "x", animation=True, metres=True))


def places(value: object, path: tuple[object, ...] = ()) -> list[tuple[object, ...]]:
    """Return the path of every value in a JSON document."""
    items = value.items() if isinstance(value, dict) else enumerate(value)
    found: list[tuple[object, ...]] = []
    for key, inner in items:
        found.append((*path, key))
        if isinstance(inner, dict | list):
            found.extend(places(inner, (*path, key)))
    return found


PLACES = places(GOOD)
NUMBERS = [-1, 0, 1, 2, 3, 7, 255, 1e9, 2**31, 2**40, 0.5]
VALUES = st.sampled_from([None, True, *NUMBERS, "", "x", [], {}, [0], [[]]])


@given(st.lists(st.tuples(st.sampled_from(PLACES), VALUES), min_size=1, max_size=3))
@pytest.mark.filterwarnings("ignore::risorius.errors.RisoriusWarning")
def test_any_change_of_the_json_is_read_or_refused(tmp_path_factory, changes):
    document = json.loads(json.dumps(GOOD))
    for path, value in changes:
        inner: Any = document
        try:
            for key in path[:-1]:
                inner = inner[key]
            inner[path[-1]] = value
        except (KeyError, IndexError, TypeError):
            continue  # an earlier change took the place away
    path = tmp_path_factory.getbasetemp() / "mutant.glb"
    path.write_bytes(pack(document, BINARY))
    try:
        read_gltf_rig(path)
    except FormatError as error:
        assert "mutant.glb" in str(error)
