from __future__ import annotations

import numpy as np
import pytest

from risorius.anatomy.jaw import JawPose
from risorius.anatomy.lip_seal import lip_seal
from tests.face_fixtures import builtin_face

HEAD, MECHANICS = builtin_face().head, builtin_face().mechanics
LIPS, MESH = MECHANICS.lips, HEAD.skin.mesh


def _opened(pitch: float) -> np.ndarray:
    return MECHANICS.jaw.move(MESH.positions, JawPose(pitch=pitch), share=MECHANICS.jaw_share)


def test_a_closed_mouth_needs_no_seal() -> None:
    np.testing.assert_allclose(lip_seal(MESH, LIPS, MESH.positions), 0.0, atol=1e-12)


@pytest.mark.parametrize("pitch", [6.0, 18.0])
def test_the_seal_closes_most_of_the_gap(pitch: float) -> None:
    opened = _opened(pitch)
    sealed = opened + lip_seal(MESH, LIPS, opened)
    pairs = LIPS.pairs(MESH.positions)
    rest, before, after = (
        np.linalg.norm(p[pairs[:, 0]] - p[pairs[:, 1]], axis=1)
        for p in (MESH.positions, opened, sealed)
    )
    assert (before - rest).max() > 3.0 * pitch / 6.0
    assert (after - rest).max() < 0.15 * (before - rest).max()


def test_lower_and_upper_lip_share_the_way() -> None:
    opened = _opened(18.0)
    seal = lip_seal(MESH, LIPS, opened)
    up = seal[LIPS.slit.lower, 1].max()
    down = -seal[LIPS.slit.upper, 1].min()
    assert up > down > 0.3 * up


def test_it_fades_before_chin_nose_and_cheeks() -> None:
    seal = lip_seal(MESH, LIPS, _opened(18.0))
    largest = np.linalg.norm(seal, axis=1).max()
    far = LIPS.distance > 0.9 * LIPS.width
    assert np.linalg.norm(seal[far], axis=1).max() < 0.02 * largest


def test_the_control_closes_the_lips_of_an_open_jaw() -> None:
    face = builtin_face()
    skin = HEAD.skin
    pairs = LIPS.pairs(MESH.positions)

    def gap(**pose: float) -> float:
        points = face.pose(pose)[skin.first_source()]
        return float(np.linalg.norm(points[pairs[:, 0]] - points[pairs[:, 1]], axis=1).max())

    assert gap(jaw_pitch=18.0, lips_together=1.0) < 0.2 * gap(jaw_pitch=18.0)
