from __future__ import annotations

import copy
from dataclasses import replace

import numpy as np
import pytest

from risorius.errors import ParameterError
from risorius.head import Head
from risorius.vectormuscle import (
    VectorFace,
    VectorParameters,
    VectorSet,
    default_vector_set,
    parse_vector_set,
)
from tests.face_fixtures import builtin_face, made_up_head, made_up_mechanics
from tests.synthetic import assemble, head_pieces, head_specs

HEAD, MECHANICS = made_up_head(), made_up_mechanics()
DATA = default_vector_set().to_json()


def _set(*entries: dict) -> VectorSet:
    """Return a set drawn on the made-up head itself."""
    marks = {name: HEAD.landmarks.position(name).tolist() for name in HEAD.landmarks}
    data = copy.deepcopy(DATA) | {"landmarks": marks, "muscles": list(entries)}
    return parse_vector_set(data, source="s")


def _entry(name: str, **changes: object) -> dict:
    return {
        "name": name,
        "kind": "linear",
        "origin": [30.0, 20.0, 0.0],
        "insertion": [30.0, -30.0, 5.0],
        "start_radius": 50.0,
        "finish_radius": 70.0,
        "half_angle": 40.0,
    } | changes


def _face(*entries: dict, **options) -> VectorFace:
    return VectorFace.build(HEAD, _set(*entries), mechanics=MECHANICS, **options)


def test_a_face_carries_the_notes_of_its_mechanics() -> None:
    face = VectorFace.build(HEAD, mechanics=MECHANICS)
    assert face.notes == MECHANICS.notes
    assert builtin_face().notes == ()


def test_muscles_of_one_s_own_become_controls() -> None:
    face = _face(_entry("ear_l"), _entry("ear_r"), _entry("lonely_l"), _entry("risorius_l"))
    muscles = [control for control in face.controls if control.group == "muscle"]
    # Registered muscles come first, then the others in the order of the set.
    assert [c.name for c in muscles] == ["risorius_l", "ear_l", "ear_r", "lonely_l"]
    assert [c.mirror for c in muscles] == ["risorius_r", "ear_r", "ear_l", "lonely_l"]
    assert np.abs(face.displace({"ear_l": 1.0})).max() > 1.0


def test_a_set_without_muscles_still_moves_its_jaw() -> None:
    face = _face()
    assert {control.group for control in face.controls} == {
        "jaw",
        "lips",
        "cheek",
        "gaze",
        "tongue",
    }
    assert np.abs(face.displace({"jaw_pitch": 10.0})).max() > 5.0


def test_a_region_that_does_not_exist_is_refused_when_the_muscle_binds() -> None:
    with pytest.raises(ParameterError, match="regions: moustache is not one of upper, middle"):
        _face(_entry("ear", regions=["moustache"]))


def test_lower_muscles_leave_the_upper_lip_alone() -> None:
    face = _face(_entry("down", origin=[0.0, -110.0, 0.0], insertion=[0.0, -70.0, 20.0]))
    only = _face(
        _entry("down", origin=[0.0, -110.0, 0.0], insertion=[0.0, -70.0, 20.0], regions=["lower"])
    )
    upper = HEAD.skin.source[MECHANICS.lips.upper]
    assert np.abs(face.displace({"down": 1.0})[upper]).max() > 0.5
    np.testing.assert_array_equal(only.displace({"down": 1.0})[upper], 0.0)


def test_the_faithful_profile_differs_by_named_fields() -> None:
    improved = VectorParameters.of_profile("improved")
    faithful = VectorParameters.of_profile("faithful")
    assert improved == VectorParameters()
    assert faithful == replace(improved, angular="published", support=0.0, drag=False)
    face = _face(_entry("ear"), parameters=faithful)
    assert not np.array_equal(
        face.displace({"ear": 1.0}), _face(_entry("ear")).displace({"ear": 1.0})
    )


def test_an_unknown_profile_is_refused() -> None:
    with pytest.raises(ParameterError, match="profile: 'best' is not one of faithful, improved"):
        VectorParameters.of_profile("best")  # pyright: ignore


def test_wrinkles_on_a_coarse_skin_are_noted_and_left_out() -> None:
    face = _face(_entry("brow", wrinkles={"count": 4}))
    assert face.notes[-1].startswith("brow: wrinkles left out: the skin has ")
    plain = _face(_entry("brow"))
    np.testing.assert_array_equal(face.displace({"brow": 1.0}), plain.displace({"brow": 1.0}))


def test_wrinkles_on_a_skin_that_is_fine_enough_come_on_top() -> None:
    face = _face(_entry("brow", wrinkles={"count": 1}))
    plain = _face(_entry("brow"))
    assert face.notes == plain.notes
    ridge = face.displace({"brow": 1.0}) - plain.displace({"brow": 1.0})
    assert np.linalg.norm(ridge, axis=1).max() > 0.5
    np.testing.assert_array_equal(face.displace({}), 0.0)


def test_a_skin_with_a_fin_is_taken_as_it_is() -> None:
    pieces = head_pieces("bag")
    points, polygons = pieces["skin"]
    a, b, _ = polygons[40]
    fin = np.concatenate([points, points[[a]] + np.array([[0.0, 0.0, 9.0]])])
    pieces["skin"] = (fin, [*polygons, (a, b, len(points))])
    # A third face on one edge: vertices are all that muscles need.
    face = VectorFace.build(Head.from_mesh(assemble(pieces), head_specs("bag")))
    moved = face.pose({"zygomaticus_major_l": 1.0, "jaw_pitch": 12.0})
    assert np.isfinite(moved).all()


def test_a_skin_with_a_face_of_no_area_is_taken_as_it_is() -> None:
    pieces = head_pieces("bag")
    points, polygons = pieces["skin"]
    a, b, _ = polygons[40]
    pieces["skin"] = (points, [*polygons, (a, b, b)])
    face = VectorFace.build(Head.from_mesh(assemble(pieces), head_specs("bag")))
    assert np.isfinite(face.pose({"frontalis_inner_l": 1.0, "jaw_pitch": 12.0})).all()


def test_eyes_teeth_and_tongue_are_not_pulled_by_muscles() -> None:
    face = builtin_face()
    names = [control.name for control in face.controls if control.group == "muscle"]
    moved = face.displace(dict.fromkeys(names, 1.0))
    for kind in ("eye_left", "eye_right", "teeth_upper", "teeth_lower", "gums", "tongue"):
        np.testing.assert_array_equal(moved[face.head.parts[kind].source], 0.0)
