from __future__ import annotations

import numpy as np
import pytest

from risorius.anatomy.jaw import JawPose
from risorius.anatomy.mechanics import Mechanics
from risorius.errors import LandmarkError, MeshError
from risorius.head import Head
from tests.face_fixtures import builtin_face, made_up_head, made_up_mechanics, mirror_vertices
from tests.synthetic import (
    assemble,
    exploded,
    face_sheet,
    head_pieces,
    head_specs,
    placed_specs,
)

NEUTRAL = np.zeros((builtin_face().head.skin.vertex_count, 3))
MECHANICS = builtin_face().mechanics


def _names(mechanics: Mechanics) -> set[str]:
    return {control.name for control in mechanics.controls}


def test_nothing_moves_at_rest() -> None:
    np.testing.assert_array_equal(MECHANICS.pose(NEUTRAL, {}), 0.0)
    at_rest = {control.name: control.default for control in MECHANICS.controls}
    np.testing.assert_array_equal(MECHANICS.pose(NEUTRAL, at_rest), 0.0)


def test_each_device_moves_something_at_both_ends_of_its_range() -> None:
    assert len(MECHANICS.controls) == 17
    for control in MECHANICS.controls:
        for value in {control.low, control.high} - {control.default}:
            moved = MECHANICS.pose(NEUTRAL, {control.name: value})
            assert np.isfinite(moved).all()
            assert np.linalg.norm(moved, axis=1).max() > 0.4, control.name


def test_devices_of_the_right_mirror_those_of_the_left() -> None:
    skin = MECHANICS.head.skin
    partner = mirror_vertices(skin.mesh.positions)
    for control in MECHANICS.controls:
        value = 0.6 * control.high
        one = MECHANICS.pose(NEUTRAL, {control.name: value})[skin.first_source()]
        two = MECHANICS.pose(NEUTRAL, {control.mirror: control.mirror_sign * value})
        mirrored = two[skin.first_source()][partner] * [-1.0, 1.0, 1.0]
        np.testing.assert_allclose(mirrored, one, atol=1e-6)


def test_the_vertices_of_a_texture_seam_move_as_one() -> None:
    pieces = head_pieces("bag")
    pieces["skin"] = exploded(pieces["skin"])
    head = Head.from_mesh(assemble(pieces), placed_specs("bag"))
    skin, whole = head.skin, made_up_mechanics()
    assert skin.vertex_count == whole.head.skin.vertex_count < len(skin.source) / 2
    rest = np.zeros((skin.vertex_count, 3))
    moved = Mechanics.build(head).pose(rest, {"jaw_pitch": 11.0})
    first = moved[skin.first_source()]
    np.testing.assert_array_equal(moved[skin.source], first[skin.welded])
    expected = whole.pose(rest, {"jaw_pitch": 11.0})
    assert np.abs(first).max() == pytest.approx(np.abs(expected).max(), rel=1e-6)


def test_the_skin_takes_the_displacement_of_the_muscles() -> None:
    skin = MECHANICS.head.skin
    push = np.zeros_like(NEUTRAL)
    push[7] = (1.0, 2.0, 3.0)
    moved = MECHANICS.pose(push, {})
    touched = skin.source[skin.welded == 7]
    np.testing.assert_allclose(moved[touched], np.tile((1.0, 2.0, 3.0), (len(touched), 1)))
    rest = np.ones(len(moved), bool)
    rest[touched] = False
    np.testing.assert_array_equal(moved[rest], 0.0)


def test_the_jaw_carries_what_muscles_and_lids_have_moved() -> None:
    skin = MECHANICS.head.skin
    push = np.zeros_like(NEUTRAL)
    push[:, 2] = 1.0
    moved = MECHANICS.pose(push, {"jaw_pitch": 10.0})[skin.first_source()]
    expected = MECHANICS.jaw.move(
        skin.mesh.positions + push, JawPose(pitch=10.0), share=MECHANICS.jaw_share
    )
    np.testing.assert_allclose(moved, expected - skin.mesh.positions, atol=1e-12)


def test_a_cheek_blows_up_at_1_and_falls_in_at_minus_1() -> None:
    blown, sunken = (MECHANICS.pose(NEUTRAL, {"cheek_puff_l": end})[:, 0] for end in (1.0, -1.0))
    assert blown.max() > 2.0
    assert blown.max() > -blown.min()
    assert -sunken.min() > sunken.max()


def test_a_head_without_eye_landmarks_has_no_lids_and_says_so() -> None:
    mechanics = made_up_mechanics()
    assert mechanics.notes == (
        "left eyelids left out: landmarks 3.1, 3.3 are missing",
        "right eyelids left out: landmarks 3.2, 3.4 are missing",
    )
    assert not any(name.startswith("lid_") for name in _names(mechanics))
    assert {"gaze_yaw_l", "gaze_pitch_r", "tongue_out", "jaw_pitch"} <= _names(mechanics)


def test_a_bare_mask_keeps_its_jaw_and_loses_the_rest() -> None:
    skin = {"skin": head_pieces("slit")["skin"]}
    mechanics = Mechanics.build(Head.from_mesh(assemble(skin), head_specs("slit")))
    assert _names(mechanics) == {
        "jaw_pitch", "jaw_yaw", "jaw_protrusion", "lips_together", "cheek_puff_l", "cheek_puff_r"
    }  # fmt: skip
    assert "no tongue found: tongue controls left out" in mechanics.notes
    rest = np.zeros((mechanics.head.skin.vertex_count, 3))
    opened = mechanics.pose(rest, {"jaw_pitch": 15.0})
    upper, lower = face_sheet("slit").middles
    assert np.linalg.norm(opened[upper]) < 1.0
    assert opened[lower, 1] < -5.0


def test_an_eye_that_is_closed_is_left_out_with_a_note() -> None:
    specs = head_specs("slit")
    sheet = face_sheet("slit")
    # The mouth serves as an eye whose margins coincide at its landmarks.
    lids = dict(zip(("3.1", "3.3", "3.2", "3.4"), [*sheet.middles, *sheet.middles]))
    for name, vertex in lids.items():
        specs[name] = type(specs["2.2"])(vertex=int(vertex))
    mechanics = Mechanics.build(
        Head.from_mesh(assemble({"skin": head_pieces("slit")["skin"]}), specs)
    )
    assert not mechanics.lids
    assert any("left eyelids left out: " in note for note in mechanics.notes)


def test_welded_lips_are_refused_with_the_landmarks_to_check() -> None:
    head = Head.from_mesh(assemble(head_pieces("welded")), _welded_specs())
    with pytest.raises(MeshError, match=r"the mouth cannot be opened \(.*welded.*\); check 2\.2"):
        Mechanics.build(head)


def _welded_specs():
    sheet = face_sheet("welded")
    specs = head_specs("welded")
    for name, height in (("2.2", -69.0), ("2.3", -76.0)):
        specs[name] = type(specs["2.2"])(vertex=sheet.nearest(0.0, height))
    return specs


def test_one_vertex_for_both_lips_is_refused() -> None:
    specs = head_specs("slit")
    specs["2.3"] = specs["2.2"]
    head = Head.from_mesh(assemble(head_pieces("slit")), specs)
    with pytest.raises(LandmarkError, match=r"'2\.2' and '2\.3' are the same vertex"):
        Mechanics.build(head)


@pytest.mark.parametrize("name", ["2.1", "2.2", "2.4", "9.3"])
def test_a_missing_landmark_is_named_with_its_meaning(name: str) -> None:
    specs = head_specs("slit")
    del specs[name]
    head = Head.from_mesh(assemble(head_pieces("slit")), specs)
    with pytest.raises(LandmarkError, match=rf"needs {name} \(.+\); add them to the landmark"):
        Mechanics.build(head)


def test_lashes_follow_the_lid_margin() -> None:
    pieces = head_pieces("bag")
    sheet = face_sheet("bag")
    edge = sheet.mesh.positions[[sheet.nearest(x, 6.0) for x in (22.0, 27.0, 32.0, 37.0)]]
    edge = edge + np.array([0.3, 0.2, 0.5])
    hair = np.concatenate([edge, edge + np.array([0.0, -4.0, 6.0])])
    pieces["lashes"] = (hair, [(k, k + 1, k + 5, k + 4) for k in range(3)])
    head = Head.from_mesh(assemble(pieces, names={"lashes": "lashes"}), head_specs("bag"))
    mechanics = Mechanics.build(head)
    push = np.tile((0.5, -1.0, 2.0), (head.skin.vertex_count, 1))
    moved = mechanics.pose(push, {})
    lashes = head.parts["lashes_left"]
    np.testing.assert_allclose(moved[lashes.source], push[: len(lashes.source)], atol=1e-12)


def test_a_piece_of_no_known_kind_stays_with_the_skull() -> None:
    pieces = head_pieces("bag")
    points, polygons = pieces["tongue"]
    pieces["hat"] = (points + np.array([0.0, 220.0, 0.0]), polygons)
    head = Head.from_mesh(assemble(pieces), head_specs("bag"))
    mechanics = Mechanics.build(head)
    push = np.ones((head.skin.vertex_count, 3))
    moved = mechanics.pose(push, {"jaw_pitch": 18.0})
    np.testing.assert_array_equal(moved[head.parts["other"].source], 0.0)
    assert made_up_head().vertex_count < head.vertex_count
