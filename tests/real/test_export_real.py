"""Muscles carried between the built-in and the real heads: expressions read right untuned."""

from __future__ import annotations

from functools import cache

import pytest

from risorius.anatomy.template import builtin_head
from risorius.controls.presets import default_presets
from risorius.head import Head
from risorius.vectormuscle import VectorFace
from risorius.vectormuscle.export import Export
from risorius.vectormuscle.export_lips import compare_lips, opened_lips
from risorius.vectormuscle.kinds import LinearMuscle
from tests.real.heads import real_head

pytestmark = pytest.mark.real

WAYS = [("builtin", "ict"), ("ict", "caucasian_male_young"), ("caucasian_male_young", "builtin")]


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
    lips = face.mechanics.lips
    line = lips.slit.upper[~lips.corner[lips.slit.upper]]
    names = [
        muscle.name
        for muscle in face.vectors.muscles
        if isinstance(muscle, LinearMuscle) and muscle.regions == ("lower",)
    ]
    assert names
    for name in names:
        moved = face.displace_skin({name: 1.0})
        assert moved.any()
        assert not moved[line].any()


def test_opened_vertices_agree_with_the_detector(face: VectorFace) -> None:
    compared = compare_lips(face.head, opened_lips(face.head), face.mechanics.lips)
    assert compared.vertex_count > 300
    assert compared.agreement > 0.99
