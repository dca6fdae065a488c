"""The layered face on the real heads: lids on the eyeball, lips, teeth and neighbours."""

from __future__ import annotations

import warnings
from functools import cache
from itertools import product

import numpy as np
import pytest

from risorius.controls.presets import default_presets
from risorius.controls.shape_sets import list_shapes
from risorius.errors import RisoriusWarning
from risorius.layered import LayeredFace
from risorius.mesh.core import TriMesh
from risorius.spatial.raycast import Scene
from tests.layered.eye_depth import depth_added
from tests.real.heads import REAL_HEADS, real_head

pytestmark = pytest.mark.real


@cache
def _build(name: str) -> LayeredFace:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RisoriusWarning)
        return LayeredFace.build(real_head(name))


@pytest.fixture(params=REAL_HEADS)
def face(request: pytest.FixtureRequest) -> LayeredFace:
    return _build(request.param)


def test_no_gaze_drives_the_eye_into_its_lids(face: LayeredFace) -> None:
    for yaw, pitch, blink, squint in product((-40, 0, 40), (-35, 0, 30), (-1, 0, 0.5, 1), (0, 1)):
        pose = {"orbicularis_oculi_l": float(squint), "lid_upper_l": float(blink)}
        pose |= {"gaze_yaw_l": float(yaw), "gaze_pitch_l": float(pitch)}
        pose["lid_lower_l"] = float(blink)
        assert depth_added(face, pose) < 0.1, pose


def test_extreme_poses_are_finite_and_end_where_they_began(face: LayeredFace) -> None:
    random = np.random.default_rng(11)
    for _ in range(8):
        pose = {
            control.name: random.choice([control.low, control.default, control.high])
            for control in face.controls
        }
        moved = face.displace(pose)
        assert np.isfinite(moved).all()
        assert np.linalg.norm(moved, axis=1).max() < 90.0
    assert not face.displace({}).any()


@pytest.mark.parametrize("shape", ["mouthPucker", "mouthRollUpper"])
def test_no_lining_of_the_mouth_shows_through_the_upper_lip(face: LayeredFace, shape: str) -> None:
    pose = list_shapes(face.controls, default_presets(), sets=("arkit",)).poses[shape]
    mesh, skin = face.head.skin.mesh, face.skin
    posed = mesh.positions + face.displace(pose)[face.head.skin.first_source()]
    marks = face.head.landmarks
    right, left = marks.position("2.5")[0], marks.position("2.4")[0]
    low, high = marks.position("2.2")[1] + 3.0, marks.position("9.3")[1]
    across, up = np.meshgrid(np.linspace(right, left, 60), np.linspace(low, high, 40))
    before = np.stack([across, up, np.full_like(up, posed[:, 2].max() + 10.0)], axis=-1)
    hits = Scene([TriMesh(posed, mesh.faces)]).cast(before.reshape(-1, 3), (0.0, 0.0, -1.0))
    seen = mesh.faces[hits.face[hits.hit]]
    deep = skin.hidden & (face.mechanics.lips.distance > 5.0)
    assert not deep[seen].all(axis=1).any()
