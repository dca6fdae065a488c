"""The layered face on the real heads: lids on the eyeball, lips, teeth and neighbours."""

from __future__ import annotations

import warnings
from functools import cache
from itertools import product
from pathlib import Path

import numpy as np
import pytest

from risorius.errors import RisoriusWarning
from risorius.head import Head
from risorius.layered import LayeredFace
from tests.layered.eye_depth import depth_added

pytestmark = pytest.mark.real

HEADS = (
    "ict_facekit/ict_neutral.obj",
    "makehuman_head/african_female_young.obj",
    "makehuman_head/asian_male_old.obj",
    "makehuman_head/caucasian_male_young.obj",
)


@cache
def _build(path: Path) -> LayeredFace:
    with warnings.catch_warnings():
        # Two pairs of the landmark files are exchanged; the reader says so.
        warnings.simplefilter("ignore", RisoriusWarning)
        return LayeredFace.build(Head.load(path, path.with_name("landmarks.json")))


@pytest.fixture(params=HEADS, ids=lambda name: Path(name).stem)
def face(request: pytest.FixtureRequest, real_data: Path) -> LayeredFace:
    return _build(real_data / request.param)


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
