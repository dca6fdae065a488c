"""Muscles carried between the built-in and the real heads: expressions read right untuned."""

from __future__ import annotations

import warnings
from functools import cache
from pathlib import Path

import pytest

from risorius.anatomy.template import builtin_head
from risorius.controls.presets import default_presets
from risorius.errors import RisoriusWarning
from risorius.head import Head
from risorius.vectormuscle import VectorFace
from risorius.vectormuscle.export import Export
from risorius.vectormuscle.export_lips import compare_lips, opened_lips
from risorius.vectormuscle.kinds import LinearMuscle

pytestmark = pytest.mark.real

_FILES = {
    "ict": "ict_facekit/ict_neutral.obj",
    "makehuman": "makehuman_head/caucasian_male_young.obj",
}
WAYS = [("builtin", "ict"), ("ict", "makehuman"), ("makehuman", "builtin")]


@cache
def _head(name: str, folder: Path) -> Head:
    if name == "builtin":
        return builtin_head()
    path = folder / _FILES[name]
    with warnings.catch_warnings():
        # Two pairs of the landmark files are exchanged; the reader says so.
        warnings.simplefilter("ignore", RisoriusWarning)
        return Head.load(path, path.with_name("landmarks.json"))


@cache
def _carried(source: str, target: str, folder: Path) -> VectorFace:
    export = Export.begin(_head(source, folder), _head(target, folder))
    return VectorFace.build(export.target, export.vector_set())


@pytest.fixture(params=WAYS, ids="-".join)
def face(request: pytest.FixtureRequest, real_data: Path) -> VectorFace:
    return _carried(*request.param, real_data)


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
