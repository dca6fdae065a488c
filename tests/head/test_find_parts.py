from __future__ import annotations

import numpy as np
import pytest

from risorius.errors import MeshError, ParameterError, RisoriusWarning
from risorius.head.find_parts import assign_parts
from risorius.head.part import PART_KINDS
from risorius.landmarks import LandmarkSpec, resolve
from risorius.mesh.polygon_mesh import PolygonMesh
from tests.synthetic import Piece, arch, assemble, exploded, head_pieces, head_specs, placed_specs

PIECES = head_pieces("bag")


def _kinds(pieces: dict[str, Piece], *, specs=None, names=None, given=None) -> dict[str, str]:
    """Return the kind found for each piece; a piece has one kind."""
    mesh = assemble(pieces, names=names)
    found = _assign(mesh, specs or head_specs("bag"), given)
    ends = np.cumsum([len(polygons) for _, polygons in pieces.values()])
    result = {}
    for name, part in zip(pieces, np.split(found, ends[:-1])):
        assert len(set(part.tolist())) == 1, name
        result[name] = PART_KINDS[part[0]]
    return result


def _assign(mesh: PolygonMesh, specs, given=None) -> np.ndarray:
    marks = resolve(specs, mesh)
    return assign_parts(mesh, mesh.positions, marks, given=given)


def test_without_any_name_geometry_tells_the_parts() -> None:
    assert _kinds(PIECES) == {name: name for name in PIECES}


def test_the_order_of_the_pieces_does_not_matter() -> None:
    skin_first = {"skin": PIECES["skin"], **dict(reversed(PIECES.items()))}
    assert _kinds(skin_first) == {name: name for name in PIECES}


def test_names_are_believed_where_they_speak() -> None:
    names = {"tongue": "gums_lower", "teeth_upper": "TeethLower", "eye_left": "Eye.R"}
    found = _kinds(PIECES, names=names)
    assert found["tongue"] == "gums"
    assert found["teeth_upper"] == "teeth_lower"
    assert found["eye_left"] == "eye_right"


def test_names_without_a_side_are_completed_by_geometry() -> None:
    names = {
        "eye_left": "eyes", "eye_right": "eyes", "teeth_upper": "teeth", "teeth_lower": "teeth"
    }  # fmt: skip
    assert _kinds(PIECES, names=names) == {name: name for name in PIECES}


def test_loose_pieces_inside_a_mesh_named_head_are_told_apart() -> None:
    names = dict.fromkeys(PIECES, "Head")
    assert _kinds(PIECES, names=names) == {name: name for name in PIECES}


def test_seams_do_not_break_the_skin_into_pieces() -> None:
    pieces = {name: exploded(piece) for name, piece in PIECES.items()}
    assert _kinds(pieces, specs=placed_specs("bag")) == {name: name for name in PIECES}


def test_a_hand_given_part_beats_its_name() -> None:
    names = {"tongue": "blob", "teeth_upper": "teeth_upper"}
    found = _kinds(PIECES, names=names, given={"gums": "teeth_upper", "tongue": "blob"})
    assert found["teeth_upper"] == "gums"
    assert found["tongue"] == "tongue"


def test_a_mouth_bag_with_a_name_of_its_own_is_a_part_of_its_own() -> None:
    pieces = PIECES | {"bag": arch(height=-73.0, half_width=15.0)}
    assert _kinds(pieces, names={"bag": "mouth_inside"})["bag"] == "mouth_inside"


def test_a_part_kind_that_does_not_exist_is_refused() -> None:
    mesh = assemble(PIECES)
    with pytest.raises(ParameterError, match="part: 'nose' is not one of skin, eye_left"):
        _assign(mesh, head_specs("bag"), {"nose": "head"})


def test_an_object_that_does_not_exist_is_refused_with_those_that_do() -> None:
    mesh = assemble(PIECES, names={"tongue": "Zunge", "skin": "Kopf"})
    with pytest.raises(ParameterError, match="nothing in the file is named 'tongue'; it has Kopf,"):
        _assign(mesh, head_specs("bag"), {"tongue": "tongue"})
    with pytest.raises(ParameterError, match="it has no names"):
        _assign(assemble(PIECES), head_specs("bag"), {"tongue": "tongue"})


def test_landmarks_that_lie_on_no_skin_are_refused_with_the_way_out() -> None:
    names = dict.fromkeys(PIECES, "eye_left")
    with pytest.raises(MeshError, match="name it by hand with --part skin=NAME"):
        _assign(assemble(PIECES, names=names), head_specs("bag"))


def test_landmarks_on_several_pieces_are_warned_of() -> None:
    mesh = assemble(PIECES)
    first = len(PIECES["skin"][0])
    specs = head_specs("bag")
    moved = list(specs)[::2]
    specs |= {name: LandmarkSpec(vertex=first + k) for k, name in enumerate(moved)}
    with pytest.warns(RisoriusWarning, match="the skin landmarks lie on several loose pieces"):
        _assign(mesh, specs)
