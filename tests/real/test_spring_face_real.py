"""The spring-muscle face on real heads: nothing torn, nothing pierced, wide expressions."""

from __future__ import annotations

import warnings
from functools import cache

import numpy as np
import pytest

from risorius.controls.presets import default_presets
from risorius.controls.shape_sets import list_shapes
from risorius.errors import RisoriusWarning
from risorius.rig.bake import bake
from risorius.rig.quality.bar import shortcomings
from risorius.rig.quality.inspection import inspect_rig
from risorius.springmuscle.face import SpringFace
from tests.real.heads import REAL_HEADS, real_head

pytestmark = pytest.mark.real


@cache
def _face(name: str) -> SpringFace:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RisoriusWarning)
        return SpringFace.build(real_head(name))


def _emotions(face: SpringFace) -> dict[str, dict[str, float]]:
    poses = list_shapes(face.controls, default_presets(), sets=("emotions",)).poses
    return {name: dict(pose) for name, pose in poses.items()}


@pytest.mark.parametrize("name", REAL_HEADS)
def test_emotions_and_muscles_pass_the_bar_of_inspect(name: str) -> None:
    face = _face(name)
    muscles = [control.name for control in face.controls if control.group == "muscle"]
    blink = {"lid_upper_l": 1.0, "lid_upper_r": 1.0, "lid_lower_l": 1.0, "lid_lower_r": 1.0}
    poses = {**_emotions(face), "blink": blink, **{muscle: {muscle: 1.0} for muscle in muscles}}
    report = inspect_rig(bake(face, poses))
    assert shortcomings(report) == ()
    for shape in report.shapes:
        assert max(p.added for p in shape.penetration.values()) < 0.1, shape.name
        assert shape.drift is not None
        assert shape.drift.largest == 0.0
        assert shape.skin_faults.inverted <= 0.005 * face.head.skin.mesh.face_count
        if shape.name == "blink":
            assert max(gap.left for gap in shape.lids.values()) < 5.0


@pytest.mark.parametrize("name", REAL_HEADS)
def test_emotions_are_far_apart_and_symmetric(name: str) -> None:
    face = _face(name)
    fields = {n: face.displace(pose).ravel() for n, pose in _emotions(face).items()}
    for one, first in fields.items():
        assert np.abs(first).max() > 3.0, one
        for other, second in fields.items():
            if one < other:
                cosine = first @ second / np.linalg.norm(first) / np.linalg.norm(second)
                assert cosine < 0.95, (one, other)
    partner = face.springs.skin.partner
    assert partner is not None
    # Eyeballs and lids of a real head differ a little from side to side; muscles do not.
    joy = face.displace_skin(_emotions(face)["joy"])
    assert np.abs(joy - joy[partner] * [-1.0, 1.0, 1.0]).max() < 1e-6
