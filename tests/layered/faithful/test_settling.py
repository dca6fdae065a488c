from __future__ import annotations

import numpy as np
import pytest

from risorius.anatomy.template import builtin_head
from risorius.layered.faithful import FaithfulFace, FaithfulParameters
from risorius.layered.faithful.settling import side_by_side
from risorius.rig.bake import bake
from risorius.rig.face import ManyPoses
from risorius.solvers.constraints import Contacts

HEAD = builtin_head()
POSES = {
    "zygomaticus_l": {"zygomaticus_major_l": 1.0},
    "zygomaticus_r": {"zygomaticus_major_r": 1.0},
    "open": {"jaw_pitch": 14.0},
    "rest": {},
    "gaze": {"gaze_yaw_l": 10.0},
    "kiss": {"orbicularis_oris": 1.0, "jaw_pitch": 4.0},
}


@pytest.fixture(scope="module")
def face() -> FaithfulFace:
    return FaithfulFace.build(HEAD, parameters=FaithfulParameters(lift=False))


def test_poses_side_by_side_are_those_one_by_one(face: FaithfulFace) -> None:
    assert isinstance(face, ManyPoses)
    together = face.displace_all(list(POSES.values()))
    assert len(together) == len(POSES)
    for found, pose in zip(together, POSES.values()):
        alone = face.displace(pose)
        assert np.abs(found - alone).max() <= 5e-3 * max(np.abs(alone).max(), 1e-9)
    assert not together[3].any()


def test_a_pose_and_its_mirror_image_are_mirror_images_in_one_batch(face: FaithfulFace) -> None:
    source, partner = HEAD.skin.first_source(), face.partner
    assert partner is not None
    left, right = (face.displace_all(list(POSES.values()))[k][source] for k in (0, 1))
    np.testing.assert_allclose(left[partner] * [-1.0, 1.0, 1.0], right, atol=1e-9)


def test_a_rig_is_baked_in_groups_and_tells_how_far_it_is(face: FaithfulFace) -> None:
    said: list[tuple[int, int, str]] = []
    rig = bake(face, POSES, progress=lambda *step: said.append(step))
    assert rig.names == tuple(POSES)
    assert said == [(0, len(POSES), "zygomaticus_l")]
    assert len(rig.target("rest").vertices) == 0


def test_contacts_of_one_pose_are_switched_off_in_the_others() -> None:
    up = np.array([[0.0, 1.0, 0.0]])
    one = Contacts(np.array([3], np.int32), np.array([[1.0, 2.0, 3.0]]), up)
    two = Contacts(np.array([3, 5], np.int32), np.ones((2, 3)), np.repeat(-up, 2, axis=0))
    joined = side_by_side([one, None, two])
    assert joined is not None
    assert joined.particles.tolist() == [3, 3, 5]
    np.testing.assert_array_equal(joined.normals[0], [up[0], 0 * up[0], 0 * up[0]])
    assert not joined.normals[1].any()
    np.testing.assert_array_equal(joined.normals[2], [0 * up[0], -up[0], -up[0]])
    assert side_by_side([None, None]) is None


def test_a_shape_made_upon_another_pose_is_what_it_changes_there(face: FaithfulFace) -> None:
    upon = {"jaw_pitch": 12.0}
    rig = bake(face, {"close": {"lips_together": 1.0}}, upon={"close": upon})
    wanted = face.displace({**upon, "lips_together": 1.0}) - face.displace(upon)
    found = HEAD.frame.vectors_to_canonical(rig.target("close").dense(HEAD.vertex_count))
    assert np.abs(found - wanted).max() < 0.02
    assert np.abs(found).max() > 2.0
