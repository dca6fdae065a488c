from __future__ import annotations

import numpy as np
import pytest

from risorius.anatomy.template import builtin_head
from risorius.layered.faithful import FaithfulFace, FaithfulParameters
from risorius.layered.faithful.lips import joined_contacts, lip_contacts

HEAD = builtin_head()
REST = HEAD.skin.mesh.positions


@pytest.fixture(scope="module")
def face() -> FaithfulFace:
    return FaithfulFace.build(HEAD, parameters=FaithfulParameters(lift=False, even=False))


def _crossed(face: FaithfulFace, depth: float) -> np.ndarray:
    """Return the skin with both lips moved `depth` into each other."""
    lips = face.mechanics.lips
    near = np.clip(1.0 - np.nan_to_num(lips.distance, posinf=1e9) / 12.0, 0.0, 1.0)
    sign = np.where(lips.upper, -1.0, np.where(lips.lower, 1.0, 0.0))
    moved = REST.copy()
    moved[:, 1] += 0.5 * depth * near * sign
    return moved


def test_lips_at_rest_and_lips_apart_touch_nothing(face: FaithfulFace) -> None:
    assert lip_contacts(face.lips, REST) is None
    assert lip_contacts(face.lips, _crossed(face, -4.0)) is None


def test_crossed_lips_are_asked_to_part_each_its_own_way(face: FaithfulFace) -> None:
    skin = _crossed(face, 3.0)
    found = lip_contacts(face.lips, skin)
    assert found is not None
    lips = face.mechanics.lips
    up = found.normals[:, 1] > 0.0
    assert lips.upper[found.particles[up]].all()
    assert lips.lower[found.particles[~up]].all()
    assert min(up.sum(), (~up).sum()) > 10
    depth = np.einsum("kd,kd->k", skin[found.particles] - found.points, found.normals)
    assert (depth < 0.0).all()
    assert depth.min() == pytest.approx(-1.5, abs=0.75)


def test_a_pose_that_presses_the_lips_together_does_not_cross_them(face: FaithfulFace) -> None:
    pose = {"orbicularis_oris": 1.0, "jaw_pitch": -4.0, "depressor_labii_l": 0.0}
    moved = face.displace(pose)[HEAD.skin.first_source()]
    assert np.abs(moved - face.lips.part(moved)).max() < 0.2


def test_lips_of_a_live_face_do_not_cross(face: FaithfulFace) -> None:
    live = face.live()
    live.set({"orbicularis_oris": 1.0, "jaw_pitch": -4.0})
    for _ in range(20):
        places = live.step()
    moved = (places - HEAD.positions)[HEAD.skin.first_source()]
    assert np.abs(moved - face.lips.part(moved)).max() < 0.2


def test_no_contacts_join_to_none() -> None:
    assert joined_contacts([None, None]) is None
