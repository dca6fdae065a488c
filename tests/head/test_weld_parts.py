from __future__ import annotations

import numpy as np
import pytest

from risorius.errors import RisoriusWarning
from risorius.head.part import PART_KINDS, Part
from risorius.head.weld_parts import build_parts
from risorius.landmarks import LandmarkSet, LandmarkSpec, resolve
from tests.synthetic import (
    Piece,
    assemble,
    exploded,
    face_sheet,
    head_pieces,
    head_specs,
    placed_specs,
    slit_sheet,
    sphere,
)

SKIN = PART_KINDS.index("skin")


def _parts(piece: Piece, specs) -> tuple[dict[str, Part], LandmarkSet]:
    mesh = assemble({"skin": piece})
    marks = resolve(specs, mesh)
    kinds = np.full(mesh.polygon_count, SKIN, np.int32)
    return build_parts(mesh, mesh.positions, kinds, marks), marks


def test_a_mesh_without_seams_stays_as_it_is() -> None:
    piece = head_pieces("bag")["skin"]
    skin = _parts(piece, head_specs("bag"))[0]["skin"]
    np.testing.assert_array_equal(skin.mesh.positions, piece[0])
    np.testing.assert_array_equal(skin.mesh.faces, piece[1])
    np.testing.assert_array_equal(skin.source, skin.welded)


def test_an_exploded_mesh_is_joined_again() -> None:
    piece = head_pieces("bag")["skin"]
    skin = _parts(exploded(piece), placed_specs("bag"))[0]["skin"]
    assert skin.vertex_count == len(piece[0])
    assert len(skin.source) == 3 * len(piece[1])
    corners = skin.mesh.positions[skin.mesh.faces]
    np.testing.assert_array_equal(corners, piece[0][np.array(piece[1])])


def test_the_way_back_reaches_every_input_vertex() -> None:
    piece = exploded(head_pieces("bag")["skin"])
    skin = _parts(piece, placed_specs("bag"))[0]["skin"]
    out = np.full((len(piece[0]), 3), np.nan)
    skin.spread(skin.mesh.positions, out)
    np.testing.assert_array_equal(out, piece[0])
    first = skin.first_source()
    np.testing.assert_array_equal(piece[0][first], skin.mesh.positions)
    back = skin.from_source(first, vertex_count=len(piece[0]))
    np.testing.assert_array_equal(back, np.arange(skin.vertex_count))


def test_parts_are_compact_and_know_their_input_vertices() -> None:
    pieces = {"skin": head_pieces()["skin"], "ball": sphere((31.5, 0.0, 52.0), (12.0,) * 3)}
    mesh = assemble(pieces)
    kinds = np.full(mesh.polygon_count, PART_KINDS.index("eye_left"), np.int32)
    kinds[: len(pieces["skin"][1])] = SKIN
    parts = build_parts(mesh, mesh.positions, kinds, resolve(head_specs(), mesh))
    assert list(parts) == ["skin", "eye_left"]
    eye, count = parts["eye_left"], len(pieces["skin"][0])
    np.testing.assert_array_equal(eye.source, count + np.arange(len(pieces["ball"][0])))
    np.testing.assert_array_equal(eye.mesh.positions, pieces["ball"][0])
    asked = eye.from_source([0, count, count + 5], vertex_count=mesh.vertex_count)
    assert asked.tolist() == [-1, 0, 5]


def test_vertices_that_no_face_uses_belong_to_no_part() -> None:
    points, polygons = head_pieces()["skin"]
    stray = (np.concatenate([points, [[0.0, 0.0, 0.0]]]), polygons)
    skin = _parts(stray, head_specs())[0]["skin"]
    assert len(points) not in skin.source


def test_lips_that_touch_stay_apart_while_seams_are_joined() -> None:
    sheet = slit_sheet(
        "slit", half_width=22.0, opening=0.0, height=-72.25, margin_cells=(14, 32, 18)
    )
    points = sheet.mesh.positions
    np.testing.assert_array_equal(points[sheet.upper], points[sheet.lower])
    specs = head_specs("slit")
    upper, lower = sheet.middles
    specs |= {"2.2": LandmarkSpec(vertex=upper), "2.3": LandmarkSpec(vertex=lower)}
    piece = (points, [tuple(face) for face in sheet.mesh.faces.tolist()])
    skin = _parts(piece, specs)[0]["skin"]
    assert skin.vertex_count == len(points)
    assert (skin.welded[sheet.upper[1:-1]] != skin.welded[sheet.lower[1:-1]]).all()


def test_lips_that_touch_are_welded_if_the_landmarks_name_one_vertex_for_both() -> None:
    sheet = slit_sheet(
        "slit", half_width=22.0, opening=0.0, height=-72.25, margin_cells=(14, 32, 18)
    )
    specs = head_specs("slit")
    specs |= {"2.2": LandmarkSpec(vertex=sheet.middles[0])}
    specs |= {"2.3": LandmarkSpec(vertex=sheet.middles[0])}
    piece = (sheet.mesh.positions, [tuple(face) for face in sheet.mesh.faces.tolist()])
    skin = _parts(piece, specs)[0]["skin"]
    np.testing.assert_array_equal(skin.welded[sheet.upper], skin.welded[sheet.lower])


def test_the_landmarks_of_the_made_up_face_are_on_it() -> None:
    _, marks = _parts(head_pieces("bag")["skin"], head_specs("bag"))
    sheet = face_sheet("bag")
    assert marks.vertex("2.4") == sheet.corners[0]
    assert marks.position("2.4")[0] > 0.0


def test_a_head_turned_inside_out_has_the_same_parts_with_a_warning() -> None:
    points, polygons = head_pieces("bag")["skin"]
    turned = (points, [polygon[::-1] for polygon in polygons])
    with pytest.warns(RisoriusWarning, match="its faces look inwards"):
        skin = _parts(turned, head_specs("bag"))[0]["skin"]
    expected = _parts((points, polygons), head_specs("bag"))[0]["skin"]
    np.testing.assert_array_equal(skin.mesh.positions, expected.mesh.positions)
    np.testing.assert_array_equal(np.sort(skin.mesh.faces), np.sort(expected.mesh.faces))
    normals = np.cross(*np.diff(skin.mesh.positions[skin.mesh.faces], axis=1).swapaxes(0, 1))
    assert normals[:, 2].sum() > 0.0
