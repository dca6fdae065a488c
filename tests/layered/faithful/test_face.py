from __future__ import annotations

import numpy as np
import pytest

from risorius.anatomy.template import builtin_head
from risorius.errors import ParameterError
from risorius.layered.faithful import FaithfulFace
from risorius.layered.faithful.binding import jaw_side
from risorius.rig.face import Face

HEAD = builtin_head()


@pytest.fixture(scope="module")
def face() -> FaithfulFace:
    return FaithfulFace.build(HEAD)


def test_it_is_a_face_with_the_published_muscles(face: FaithfulFace) -> None:
    assert isinstance(face, Face)
    kinds = [laid.muscle.kind for laid in face.muscles.anatomy.muscles]
    assert (kinds.count("sheet"), kinds.count("sphincter")) == (25, 1)
    controls = [control.name for control in face.controls if control.group == "muscle"]
    assert len(controls) == 21
    assert "orbicularis_oris" in controls
    assert {"jaw_pitch", "lid_upper_l"} <= {control.name for control in face.controls}


def test_at_rest_nothing_moves(face: FaithfulFace) -> None:
    assert not face.displace({}).any()
    assert not face.displace({"frontalis_l": 0.0}).any()


def test_gaze_moves_the_eyes_alone(face: FaithfulFace) -> None:
    moved = face.displace({"gaze_yaw_l": 10.0})
    assert not moved[HEAD.skin.first_source()].any()
    assert np.abs(moved).max() > 0.5


def test_an_unknown_control_is_refused(face: FaithfulFace) -> None:
    with pytest.raises(ParameterError, match="this face has no control 'nasalis_l'"):
        face.displace({"nasalis_l": 1.0})


def test_upper_lip_hangs_on_no_jaw_and_lower_lip_on_no_skull(face: FaithfulFace) -> None:
    lips = face.mechanics.lips
    anatomy, anchors = face.muscles.anatomy, face.anchors
    height = float(HEAD.landmarks.positions(("2.2", "2.3"))[:, 1].mean())
    forbidden = jaw_side(anatomy, height)[anchors.points.faces]
    near = (lips.distance < 20.0) & ~lips.corner & ~lips.inside
    clear = np.abs(lips.to_upper - lips.to_lower) > 3.0
    upper = (near & clear & lips.upper)[anchors.vertices]
    lower = (near & clear & lips.lower)[anchors.vertices]
    assert upper.sum() > 50
    assert lower.sum() > 50
    assert not (forbidden[upper] == 1).any()
    assert not (forbidden[lower] == -1).any()


def test_eyes_and_lids_hang_on_nothing(face: FaithfulFace) -> None:
    hung = np.zeros(HEAD.skin.mesh.vertex_count, bool)
    hung[face.anchors.vertices] = True
    for side, lids in face.mechanics.lids.items():
        assert not hung[lids.vertices[lids.weight > 0.5]].any()
        assert not hung[face.mechanics.margins[side].slit.inside].any()


def test_teeth_and_tongue_follow_the_jaw(face: FaithfulFace) -> None:
    moved = face.displace({"jaw_pitch": 12.0})
    lower = HEAD.parts["teeth_lower"].first_source()
    upper = HEAD.parts["teeth_upper"].first_source()
    assert np.linalg.norm(moved[lower], axis=1).min() > 5.0
    assert not moved[upper].any()
    chin = moved[HEAD.skin.first_source()][HEAD.skin_vertex("2.1")]
    assert chin[1] < -8.0


def test_a_live_face_arrives_at_its_pose_and_comes_back(face: FaithfulFace) -> None:
    live = face.live()
    np.testing.assert_allclose(live.step(), HEAD.positions, atol=1e-3)
    pose = {"frontalis_inner_l": 1.0, "frontalis_inner_r": 1.0}
    live.set(pose)
    steps = [live.step() for _ in range(100)]
    first, last = (np.abs(places - HEAD.positions).max() for places in (steps[0], steps[-1]))
    assert first < 0.5 * last
    wanted = face.displace(pose)
    off = steps[-1] - HEAD.positions - wanted
    assert np.linalg.norm(off) < 0.2 * np.linalg.norm(wanted)
    live.set({})
    for _ in range(100):
        back = live.step()
    assert np.abs(back - HEAD.positions).max() < 0.1 * last


def test_a_live_face_waits_until_a_step_is_due(face: FaithfulFace) -> None:
    live = face.live()
    live.set({"frontalis_l": 1.0})
    np.testing.assert_array_equal(live.step(0.01), HEAD.positions)
    assert np.abs(live.step(0.01) - HEAD.positions).max() > 0.0
    with pytest.raises(ParameterError, match="dt"):
        live.step(-1.0)


def test_extreme_poses_stay_finite_and_bounded(face: FaithfulFace) -> None:
    everything = {control.name: control.high for control in face.controls}
    moved = face.displace(everything)
    assert np.isfinite(moved).all()
    assert np.abs(moved).max() < 80.0
