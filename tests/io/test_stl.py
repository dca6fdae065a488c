"""Reading STL files."""

from pathlib import Path

import numpy as np
import pytest
import trimesh

from risorius import _formats
from risorius.errors import FormatError
from risorius.io.stl import parse_stl
from tests.io.rigs import EYE, make_mesh


def cube() -> trimesh.Trimesh:
    mesh = make_mesh()
    faces = mesh.triangles[np.isin(mesh.triangles, EYE).all(axis=1)] - EYE[0]
    return trimesh.Trimesh(mesh.positions[EYE], faces, process=False)


BINARY = trimesh.exchange.stl.export_stl(cube())
ASCII = trimesh.exchange.stl.export_stl_ascii(cube()).encode()


@pytest.mark.parametrize("data", [BINARY, ASCII, ASCII.replace(b"\n", b"\r\n"), BINARY + b"pad"])
def test_equal_corners_become_one_vertex_in_order_of_appearance(tmp_path: Path, data: bytes):
    path = tmp_path / "a.stl"
    path.write_bytes(data)
    mesh, landmarks = _formats.read_head(path)
    assert mesh.vertex_count == 8
    np.testing.assert_allclose(mesh.positions[mesh.triangles], cube().triangles, atol=1e-6)
    first = np.unique(mesh.corners, return_index=True)[1]
    assert (np.diff(first) > 0).all()
    assert landmarks == {}


def test_corners_that_differ_in_the_last_digit_stay_apart():
    data = bytearray(BINARY)
    data[84 + 12] ^= 1
    assert parse_stl(bytes(data), "x").vertex_count == 9


def test_a_binary_file_may_begin_with_the_word_solid():
    assert parse_stl(b"solid" + BINARY[5:], "x").vertex_count == 8


def test_zero_and_minus_zero_are_one_place():
    rows = "facet\nvertex {} 0 0\nvertex 1 0 0\nvertex 0 1 0\nendfacet\n"
    text = "solid x\n" + rows.format("0") + rows.format("-0.0") + "endsolid x\n"
    assert parse_stl(text.encode(), "x").vertex_count == 3


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (b"", "are no binary STL"),
        (BINARY[:-1], r"of 12 triangles \(684 bytes\)"),
        (BINARY[:80] + b"\xff\xff\xff\xff" + BINARY[84:], "of 4294967295 triangles"),
        (bytes(84), "has no triangles"),
        (ASCII[:-100], "does not end with 'endsolid'"),
        (ASCII.replace(b"vertex", b"corner", 1), "35 vertices do not make 12 triangles"),
        (ASCII.replace(b"endfacet", b"", 1), "36 vertices do not make 11 triangles"),
        (b"solid\nvertex a b c\nendsolid", "'vertex a b c' is not three numbers"),
        (ASCII.replace(b"vertex ", b"vertex nan ", 1), "corner 0 .* must be finite"),
        (BINARY[:96] + np.array([np.inf], "<f4").tobytes() + BINARY[100:], "corner 0 .* finite"),
    ],
)
def test_malformed_files_are_refused(data: bytes, message: str):
    with pytest.raises(FormatError, match=f"^x.stl: .*{message}"):
        parse_stl(data, "x.stl")
