"""Rigs written as USD, read by the USD library."""

import json
import os
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from risorius.errors import FormatError
from risorius.io.usd import write_usd
from risorius.mesh.normals import vertex_normals
from risorius.mesh.polygon_mesh import PolygonMesh
from risorius.rig.rig import Rig
from tests.io.rigs import EYE, SKIN, TEETH, make_rig, make_seam_rig
from tests.tools import require_module

PARTS = {"skin": SKIN, "eye_left": EYE, "teeth_lower": TEETH}


@pytest.fixture(scope="module")
def pxr() -> Any:
    require_module("pxr")
    import pxr.Usd
    import pxr.UsdGeom
    import pxr.UsdSkel

    return pxr


@pytest.fixture(scope="module")
def stage(pxr: Any, tmp_path_factory: pytest.TempPathFactory) -> Any:
    path = tmp_path_factory.mktemp("usd") / "a.usdc"
    write_usd(make_rig(), path, animation=True)
    return pxr.Usd.Stage.Open(str(path))


def mesh_of(pxr: Any, stage: Any, part: str) -> Any:
    return pxr.UsdGeom.Mesh(stage.GetPrimAtPath(f"/Head/{part}"))


def test_the_stage_says_unit_and_up_axis(pxr: Any, stage: Any):
    assert pxr.UsdGeom.GetStageMetersPerUnit(stage) == pytest.approx(0.01)
    assert pxr.UsdGeom.GetStageUpAxis(stage) == "Z"
    assert stage.GetDefaultPrim().GetPath() == "/Head"
    meta = json.loads(stage.GetRootLayer().customLayerData["risorius"])
    assert meta["landmarks"]["2.1"]["vertex"] == 3


def test_parts_keep_polygons_positions_and_texture(pxr: Any, stage: Any):
    rig = make_rig()
    sizes = np.diff(rig.mesh.offsets)
    for part, own in PARTS.items():
        mesh = mesh_of(pxr, stage, part)
        points = np.array(mesh.GetPointsAttr().Get())
        np.testing.assert_allclose(points, rig.mesh.positions[own], atol=1e-6)
        polygons = np.isin(rig.mesh.corners[rig.mesh.offsets[:-1]], own)
        np.testing.assert_array_equal(mesh.GetFaceVertexCountsAttr().Get(), sizes[polygons])
        corners = rig.mesh.corners[np.repeat(polygons, sizes)] - own[0]
        np.testing.assert_array_equal(mesh.GetFaceVertexIndicesAttr().Get(), corners)
        primvar = pxr.UsdGeom.PrimvarsAPI(mesh).GetPrimvar("st")
        assert bool(primvar) is (part == "skin")
    uvs = np.array(
        pxr.UsdGeom.PrimvarsAPI(mesh_of(pxr, stage, "skin")).GetPrimvar("st").ComputeFlattened()
    )
    chosen = np.repeat(np.isin(rig.mesh.corners[rig.mesh.offsets[:-1]], SKIN), sizes)
    np.testing.assert_allclose(uvs, rig.mesh.uvs[rig.mesh.uv_corners[chosen]], atol=1e-6)


def test_shapes_are_named_and_only_where_they_move(pxr: Any, stage: Any):
    names = {
        part: list(
            pxr.UsdSkel.BindingAPI(mesh_of(pxr, stage, part)).GetBlendShapesAttr().Get() or []
        )
        for part in PARTS
    }
    assert names == {
        "skin": ["mouthSmileLeft", "jawOpen"],
        "eye_left": [],
        "teeth_lower": ["jawOpen"],
    }
    animation = pxr.UsdSkel.Animation(stage.GetPrimAtPath("/Head/Animation"))
    assert list(animation.GetBlendShapesAttr().Get()) == list(make_rig().names)


def test_usd_itself_poses_the_head_as_we_do(pxr: Any, tmp_path: Path):
    rig = make_rig()
    write_usd(rig, tmp_path / "a.usda", animation=True)
    stage = pxr.Usd.Stage.Open(str(tmp_path / "a.usda"))
    root = pxr.UsdSkel.Root(stage.GetPrimAtPath("/Head"))
    frame = 36  # the middle of the second shape
    assert pxr.UsdSkel.BakeSkinning(root, pxr.Gf.Interval(frame, frame))
    expected = rig.posed({"jawOpen": 1.0})
    faces = rig.mesh.triangles[np.isin(rig.mesh.triangles, SKIN).all(axis=1)]
    for part, own in PARTS.items():
        points = np.array(mesh_of(pxr, stage, part).GetPointsAttr().Get(frame))
        np.testing.assert_allclose(points, expected[own], atol=1e-5)
    normals = np.array(mesh_of(pxr, stage, "skin").GetNormalsAttr().Get(frame))
    np.testing.assert_allclose(normals, vertex_normals(expected, faces)[SKIN], atol=1e-3)


def test_a_head_that_lies_on_its_side_is_turned_upright(pxr: Any, tmp_path: Path):
    rig = make_rig()
    turned = np.array([[0.0, 0, 1], [1, 0, 0], [0, 1, 0]])  # up is +X in the file
    frame = replace(rig.frame, rotation=turned)
    write_usd(replace(rig, frame=frame), tmp_path / "a.usda")
    stage = pxr.Usd.Stage.Open(str(tmp_path / "a.usda"))
    assert pxr.UsdGeom.GetStageUpAxis(stage) == "Y"
    matrix = pxr.UsdGeom.Xformable(stage.GetPrimAtPath("/Head")).GetLocalTransformation()
    up = matrix.TransformDir(pxr.Gf.Vec3d(1, 0, 0))
    np.testing.assert_allclose(up, [0, 1, 0], atol=1e-12)


@pytest.mark.parametrize("ending", ["usdc", "usda", "usdz", "usd"])
def test_the_same_rig_gives_the_same_bytes(pxr: Any, tmp_path: Path, ending: str):
    for name in ("a", "b"):
        (tmp_path / name).mkdir()
        make_rig().save(tmp_path / name / f"x.{ending}")
    first, second = ((tmp_path / name / f"x.{ending}").read_bytes() for name in ("a", "b"))
    assert first == second
    assert pxr.Usd.Stage.Open(str(tmp_path / "a" / f"x.{ending}")).GetPrimAtPath("/Head/skin")


def test_names_that_usd_cannot_have_are_changed_but_tokens_stay(pxr: Any, tmp_path: Path):
    rig = make_seam_rig(apart=True)
    names = ["1 öffnen", "1_öffnen", "a.b"]
    targets = tuple(replace(rig.targets[0], name=name) for name in names)
    write_usd(Rig(rig.mesh, targets, ("Skeleton",), rig.part_of_vertex), tmp_path / "a.usda")
    stage = pxr.Usd.Stage.Open(str(tmp_path / "a.usda"))
    mesh = mesh_of(pxr, stage, "Skeleton_2")
    assert list(pxr.UsdSkel.BindingAPI(mesh).GetBlendShapesAttr().Get()) == names
    assert len(mesh.GetPrim().GetChildren()) == 3


def test_a_refused_write_keeps_the_old_file(pxr: Any, tmp_path: Path):
    path = tmp_path / "a.usdc"
    path.write_bytes(b"old")
    with pytest.raises(FormatError, match="needs polygons"):
        write_usd(Rig(PolygonMesh.from_polygons(np.eye(3), []), ()), path)
    rig = make_rig()
    rig.mesh.positions[2, 0] = np.nan
    with pytest.raises(FormatError, match="the neutral: row 2"):
        write_usd(rig, path)
    assert path.read_bytes() == b"old"
    assert [file.name for file in tmp_path.iterdir()] == ["a.usdc"]


def test_without_the_extra_the_message_says_what_to_install(tmp_path: Path):
    code = (
        "import sys; sys.modules['pxr'] = None\n"
        "from risorius.io.usd import write_usd\n"
        "from tests.io.rigs import make_rig\n"
        f"write_usd(make_rig(), {str(tmp_path / 'a.usdc')!r})"
    )
    run = subprocess.run(
        [sys.executable, "-c", code],
        capture_output=True,
        text=True,
        check=False,
        env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)},
    )
    assert run.returncode != 0
    assert "pip install risorius[usd]" in run.stderr


@pytest.mark.skipif(sys.platform == "win32", reason="no limit of the size of files there")
@pytest.mark.parametrize("ending", ["usdc", "usda", "usdz"])
def test_a_full_disk_is_told_in_one_sentence(pxr: Any, tmp_path: Path, ending: str):
    code = (
        "import resource, signal\n"
        "from risorius.errors import FormatError\n"
        "from risorius.io.usd import write_usd\n"
        "from tests.io.rigs import make_rig\n"
        "rig = make_rig()\n"
        "signal.signal(signal.SIGXFSZ, signal.SIG_IGN)\n"
        "resource.setrlimit(resource.RLIMIT_FSIZE, (512, 512))\n"
        "try:\n"
        f"    write_usd(rig, {str(tmp_path / f'a.{ending}')!r})\n"
        "except FormatError as error:\n"
        "    print(error)\n"
    )
    run = subprocess.run(
        [sys.executable, "-c", code],
        capture_output=True,
        text=True,
        check=True,
        env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)},
    )
    assert "cannot write the file" in run.stdout and "room on the disk" in run.stdout
    assert run.stdout.count("\n") == 1 and "Error in" not in run.stdout
    assert not list(tmp_path.iterdir())
