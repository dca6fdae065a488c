"""Reading PLY files."""

import struct
import tracemalloc
from pathlib import Path

import numpy as np
import pytest
import trimesh

from risorius import _formats
from risorius.errors import FormatError
from risorius.io.ply import parse_ply
from tests.io.rigs import make_mesh

POINTS = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0.5], [2, 2, 2]]
POLYGONS = [[0, 1, 2], [0, 2, 3], [0, 1, 2, 3], [4, 3, 2, 1, 0], [1, 2, 3]]
HEADER = """ply
format {order} 1.0
comment made by hand
element vertex 5
property {real} x
property {real} y
property {real} z
property uchar red
element face 5
property uchar flag
property list {size} {index} vertex_indices
property float area
end_header
"""


def ascii_ply() -> bytes:
    rows = [" ".join(map(str, [*point, 255])) for point in POINTS]
    rows += [" ".join(map(str, [7, len(p), *p, 1.5])) for p in POLYGONS]
    header = HEADER.format(order="ascii", real="double", size="uchar", index="int")
    return (header + "\n".join(rows) + "\n").encode()


def binary_ply(mark: str = "<", *, real: str = "float", size: str = "uchar", index: str = "int"):
    codes = {"float": "f", "double": "d", "uchar": "B", "int": "i", "uint": "I", "ushort": "H"}
    order = {"<": "binary_little_endian", ">": "binary_big_endian"}[mark]
    body = b"".join(struct.pack(mark + 3 * codes[real] + "B", *point, 255) for point in POINTS)
    for p in POLYGONS:
        form = f"{mark}B{codes[size]}{len(p)}{codes[index]}f"
        body += struct.pack(form, 7, len(p), *p, 1.5)
    return HEADER.format(order=order, real=real, size=size, index=index).encode() + body


def polygons(mesh):
    return [mesh.corners[a:b].tolist() for a, b in zip(mesh.offsets, mesh.offsets[1:])]


@pytest.mark.parametrize(
    "data",
    [
        ascii_ply(),
        ascii_ply().replace(b"\n", b"\r\n"),
        binary_ply("<"),
        binary_ply(">"),
        binary_ply("<", real="double", size="int", index="uint"),
        binary_ply(">", size="ushort", index="ushort"),
    ],
)
def test_polygons_of_mixed_size_keep_order_in_every_encoding(data: bytes):
    mesh = parse_ply(data, "x.ply")
    assert polygons(mesh) == POLYGONS
    np.testing.assert_array_equal(mesh.positions, POINTS)
    assert not len(mesh.uvs)


@pytest.mark.parametrize("encoding", ["ascii", "binary"])
def test_files_of_another_library_are_read(tmp_path: Path, encoding: str):
    mesh = make_mesh()
    other = trimesh.Trimesh(mesh.positions, mesh.triangles, process=False)
    path = tmp_path / "a.ply"
    path.write_bytes(trimesh.exchange.ply.export_ply(other, encoding=encoding))
    found, landmarks = _formats.read_head(path)
    np.testing.assert_allclose(found.positions, mesh.positions, atol=1e-6)
    np.testing.assert_array_equal(found.triangles, mesh.triangles)
    assert landmarks == {}


@pytest.mark.parametrize("names", [("u", "v"), ("s", "t"), ("texture_u", "texture_v")])
def test_texture_coordinates_of_vertices_are_read(names: tuple[str, str]):
    text = (
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
        f"property float z\nproperty float {names[0]}\nproperty float {names[1]}\n"
        "element face 1\nproperty list uchar int vertex_index\nend_header\n"
        "0 0 0 .1 .2\n1 0 0 .3 .4\n0 1 0 .5 .6\n3 2 1 0\n"
    )
    mesh = parse_ply(text.encode(), "x")
    np.testing.assert_allclose(mesh.uvs[mesh.uv_corners], [[0.5, 0.6], [0.3, 0.4], [0.1, 0.2]])


def test_texture_coordinates_of_corners_are_read():
    text = (
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
        "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
        "property list uchar float texcoord\nend_header\n"
        "0 0 0\n1 0 0\n0 1 0\n3 2 1 0 6 .1 .2 .3 .4 .5 .6\n"
    )
    mesh = parse_ply(text.encode(), "x")
    np.testing.assert_allclose(mesh.uvs[mesh.uv_corners], [[0.1, 0.2], [0.3, 0.4], [0.5, 0.6]])


def test_points_without_polygons_are_read():
    text = ascii_ply().split(b"element face")[0] + b"end_header\n" + b"0 0 0 0\n" * 5
    assert parse_ply(text, "x").polygon_count == 0


def replaced(old: str, new: str) -> bytes:
    text = ascii_ply().decode()
    assert old in text
    return text.replace(old, new).encode()


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (b"", "has no PLY header"),
        (b"ply\nformat ascii 1.0\n", "has no PLY header"),
        (replaced("format ascii 1.0", ""), "names no format"),
        (replaced("format ascii 1.0", "format ascii 2.0"), "line 2: .* no PLY header line"),
        (replaced("element vertex 5", "element vertex -5"), "line 4: .* no PLY header line"),
        (replaced("element vertex 5", "element vertex " + "9" * 30), "no PLY header line"),
        (replaced("element vertex 5", "element vertex 1000000000"), "claims 1000000000 rows"),
        (replaced("element face 5", "element face 1000000000"), "claims 1000000000 rows"),
        (replaced("element face 5", "element face 6"), "claims 6 rows|the file ends|bad list"),
        (replaced("property double x", "property quad x"), "line 5: .* no PLY header line"),
        (replaced("property double y", "property double x"), "line 6: .* no PLY header line"),
        (replaced("property double y", "property double yy"), "no vertices with x, y and z"),
        (replaced("list uchar int vertex_indices", "list uchar int corners"), "no list"),
        (replaced("comment made", "remark made"), "line 3: .* no PLY header line"),
        (replaced("1 1 0 255", "1 nan 0 255"), "row 2 is .* must be finite"),
        (replaced("1 1 0 255", "1 one 0 255"), "must be numbers"),
        (replaced("7 3 0 1 2 1.5", "7 3 0 1 5 1.5"), "polygon 0 names vertex 5, the file has 5"),
        (replaced("7 3 0 2 3 1.5", "7 3 0 2 -3 1.5"), "polygon 1 names vertex -3"),
        (replaced("7 3 0 1 2 1.5", "7 3 0 1 1.5 1.5"), "polygon 0 names vertex 1.5"),
        (replaced("7 3 0 1 2 1.5", "7 -3 0 1 2 1.5"), "row 0 of 'face': bad list"),
        (replaced("7 3 0 1 2 1.5", "7 2.5 0 1 2 1.5"), "row 0 of 'face': bad list"),
        (replaced("7 3 0 1 2 1.5", "7 999999999 0 1 2 1.5"), "row 0 of 'face': bad list"),
        (binary_ply()[:-1], "row 4 of 'face': the file ends"),
        (binary_ply()[:-70], "the file ends|claims"),
    ],
)
def test_malformed_files_are_refused(data: bytes, message: str):
    tracemalloc.start()
    with pytest.raises(FormatError, match=f"^x.ply: .*({message})"):
        parse_ply(data, "x.ply")
    assert tracemalloc.get_traced_memory()[1] < 1e6
    tracemalloc.stop()


def test_an_element_of_nothing_may_claim_any_number_of_rows():
    data = replaced("element face 5", "element ghost 1000000000000000\nelement face 5")
    assert polygons(parse_ply(data, "x")) == POLYGONS
