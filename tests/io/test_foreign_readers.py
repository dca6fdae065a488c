"""What other programs make of our files: the Khronos validator, three.js and USD itself."""

import io
import json
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image
from scipy.spatial.transform import Rotation

from risorius.io.gltf import write_glb
from risorius.io.obj import read_obj
from risorius.io.track import TurnTrack, WeightTrack
from risorius.mesh.polygon_mesh import PolygonMesh
from risorius.rig.rig import MorphTarget, Rig
from tests.io.browser import three_page
from tests.io.glb import Maker
from tests.io.rigs import make_rig, make_seam_rig
from tests.tools import NODE_FOLDER, require_node_package, require_tool

STILL = Rig(PolygonMesh.from_polygons(np.eye(3), [[0, 1], [0, 1, 2]]), ())
LONG = Rig(
    PolygonMesh.from_polygons(np.random.default_rng(1).normal(size=(70_000, 3)), [[0, 1, 69_999]]),
    (MorphTarget("last", np.array([69_999], np.int32), np.ones((1, 3))),),
)
RIGS = {"everything": make_rig(), "seam": make_seam_rig(apart=True), "still": STILL, "long": LONG}


def validated(files: list[Path]) -> list[dict[str, Any]]:
    """Return the validator's reports after checking that they hold no error and no warning."""
    require_node_package("gltf-validator")
    command = [str(require_tool("node")), str(NODE_FOLDER / "validate.cjs"), *map(str, files)]
    run = subprocess.run(command, capture_output=True, check=True, timeout=120)
    reports = json.loads(run.stdout)
    assert len(reports) == len(files)
    for report in reports:
        issues = report["issues"]
        assert (issues["numErrors"], issues["numWarnings"]) == (0, 0), issues["messages"]
    return reports


def test_the_khronos_validator_sees_errors(tmp_path: Path):
    maker = Maker()
    maker.primitive([[0, 0, 0], [1, 0, 0], [0, 1, 0]])  # positions need bounds
    (tmp_path / "x.glb").write_bytes(maker.glb())
    with pytest.raises(AssertionError, match="defined for POSITION"):
        validated([tmp_path / "x.glb"])


@pytest.mark.parametrize("options", [{}, {"animation": True, "metres": True}])
def test_the_khronos_validator_finds_nothing(tmp_path: Path, options: dict[str, bool]):
    files = [tmp_path / f"{name}.glb" for name in RIGS]
    for file, rig in zip(files, RIGS.values()):
        write_glb(rig, file, **options)
    info = validated(files)[0]["info"]
    assert info["hasMorphTargets"]
    assert info["animationCount"] == int("animation" in options)


def pixels(page) -> np.ndarray:
    return np.asarray(Image.open(io.BytesIO(page.screenshot())).convert("RGB")).astype(int)


def test_three_shows_names_poses_and_animation(tmp_path: Path):
    rig = make_rig()
    path = tmp_path / "a.glb"
    write_glb(rig, path, animation=True)
    with three_page(path) as page:
        report = page.evaluate("window.report")
        assert [part["material"] for part in report] == ["Face", "Lips ü", "eye_left", "enamel"]
        assert [part["uvs"] for part in report] == [True, True, False, False]
        for part in report:
            moves = part["material"] != "eye_left"
            assert part["targets"] == (list(rig.names) if moves else [])
            assert part["normals"] == (3 if moves else 0)
        neutral, before = page.evaluate("show({})"), pixels(page)
        weights = {"jawOpen": 1.0, "mouthSmileLeft": 0.5}
        posed, after = page.evaluate("weights => show(weights)", weights), pixels(page)
        played = page.evaluate("play(1.5)")
    for found, expected in ((neutral, rig.mesh.positions), (posed, rig.posed(weights))):
        used = [int(vertex) for vertex in found]
        assert set(used) == set(np.unique(rig.mesh.corners).tolist())
        np.testing.assert_allclose(list(found.values()), expected[used], atol=1e-5)
    assert len(np.unique(before.reshape(-1, 3), axis=0)) > 50  # a shaded head, no empty canvas
    assert (np.abs(before - after).max(axis=2) > 20).mean() > 0.01
    for weights_of_mesh in played:
        assert weights_of_mesh in ([], pytest.approx([0.0, 1.0, 0.0], abs=1e-6))


def _turning_track(rig: Rig) -> WeightTrack:
    """Return a track in which the head turns by a right angle while the second shape comes."""
    weights = np.zeros((3, len(rig.targets)), np.float32)
    weights[1:, 1] = (0.5, 1.0)
    rotations = Rotation.from_rotvec(np.outer([0.0, 0.25, 0.5], [0.0, np.pi, 0.0])).as_quat()
    return WeightTrack(
        np.array([0.0, 1.0, 2.0]), weights, "take", TurnTrack(np.array([0.3, -0.2, 0.5]), rotations)
    )


def test_three_turns_the_head_about_the_joint_while_shapes_play(tmp_path: Path):
    rig = make_rig()
    track = _turning_track(rig)
    write_glb(rig, tmp_path / "a.glb", track=track)
    with three_page(tmp_path / "a.glb") as page:
        shown = [
            page.evaluate("seconds => placed(seconds)", seconds) for seconds in (0.0, 1.0, 1.5)
        ]
    turns = track.turns
    assert turns is not None
    for found, share in zip(shown, (0.0, 0.5, 0.75)):
        rotation = Rotation.from_rotvec([0.0, 0.5 * np.pi * share, 0.0])
        posed = rig.posed({rig.names[1]: share})
        expected = rotation.apply(posed - turns.pivot) + turns.pivot
        used = [int(vertex) for vertex in found]
        np.testing.assert_allclose(list(found.values()), expected[used], atol=1e-5)


def test_the_validator_accepts_a_head_that_turns(tmp_path: Path):
    rig = make_rig()
    files = [tmp_path / "a.glb", tmp_path / "b.glb"]
    for file, metres in zip(files, (False, True)):
        write_glb(rig, file, track=_turning_track(rig), metres=metres)
    assert all(report["info"]["animationCount"] == 1 for report in validated(files))


def test_metres_reach_three_upright(tmp_path: Path):
    rig = make_rig()
    write_glb(rig, tmp_path / "a.glb", metres=True)
    with three_page(tmp_path / "a.glb") as page:
        box = page.evaluate(
            "(() => { const box = []; gltf.scene.traverse((o) => { if (o.isMesh) {"
            " o.updateWorldMatrix(true, false); const p = o.geometry.attributes.position;"
            " const v = o.position.clone(); for (let i = 0; i < p.count; i++)"
            " box.push(v.fromBufferAttribute(p, i).applyMatrix4(o.matrixWorld).toArray()); } });"
            " return box; })()"
        )
    used = np.unique(rig.mesh.corners)
    expected = rig.frame.to_canonical(rig.mesh.positions[used]) / 1000
    np.testing.assert_allclose(np.min(box, axis=0), expected.min(axis=0), atol=1e-6)
    np.testing.assert_allclose(np.max(box, axis=0), expected.max(axis=0), atol=1e-6)


@pytest.mark.real
def test_a_real_head_passes_the_validator(tmp_path: Path, real_data: Path):
    mesh, _ = read_obj(real_data / "ict_facekit" / "ict_neutral.obj")
    deltas = np.zeros_like(mesh.positions)
    deltas[:5000, 1] = 0.1
    write_glb(Rig(mesh, (MorphTarget.from_dense("up", deltas),)), tmp_path / "a.glb")
    validated([tmp_path / "a.glb"])
