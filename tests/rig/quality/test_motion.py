from __future__ import annotations

import numpy as np
import pytest

from risorius.head import Frame, Head, Part
from risorius.landmarks import LandmarkSet
from risorius.mesh.core import TriMesh
from risorius.mesh.polygon_mesh import PolygonMesh
from risorius.rig import MorphTarget, Rig
from risorius.rig.quality.motion import Motion, cracks, motions
from tests.rig.quality.made_heads import ball, grid, head_of, rig_of

HEAD = head_of({"skin": grid(3, 3), "eye_left": ball((0.0, 0.0, -9.0), 2.0)})


def test_longest_and_mean_motion_are_told_with_vertex_and_part() -> None:
    deltas = np.zeros((HEAD.vertex_count, 3))
    deltas[4] = (0.0, 3.0, 4.0)
    deltas[12] = (6.0, 0.0, 8.0)
    deltas[2] = (0.0, 9e-4, 0.0)
    found = motions(rig_of(HEAD, {"shape": deltas, "rest": 0.0 * deltas}), HEAD)
    assert found[0] == Motion(2, 10.0, 7.5, 12, "eye_left")
    assert found[1] == Motion(0, 0.0, 0.0, -1, "")


def test_lengths_are_millimetres_with_a_head_and_file_units_without() -> None:
    frame = Frame(np.eye(3), 10.0, np.zeros(3), "cm")
    head = Head(HEAD.source, frame, HEAD.parts, HEAD.landmarks)
    deltas = np.zeros((HEAD.vertex_count, 3))
    deltas[4, 1] = 0.5
    rig = rig_of(HEAD, {"shape": deltas})
    assert motions(rig, head)[0].largest == pytest.approx(5.0)
    assert motions(rig, None)[0] == Motion(1, 0.5, 0.5, 4, "")


def test_copies_of_a_seam_vertex_that_part_are_cracks() -> None:
    sheet = grid(3, 3)
    # Vertex 9 repeats vertex 4, as at a texture seam.
    positions = np.concatenate([sheet.positions, sheet.positions[4:5]])
    faces = sheet.faces.copy()
    faces[0][faces[0] == 4] = 9
    source = PolygonMesh.from_polygons(positions, faces.tolist())
    part = Part(
        "skin",
        TriMesh(sheet.positions, sheet.faces),
        np.arange(10, dtype=np.int32),
        np.array([*range(9), 4], np.int32),
    )
    head = Head(source, Frame.canonical(), {"skin": part}, LandmarkSet([], positions))
    together, apart = np.zeros((10, 3)), np.zeros((10, 3))
    together[[4, 9]] = (0.0, 0.0, 1.0)
    apart[4] = (0.0, 0.0, 0.02)
    rig = Rig(
        source,
        (MorphTarget.from_dense("together", together), MorphTarget.from_dense("apart", apart)),
    )
    assert cracks(rig, head) == [0, 1]
