"""Reading OBJ files."""

from pathlib import Path

import numpy as np
import pytest

from risorius import _formats
from risorius.errors import FormatError, RisoriusWarning
from risorius.io.obj import parse_obj, read_obj

SQUARE = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"


def parse(text: str):
    return parse_obj(text.encode(), "x.obj")


def polygons(mesh):
    return [mesh.corners[a:b].tolist() for a, b in zip(mesh.offsets, mesh.offsets[1:])]


def uv_polygons(mesh):
    return [mesh.uv_corners[a:b].tolist() for a, b in zip(mesh.offsets, mesh.offsets[1:])]


def test_triangles_quads_and_pentagons_survive_in_file_order():
    mesh = parse(SQUARE + "v 2 2 2\nf 1 2 3\nf 1 2 3 4\nf 5 4 3 2 1\n")
    assert polygons(mesh) == [[0, 1, 2], [0, 1, 2, 3], [4, 3, 2, 1, 0]]
    assert mesh.positions[4].tolist() == [2, 2, 2]


def test_negative_indices_count_back_from_the_line_they_stand_in():
    mesh = parse(SQUARE + "vt 0 0\nvt 1 1\nf -4/-2 -3/-1 -2/-1\nv 9 9 9\nf -1 -2 -3\n")
    assert polygons(mesh) == [[0, 1, 2], [4, 3, 2]]
    assert uv_polygons(mesh) == [[0, 1, 1], [-1, -1, -1]]


@pytest.mark.parametrize(
    ("face", "uvs"),
    [
        ("f 1 2 3", None),
        ("f 1/1 2/2 3/1", [0, 1, 0]),
        ("f 1//1 2//1 3//1", None),
        ("f 1/1/1 2/2/1 3/1/1", [0, 1, 0]),
        ("f 1/1/1 2 3/1", [0, -1, 0]),
        ("f 1/1/1 2//1 3/2", [0, -1, 1]),
        ("f 1/ 2/1 3/", [-1, 0, -1]),
    ],
)
def test_every_form_of_corner_is_read(face, uvs):
    mesh = parse(SQUARE + "vt 0 0\nvt 1 0\nvn 0 0 1\n" + face + "\n")
    assert polygons(mesh) == [[0, 1, 2]]
    assert uv_polygons(mesh) == ([[]] if uvs is None else [uvs])


def test_objects_groups_and_materials_label_the_polygons_that_follow():
    mesh = parse(
        SQUARE + "f 1 2 3\no head\ng a b\nusemtl skin one\nf 1 2 3\ng eye\nf 1 2 3\n"
        "g a b\nusemtl M#2\nf 1 2 3\ng empty\n"
    )
    assert mesh.objects.names == ("head",)
    assert mesh.objects.of_polygon.tolist() == [-1, 0, 0, 0]
    assert mesh.groups.names == ("a b", "eye")
    assert mesh.groups.of_polygon.tolist() == [-1, 0, 1, 0]
    assert mesh.materials.names == ("skin one", "M#2")
    assert mesh.materials.of_polygon.tolist() == [-1, 0, 0, 1]


def test_line_endings_comments_and_continuations_do_not_change_the_mesh():
    plain = parse(SQUARE + "f 1 2 3 4\n")
    odd = (
        "\ufeff# made by hand\r\n" + SQUARE.replace("\n", "   # note\r\n") + "f 1 2 \\\r\n 3 4\r\n"
    )
    mesh = parse(odd)
    assert polygons(mesh) == polygons(plain)
    np.testing.assert_array_equal(mesh.positions, plain.positions)
    mac = parse(SQUARE.replace("\n", "\r") + "\tf\t1 2\t3 4\r")
    assert polygons(mac) == polygons(plain)


def test_a_continued_line_does_not_shift_the_line_numbers_of_messages():
    with pytest.raises(FormatError, match="line 7: 'f 1 2 x'"):
        parse(SQUARE + "f 1 \\\n 2 3\nf 1 2 x\n")


def test_weights_and_vertex_colours_are_tolerated():
    mesh = parse("v 0 0 0 1\nv 1 0 0 .5 .5 .5\nv 0 1 0\nf 1 2 3\n")
    assert mesh.positions.tolist() == [[0, 0, 0], [1, 0, 0], [0, 1, 0]]


def test_texture_coordinates_may_have_one_to_three_numbers():
    mesh = parse(SQUARE + "vt .5\nvt .25 .75\nvt .1 .2 0\nf 1/1 2/2 3/3\n")
    assert mesh.uvs.tolist() == [[0.5, 0], [0.25, 0.75], [0.1, 0.2]]


def test_faces_may_stand_before_their_vertices():
    assert polygons(parse("f 1 2 3\n" + SQUARE)) == [[0, 1, 2]]


def test_loose_vertices_are_kept():
    assert parse(SQUARE + "v 7 7 7\nf 1 2 3\n").vertex_count == 5


def test_lines_points_and_curves_are_left_out_with_a_note():
    with pytest.warns(RisoriusWarning, match="2 'l', 1 'p'"):
        mesh = parse(SQUARE + "l 1 2\nl 2 3\np 1\nf 1 2 3\n")
    assert polygons(mesh) == [[0, 1, 2]]


def test_a_block_border_does_not_matter():
    count = 70_000
    rows = "".join(f"v {i} 0 0\n" for i in range(count))
    mesh = parse(rows + "".join(f"f {i} {i + 1} {i + 2}\n" for i in range(1, count - 1)))
    np.testing.assert_array_equal(mesh.positions[:, 0], np.arange(count))
    np.testing.assert_array_equal(mesh.triangles[:, 0], np.arange(count - 2))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "has no vertices"),
        ("v 0 0\n", "line 1: expected 3 to 8 numbers after 'v', found 2"),
        ("v 0 0 nan\n", "line 1: 'v 0 0 nan' must hold finite numbers"),
        (SQUARE + "v 1e999 0 0\n", "line 5: .*finite"),
        (SQUARE + "v 1_0 0 0\n", "line 5: .*finite"),
        (SQUARE + "v a 0 0\n", "line 5: .*finite"),
        (SQUARE + "f\n", "line 5: a polygon .* without corners"),
        (SQUARE + "f 1 2 3\nf 1 2 5\n", "line 6: names a vertex that does not exist .*has 4"),
        (SQUARE + "f 1 2 -5\n", "line 5: names a vertex"),
        (SQUARE + "f 1/1 2/1 3/1\n", "line 5: names a texture coordinate"),
        (SQUARE + "f 0 1 2\n", "line 5: .* count from 1"),
        (SQUARE + "f 1/0 2/0 3/0\n", "line 5: .* count from 1"),
        (SQUARE + "f 1 2 3/1/1/1\n", "line 5: .* must hold corners"),
        (SQUARE + f"f 1 2 {10**30}\n", "line 5: .* must hold corners"),
        (SQUARE + f"f 1 2 {'9' * 6000}\n", "line 5: .* must hold corners"),
        (SQUARE + "f 1.5 2 3\n", "line 5: .* must hold corners"),
        (SQUARE + "facet 1 2 3\n", "line 5: 'facet' is no OBJ statement"),
        ("v 0 0 0\0\n", "byte 7 is zero"),
    ],
)
def test_malformed_text_is_refused_with_its_line(text, message):
    with pytest.raises(FormatError, match=f"^x.obj: {message}"):
        parse(text)


def test_a_missing_file_is_named(tmp_path: Path):
    with pytest.raises(FormatError, match="no such file"):
        _formats.read_head(tmp_path / "absent.obj")
    with pytest.raises(FormatError, match="is a folder"):
        read_obj(tmp_path)


def test_the_registry_reads_obj_whatever_the_case_of_the_ending(tmp_path: Path):
    path = tmp_path / "SQUARE.OBJ"
    path.write_text(SQUARE + "f 1 2 3 4\n")
    mesh, landmarks = _formats.read_head(path)
    assert mesh.vertex_count == 4
    assert landmarks == {}


@pytest.mark.real
def test_the_reference_heads_keep_counts_groups_and_order(real_data: Path):
    mesh, _ = read_obj(real_data / "ict_facekit" / "ict_neutral.obj")
    archive = np.load(real_data / "ict_facekit" / "ict_facekit.npz", allow_pickle=False)
    assert (mesh.vertex_count, mesh.polygon_count, len(mesh.uvs)) == (25959, 25772, 28151)
    assert mesh.groups.names[0] == "skin"
    assert len(mesh.groups.names) == 8
    assert np.abs(mesh.positions[:9409] - archive["vertices"][:9409]).max() < 1e-3
