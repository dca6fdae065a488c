from __future__ import annotations

import numpy as np
import pytest

from risorius.errors import ParameterError
from risorius.vectormuscle.muscle import KINDS
from tests.face_fixtures import builtin_face, mirror_vertices

ENTRY = {
    "name": "roll",
    "kind": "roll",
    "lip": "upper",
    "centre": [0.0, -69.5, 96.0],
    "half_width": 27.0,
    "height": 14.0,
    "back": 3.2,
    "over": 2.2,
}
FACE = builtin_face()
SKIN = FACE.head.skin
LIPS = FACE.mechanics.lips


def _moved(name: str) -> np.ndarray:
    return FACE.displace({name: 1.0})[SKIN.first_source()]


@pytest.mark.parametrize(
    ("name", "mine", "other", "sign"),
    [
        ("orbicularis_oris_upper", LIPS.upper, LIPS.lower, -1.0),
        ("orbicularis_oris_lower", LIPS.lower, LIPS.upper, 1.0),
    ],
)
def test_one_lip_rolls_back_and_over_and_the_other_does_not_move(name, mine, other, sign) -> None:
    moved = _moved(name)
    np.testing.assert_array_equal(moved[other], 0.0)
    length = np.linalg.norm(moved, axis=1)
    rolled = length > 0.5 * length.max()
    assert mine[rolled].all()
    assert (moved[rolled, 2] < 0.0).all()
    assert (sign * moved[rolled, 1] > 0.0).all()


def test_the_roll_is_the_same_on_both_sides() -> None:
    partner = mirror_vertices(SKIN.mesh.positions)
    moved = _moved("orbicularis_oris_lower")
    np.testing.assert_allclose(moved[partner] * [-1.0, 1.0, 1.0], moved, atol=1e-6)


def test_a_roll_lies_on_the_midline_and_scales_with_the_mouth() -> None:
    muscle = KINDS["roll"](ENTRY, "set")
    assert muscle.mirrored().to_json() == ENTRY
    fitted = muscle.fitted(lambda points: 2.0 * np.asarray(points))
    assert fitted.to_json() == ENTRY | {
        "centre": [0.0, -139.0, 192.0],
        "half_width": 54.0,
        "height": 28.0,
        "back": 6.4,
        "over": 4.4,
    }


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"lip": "middle"}, "lip: 'middle' is not one of lower, upper"),
        ({"lip": None}, "lip: 'None' is not one of lower, upper"),
        ({"half_width": 0.0}, "half_width: 0 is below"),
        ({"height": None}, "height: None is not a number"),
    ],
)
def test_a_bad_entry_is_refused_by_place(changes: dict, message: str) -> None:
    with pytest.raises(ParameterError, match=rf"^set: muscle 0 \(roll\): {message}"):
        KINDS["roll"](ENTRY | changes, "set: muscle 0 (roll)")
