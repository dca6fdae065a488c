"""The layered face on the real heads: lids on the eyeball, lips, teeth and neighbours."""

from __future__ import annotations

import warnings
from functools import cache
from itertools import product

import numpy as np
import pytest

from risorius.errors import RisoriusWarning
from risorius.layered import LayeredFace
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
