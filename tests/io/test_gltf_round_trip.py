"""GLB files of our own come back as they were, also after other programs had them."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from risorius import _formats
from risorius.errors import FormatError, RisoriusWarning
from risorius.io.gltf import read_gltf_head, read_gltf_landmarks, read_gltf_rig, write_glb
from risorius.io.gltf.write import glb_bytes
from risorius.rig.rig import Rig
from tests.io.glb import pack, unpack
from tests.io.rigs import assert_same_rig, make_rig, make_seam_rig

FLOAT32 = 2e-7


@pytest.mark.parametrize("options", [{}, {"animation": True}, {"metres": True}])
def test_a_rig_comes_back_whole(tmp_path: Path, options: dict[str, bool]):
    rig = make_rig()
    path = tmp_path / "a.glb"
    write_glb(rig, path, **options)
    assert_same_rig(read_gltf_rig(path), rig, rounding=FLOAT32)


def test_a_rig_without_texture_parts_and_names_comes_back(tmp_path: Path):
    rig = make_seam_rig(apart=True)
    rig = replace(rig, part_names=(), part_of_vertex=np.zeros(0, np.int32))
    write_glb(rig, tmp_path / "a.glb")
    assert_same_rig(read_gltf_rig(tmp_path / "a.glb"), rig, rounding=FLOAT32)


def test_writing_again_changes_nothing(tmp_path: Path):
    write_glb(make_rig(), tmp_path / "a.glb")
    first = read_gltf_rig(tmp_path / "a.glb")
    write_glb(first, tmp_path / "b.glb")
    assert_same_rig(read_gltf_rig(tmp_path / "b.glb"), first, rounding=0.0)


def test_the_registry_saves_and_loads_rigs(tmp_path: Path):
    make_rig().save(tmp_path / "a.GLB")
    assert Rig.load(tmp_path / "a.GLB").names == ("mouthSmileLeft", "jawOpen", "noseSneer")


def test_a_head_comes_back_with_landmarks_and_targets(tmp_path: Path):
    rig = make_rig()
    write_glb(rig, tmp_path / "a.glb")
    mesh, landmarks = read_gltf_head(tmp_path / "a.glb")
    assert landmarks == rig.landmarks
    assert read_gltf_landmarks(tmp_path / "a.glb") == rig.landmarks
    assert tuple(mesh.targets) == rig.names
    expected = rig.targets[1].dense(rig.mesh.vertex_count)
    np.testing.assert_allclose(mesh.targets["jawOpen"], expected, atol=FLOAT32)


def rewritten(tmp_path: Path, change: Callable[[dict[str, Any]], object]) -> Path:
    document, binary = unpack(glb_bytes(make_rig(), "x", metres=True))
    change(document)
    path = tmp_path / "b.glb"
    path.write_bytes(pack(document, binary))
    return path


def drop_views(document: dict[str, Any]) -> None:
    for view in document["bufferViews"]:
        view.pop("name", None)


def test_without_the_stored_polygons_triangles_keep_vertices_and_targets(tmp_path: Path):
    path = rewritten(tmp_path, drop_views)
    with pytest.warns(RisoriusWarning, match=r"triangles where the input had polygons.*2\.2"):
        found = read_gltf_rig(path)
    rig = make_rig()
    np.testing.assert_allclose(found.mesh.positions, rig.mesh.positions, atol=10 * FLOAT32)
    assert found.mesh.polygon_count == len(rig.mesh.triangles)
    assert set(found.landmarks) == {"2.1", "8.3"}
    np.testing.assert_array_equal(found.by_name["jawOpen"].vertices, rig.targets[1].vertices)


def test_without_the_input_vertices_the_file_is_a_foreign_one(tmp_path: Path):
    def change(document: dict[str, Any]) -> None:
        for mesh in document["meshes"]:
            for primitive in mesh["primitives"]:
                del primitive["attributes"]["_SOURCE_VERTEX"]

    path = rewritten(tmp_path, change)
    with pytest.warns(RisoriusWarning, match="another program has changed the mesh"):
        found = read_gltf_rig(path)
    assert found.landmarks == {}
    assert found.names == make_rig().names
    assert found.frame.unit == "m"
    # The root node is obeyed like any other: metres, upright.
    rig = make_rig()
    expected = rig.frame.to_canonical(rig.mesh.positions[0]) / 1000
    assert np.abs(found.mesh.positions - expected).sum(axis=1).min() < 1e-6


BLOCK = "asset.extras.risorius"


@pytest.mark.parametrize(
    ("key", "value", "message"),
    [
        ("schema", "x", 'expected "schema": "risorius/rig"'),
        ("version", 2, "reads up to version 1; update risorius"),
        ("frame", {"unit": "mm"}, f"{BLOCK}.frame.rotation: expected a list of 9"),
        ("controls", [{"group": "wings"}], "expected one of muscle"),
        ("controls", ["x"], "expected a JSON object"),
        ("poses", {"jawOpen": {"jaw_pitch": "wide"}}, "expected a number"),
        ("left_out", {"tongueOut": 1}, "expected a text"),
        ("parts", [1], "expected a list of texts"),
        ("landmarks", {"2.1": {"vertex": 1.5}}, "expected a whole number"),
    ],
)
def test_a_malformed_block_of_our_own_is_refused(
    tmp_path: Path, key: str, value: object, message: str
):
    def change(document: dict[str, Any]) -> None:
        document["asset"]["extras"]["risorius"][key] = value

    with pytest.raises(FormatError, match=message):
        read_gltf_rig(rewritten(tmp_path, change))


@pytest.mark.parametrize(
    ("key", "value", "message"),
    [
        ("vertex_count", 2**31 - 1, "more than the file holds"),
        ("vertex_count", 10, "a vertex of the input is beyond 10"),
        ("loose", [1], r"input vertex 49 is missing"),
        ("loose_positions", [1.0], "more than the file holds"),
        ("sizes", 1.5, "whole number"),
        ("objects", {"names": ["a"], "runs": [[0, 2**31 - 1]]}, "expected .* values"),
        ("objects", {"names": ["a"], "runs": [[7, 45]]}, "expected 45 values up to 0"),
        ("objects", {"names": ["a"], "runs": [[0]]}, "pairs of value and length"),
        ("part_of_vertex", [[3, 67]], "expected 67 values up to 2"),
    ],
)
def test_contradictions_in_the_stored_topology_are_refused(
    tmp_path: Path, key: str, value: object, message: str
):
    def change(document: dict[str, Any]) -> None:
        document["asset"]["extras"]["risorius"]["topology"][key] = value

    with pytest.raises(FormatError, match=message):
        read_gltf_rig(rewritten(tmp_path, change))


def test_a_file_without_landmarks_is_no_landmark_file(tmp_path: Path):
    write_glb(make_seam_rig(apart=True), tmp_path / "a.glb")
    with pytest.raises(FormatError, match="carries no landmarks"):
        _formats.read_landmarks(tmp_path / "a.glb")
