"""Bone landmarks of foreign skulls."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from risorius.anatomy import load_skull
from risorius.anatomy.bone_landmarks import read_bone_landmarks
from risorius.anatomy.template import builtin_head
from risorius.layered import LayeredFace, default_muscle_map
from risorius.mesh.polygon_mesh import PolygonMesh
from tests.layered.faces import builtin_layered


def _mesh(count: int) -> PolygonMesh:
    return PolygonMesh.from_polygons(np.eye(count, 3), [[0, 1, 2]])


def test_names_sides_and_parts_are_understood(tmp_path: Path) -> None:
    path = tmp_path / "marks.json"
    entries = {
        "gnathion/menton": {"part": "mandible", "vertex": 1},
        "condylion_L": {"part": "mandible", "vertex": 2},
        "nasion": {"part": "skull", "vertex": 3},
    }
    path.write_text(json.dumps({"landmarks": entries}))
    two = read_bone_landmarks(path, [_mesh(10), _mesh(5)])
    assert {name: spec.vertex for name, spec in two.items()} == {
        "menton": 11, "condyle_l": 12, "nasion": 3,
    }  # fmt: skip
    one = read_bone_landmarks(path, [_mesh(15)])
    assert one["menton"].vertex == 1


@pytest.mark.real
def test_a_real_skull_moves_the_builtin_head_much_like_its_own(real_data: Path) -> None:
    folder = real_data / "myosim_skull"
    skull = load_skull(
        (folder / "skull_yup_zfwd.obj", folder / "mandible_yup_zfwd.obj"),
        folder / "landmarks.json",
        marks=default_muscle_map().landmarks,
    )
    face, own = LayeredFace.build(builtin_head(), skull=skull), builtin_layered()
    for name in ("zygomaticus_major_l", "corrugator_l", "frontalis_inner_l"):
        off = np.linalg.norm(face.fields[name] - own.fields[name])
        assert off < 0.4 * np.linalg.norm(own.fields[name]), name
