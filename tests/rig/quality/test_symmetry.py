from __future__ import annotations

import numpy as np
import pytest

from risorius.controls.arkit import arkit_shapes
from risorius.controls.standard import device_controls, muscle_controls
from risorius.rig.quality.symmetry import asymmetries, mirror_map, mirror_shape
from tests.rig.quality.made_heads import grid

CONTROLS = (*device_controls(), *muscle_controls("zygomaticus_major"), *muscle_controls("procerus"))
FLIP = np.array([-1.0, 1.0, 1.0])


@pytest.mark.parametrize(
    ("name", "mirror"),
    [
        ("mouthSmileLeft", "mouthSmileRight"),
        ("smile_l", "smile_r"),
        ("L_smile", "R_smile"),
        ("Smile.R", "Smile.L"),
        ("left_brow_up", "right_brow_up"),
        ("leftBrow", "rightBrow"),
        ("BROW_LEFT", "BROW_RIGHT"),
        ("jawOpen", "jawOpen"),
        ("bright", "bright"),
        ("rightful", "rightful"),
        ("mouthRollLower", "mouthRollLower"),
        ("zygomaticus_major_l", "zygomaticus_major_r"),
        ("jaw_yaw", "jaw_yaw_neg"),
        ("jaw_yaw_neg", "jaw_yaw"),
        ("gaze_yaw_l", "gaze_yaw_r_neg"),
        ("gaze_pitch_l_neg", "gaze_pitch_r_neg"),
        ("lid_upper_r_neg", "lid_upper_l_neg"),
        ("jaw_pitch_neg", "jaw_pitch_neg"),
    ],
)
def test_a_shape_names_its_mirror(name: str, mirror: str) -> None:
    assert mirror_shape(name, CONTROLS) == mirror


def test_mirroring_a_name_twice_gives_it_back() -> None:
    names = [shape.name for shape in arkit_shapes()]
    names += [control.name for control in CONTROLS]
    names += [f"{control.name}_neg" for control in CONTROLS if control.low < 0.0]
    for name in names:
        assert mirror_shape(mirror_shape(name, CONTROLS), CONTROLS) == name


def centred() -> np.ndarray:
    return grid(9, 5).positions - [4.0, 0.0, 0.0]


def compared(deltas: np.ndarray, names: list[str]) -> list[float | None]:
    mesh = grid(9, 5).at(centred())
    pairing = mirror_map(mesh)
    assert pairing is not None
    partners = {name: mirror_shape(name) for name in names}
    found = asymmetries(names, deltas, pairing, partner_of=partners)
    return [None if each is None else each.largest for each in found]


def test_every_vertex_of_a_symmetric_skin_finds_its_mirror_image() -> None:
    mesh = grid(9, 5).at(centred())
    pairing = mirror_map(mesh)
    assert pairing is not None
    assert pairing.share == 1.0
    np.testing.assert_array_equal(
        mesh.positions[pairing.partners], mesh.positions[pairing.vertices] * FLIP
    )


def test_an_asymmetric_skin_has_no_pairing() -> None:
    mesh = grid(9, 5)
    assert mirror_map(mesh.at(centred() + [0.3, 0.0, 0.0])) is None


def test_lips_that_touch_are_paired_by_their_normals() -> None:
    sheet = centred()
    faces = grid(9, 5).faces
    both = np.concatenate([sheet, sheet])
    mesh = grid(2, 2).__class__(both, np.concatenate([faces, faces[:, ::-1] + 45]))
    pairing = mirror_map(mesh)
    assert pairing is not None
    np.testing.assert_array_equal(pairing.vertices < 45, pairing.partners < 45)


def test_mirrored_shapes_are_symmetric_and_a_difference_is_told_in_percent() -> None:
    random = np.random.default_rng(5)
    left = random.normal(size=(45, 3))
    points = centred()
    order = np.array([np.argmin(np.abs(points - point * FLIP).sum(axis=1)) for point in points])
    right = left[order] * FLIP
    assert compared(np.stack([left, right]), ["smileLeft", "smileRight"]) == [0.0, 0.0]
    longest = int(np.argmax(np.linalg.norm(right, axis=1)))
    worse = right.copy()
    worse[longest] *= 0.8
    for value in compared(np.stack([left, worse]), ["smileLeft", "smileRight"]):
        assert value == pytest.approx(20.0, rel=1e-9)


def test_a_central_shape_is_compared_with_itself() -> None:
    deltas = np.zeros((1, 45, 3))
    deltas[0, :, 1] = 1.0
    assert compared(deltas, ["jawOpen"]) == [0.0]
    deltas[0, :, 0] = 1.0
    assert compared(deltas, ["jawOpen"])[0] == pytest.approx(200.0 / np.sqrt(2.0))


def test_a_shape_without_its_partner_or_without_motion_is_not_measured() -> None:
    deltas = np.zeros((2, 45, 3))
    deltas[0, :, 1] = 1.0
    assert compared(deltas, ["smileLeft", "jawOpen"]) == [None, None]
