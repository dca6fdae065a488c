"""The skull inside the head."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial import cKDTree

from risorius.anatomy.skull import builtin_skull, load_skull
from risorius.anatomy.skull_fit import fit_skull
from risorius.errors import LandmarkError, MeshError
from risorius.head import Head
from risorius.layered import LayeredFace
from risorius.layered.muscle_map import default_muscle_map
from tests.face_fixtures import made_up_head
from tests.layered.faces import builtin_layered


def test_the_builtin_skull_stays_where_it_is_in_the_builtin_head() -> None:
    face, skull = builtin_layered(), builtin_skull()
    assert face.skull.scale == pytest.approx(1.0)
    off = np.linalg.norm(face.skull.cranium.positions - skull.cranium.positions, axis=1)
    assert np.median(off) < 0.01
    assert off.max() < 3.0


def test_the_fit_of_a_foreign_head_is_finite_and_of_human_size() -> None:
    head = made_up_head()
    hidden = np.zeros(head.skin.vertex_count, bool)
    fitted = fit_skull(builtin_skull(), head, symmetric=False, hidden=hidden)
    assert 0.5 < fitted.scale < 2.0
    assert np.isfinite(fitted.mandible.positions).all()


def test_fitting_a_symmetric_head_gives_a_symmetric_way_in() -> None:
    carry = builtin_layered().skull.carry
    points = np.random.default_rng(2).uniform(-60.0, 60.0, (50, 3))
    mirror = np.array([-1.0, 1.0, 1.0])
    np.testing.assert_allclose(carry(points * mirror) * mirror, carry(points), atol=1e-9)


def test_too_few_landmarks_are_refused_with_names() -> None:
    head = made_up_head()
    hidden = np.zeros(head.skin.vertex_count, bool)
    renamed = head.landmarks.renamed({n: f"own_{k}" for k, n in enumerate(head.landmarks)})
    nameless = Head(head.source, head.frame, head.parts, renamed)
    with pytest.raises(LandmarkError, match="8 are needed to place the skull; add some of"):
        fit_skull(builtin_skull(), nameless, symmetric=False, hidden=hidden)


def test_a_skull_of_one_bone_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "skull.obj"
    path.write_text("o thing\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\n")
    marks = tmp_path / "m.json"
    marks.write_text(
        json.dumps(
            {
                "schema": "risorius/landmarks",
                "version": 1,
                "landmarks": {"nasion": {"vertex": 0}, "menton": {"vertex": 1}},
            }
        )
    )
    with pytest.raises(MeshError, match="name them, or give two files, cranium first"):
        load_skull((path,), marks, marks=default_muscle_map().landmarks)
    two = (path, path)
    with pytest.raises(LandmarkError, match="shares 2 bone landmarks with the muscle map, 6 are"):
        load_skull(two, marks, marks=default_muscle_map().landmarks)


@pytest.mark.real
@pytest.mark.filterwarnings("ignore::risorius.errors.RisoriusWarning")
@pytest.mark.parametrize(
    ("mesh", "marks"),
    [
        ("ict_facekit/ict_neutral.obj", "ict_facekit/landmarks.json"),
        ("makehuman_head/african_female_young.obj", "makehuman_head/landmarks.json"),
    ],
)
def test_hardly_any_bone_lies_outside_real_skin(real_data: Path, mesh: str, marks: str) -> None:
    face = LayeredFace.build(Head.load(real_data / mesh, real_data / marks))
    positions, seen = face.skin.positions, np.flatnonzero(~face.skin.hidden)
    points = face.skull.cranium.positions
    points = points[points[:, 2] > -30.0]
    near = seen[cKDTree(positions[seen]).query(points)[1]]
    depth = np.einsum("qd,qd->q", positions[near] - points, face.skin.normals[near])
    assert np.mean(depth < 0.0) < 0.03
