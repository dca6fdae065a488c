"""Muscles carried between the built-in and the real heads: expressions read right untuned."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from risorius._check import IntArray
from risorius.anatomy.template import builtin_head
from risorius.controls.presets import default_presets
from risorius.head import Head
from risorius.vectormuscle import VectorFace
from risorius.vectormuscle.export import Export
from risorius.vectormuscle.export_lips import compare_lips, detected_lips, opened_lips
from risorius.vectormuscle.export_regions import split_lips, transfer_regions
from risorius.vectormuscle.kinds import LinearMuscle
from tests.face_fixtures import builtin_face
from tests.real.heads import real_head

pytestmark = pytest.mark.real

WAYS = [
    ("builtin", "ict"),
    ("ict", "caucasian_male_young"),
    ("ict", "african_female_young"),
    ("ict", "asian_male_old"),
    ("caucasian_male_young", "builtin"),
]


def _head(name: str) -> Head:
    return builtin_head() if name == "builtin" else real_head(name)


@cache
def _carried(source: str, target: str) -> VectorFace:
    export = Export.begin(_head(source), _head(target))
    return VectorFace.build(export.target, export.vector_set())


@pytest.fixture(params=WAYS, ids="-".join)
def face(request: pytest.FixtureRequest) -> VectorFace:
    return _carried(*request.param)


_WAYS = {
    "joy": {"8.3": 1, "8.4": 1},
    "sadness": {"8.3": -1, "8.4": -1, "4.1": 1, "4.2": 1},
    "surprise": {"4.1": 1, "4.3": 1, "2.1": -1},
    "anger": {"4.1": -1, "4.2": -1},
    "fear": {"4.1": 1, "4.2": 1, "2.1": -1},
    "disgust": {"8.1": 1, "9.1": 1},
}


@pytest.mark.parametrize("emotion", _WAYS)
def test_landmarks_go_where_the_expression_takes_them(face: VectorFace, emotion: str) -> None:
    pose = default_presets().fit(default_presets().emotions[emotion], face.controls).pose
    moved = face.displace(pose)[face.head.skin.first_source()]
    for landmark, sign in _WAYS[emotion].items():
        assert sign * moved[face.head.skin_vertex(landmark), 1] > 0.5


def test_jaw_side_muscles_leave_the_upper_lip_as_it_is(face: VectorFace) -> None:
    upper = _upper_lip(face)
    assert len(upper) > 100
    for name in _jaw_side(face):
        moved = face.displace_skin({name: 1.0})
        assert np.abs(moved).max() > 1.0
        assert not moved[upper].any()


def test_carried_regions_keep_the_upper_lip_only_when_the_lips_are_repaired() -> None:
    export = Export.begin(builtin_head(), real_head("ict"))
    carried = transfer_regions(export).carry(builtin_face().context.regions)
    plain = _carried("builtin", "ict")
    upper, lower = detected_lips(plain.mechanics.lips)
    moved = {}
    for repaired in (False, True):
        regions = split_lips(carried, upper=upper, lower=lower) if repaired else carried
        face = VectorFace.build(
            export.target, plain.vectors, regions=regions, mechanics=plain.mechanics
        )
        lip = _upper_lip(face)
        fields = [face.displace_skin({name: 1.0})[lip] for name in _jaw_side(face)]
        moved[repaired] = max(float(np.abs(field).max()) for field in fields)
    assert moved[False] > 1.0
    assert moved[True] == 0.0


def _upper_lip(face: VectorFace) -> IntArray:
    """Return the vertices of the upper lip and its lining, without the corners."""
    lips = face.mechanics.lips
    return np.flatnonzero(detected_lips(lips)[0] & ~lips.corner).astype(np.int32)


def _jaw_side(face: VectorFace) -> list[str]:
    names = [
        muscle.name
        for muscle in face.vectors.muscles
        if isinstance(muscle, LinearMuscle) and muscle.regions == ("lower",)
    ]
    assert {"depressor_labii_l", "mentalis_r"} <= set(names)
    return names


def test_opened_vertices_agree_with_the_detector(face: VectorFace) -> None:
    compared = compare_lips(face.head, opened_lips(face.head), face.mechanics.lips)
    assert compared.vertex_count > 300
    assert compared.agreement > 0.99
