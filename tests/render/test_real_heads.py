"""Pictures of real heads."""

from pathlib import Path

import numpy as np
import pytest

from risorius.io.obj import read_obj
from risorius.mesh.polygon_mesh import PolygonMesh
from risorius.render import Camera, Surface, buffers, look_of_material, render
from tests.render.scenes import linear

HEADS = ["ict_facekit/ict_neutral", "makehuman_head/caucasian_male_young"]
NOSE = [5214, 4749, 4857, 1147, 4527]


def surfaces_of(mesh: PolygonMesh) -> dict[str, Surface]:
    return {
        name: Surface(
            mesh.positions,
            mesh.triangles[mesh.groups.of_polygon[mesh.triangle_polygon] == index],
            **look_of_material(name),
        )
        for index, name in enumerate(mesh.groups.names)
    }


@pytest.mark.real
@pytest.mark.parametrize("name", HEADS)
def test_a_real_head_shows_its_skin_and_both_eyes_but_not_its_gums(
    real_data: Path, name: str
) -> None:
    mesh, _ = read_obj(real_data / f"{name}.obj")
    parts = surfaces_of(mesh)
    camera = Camera.framing(mesh.positions)
    seen = buffers([*parts.values()], camera, (240, 240))
    counts = {part: int((seen.surface == index).sum()) for index, part in enumerate(parts)}
    assert counts["skin"] > 10000
    left, right = counts["eye_left"], counts["eye_right"]
    assert left > 15 and left == pytest.approx(right, rel=0.1)
    assert counts.get("tongue", 0) == counts.get("gums_tongue", 0) == 0


@pytest.mark.real
def test_nostrils_read_dark(real_data: Path) -> None:
    mesh, _ = read_obj(real_data / f"{HEADS[0]}.obj")
    skin = surfaces_of(mesh)["skin"]
    camera = Camera.framing(mesh.positions[NOSE], pitch=-25.0, margin=1.3)
    picture = linear(render([skin], camera, size=(200, 200))).sum(axis=2)
    depth = buffers([skin], camera, (200, 200)).depth
    row, column = np.mgrid[:200, :200]
    near_middle = np.hypot(row - 138.0, column - 100.0) < 40.0
    tip = depth[near_middle].min()
    # The lining of the nostrils lies far behind the wings that frame it (the file is in cm).
    hole = near_middle & (depth > tip + 2.6)
    wing = near_middle & (depth < tip + 1.5)
    assert hole.sum() > 100
    assert np.median(picture[hole]) < 0.25 * np.median(picture[wing])
