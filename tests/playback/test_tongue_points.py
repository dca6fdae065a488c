from __future__ import annotations

import warnings
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from risorius.errors import RisoriusWarning
from risorius.head import Head
from risorius.landmarks.landmark_set import LandmarkSet
from risorius.playback import FapReading, solve_fap_shapes
from risorius.playback.tongue_points import TONGUE_PARTS, tongue_points
from risorius.vectormuscle import VectorFace
from tests.face_fixtures import builtin_face
from tests.playback.rigs import played_rig


def _found(head: Head) -> dict[str, int]:
    parts = {k: np.asarray(head.parts[k].source) for k in TONGUE_PARTS if k in head.parts}
    return tongue_points(head.positions, parts, head.landmarks)


def test_the_tip_and_body_of_the_tongue_are_found_where_a_person_marked_them() -> None:
    head = builtin_face().head
    found = _found(head)
    for name, largest in (("6.1", 0.5), ("6.2", 12.0)):
        apart = head.positions[found[name]] - head.landmarks.position(name)
        assert np.linalg.norm(apart) < largest


def test_a_rig_without_landmarks_of_the_tongue_is_read_all_the_same() -> None:
    rig = played_rig()
    fewer = {name: spec for name, spec in rig.landmarks.items() if not name.startswith("6.")}
    reading = FapReading.of_rig(replace(rig, landmarks=fewer))
    assert {43, 44, 45, 46} <= set(reading.numbers)
    out = rig.frame.vectors_to_canonical(rig.target("tongue_out").dense(rig.mesh.vertex_count))
    values = reading.values(out)
    own = FapReading.of_rig(rig).values(out)
    row, other = reading.numbers.index(45), FapReading.of_rig(rig).numbers.index(45)
    assert values[row] == pytest.approx(own[other], rel=0.02)
    assert values[row] > 300.0


def test_a_mouth_without_tongue_or_corners_has_no_points() -> None:
    head = builtin_face().head
    assert tongue_points(head.positions, {}, head.landmarks) == {}
    gums = {"gums": np.asarray(head.parts["gums"].source)}
    assert tongue_points(head.positions, gums, head.landmarks) == {}
    assert tongue_points(head.positions, gums, LandmarkSet((), head.positions)) == {}


@pytest.mark.real
def test_the_tongue_in_one_piece_with_the_gums_is_told_from_them(real_data: Path) -> None:
    path = real_data / "ict_facekit" / "ict_neutral.obj"
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RisoriusWarning)
        face = VectorFace.build(Head.load(path, path.with_name("landmarks.json")))
    moved = face.displace({"tongue_out": 1.0})
    tip = _found(face.head)["6.1"]
    assert moved[tip, 2] > 0.7 * moved[np.asarray(face.head.parts["gums"].source), 2].max()
    solved = solve_fap_shapes(face, numbers=(43, 44, 45, 46))
    assert all(shape.full for shape in solved.shapes)


@pytest.mark.real
@pytest.mark.parametrize("name", ["african_female_young", "asian_male_old", "caucasian_male_young"])
def test_the_tips_of_real_tongues_are_those_that_were_marked(real_data: Path, name: str) -> None:
    path = real_data / "makehuman_head" / f"{name}.obj"
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RisoriusWarning)
        head = Head.load(path, path.with_name("landmarks.json"))
    apart = head.positions[_found(head)["6.1"]] - head.landmarks.position("6.1")
    assert np.linalg.norm(apart) < 0.05 * head.height / 2
