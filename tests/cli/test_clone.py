"""`risorius clone` and `risorius compare`."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from risorius import Rig
from risorius.io.obj_folder import write_obj_folder
from tests.cli.running import answer, asset, run


@pytest.fixture(scope="module")
def small_rig(rig_file: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("clone") / "small.npz"
    Rig.load(rig_file).subset(["jawOpen", "joy"]).save(path)
    return path


def test_a_rig_is_cloned_and_compared(small_rig: Path, tmp_path: Path) -> None:
    out = tmp_path / "clone.npz"
    told = answer(run("clone", small_rig, "builtin", "-o", out, "--json"))
    assert told["ok"] is True
    assert told["shapes"] == ["jawOpen", "joy"]
    assert told["report"]["unmapped"] == 0
    assert told["report"]["landmark_count"] > 50
    assert {shape["name"] for shape in told["report"]["shapes"]} == {"jawOpen", "joy"}
    arrays = np.load(out)
    vertices = Rig.load(small_rig).mesh.vertex_count
    assert arrays["names"].tolist() == ["jawOpen", "joy"]
    assert arrays["deltas"].shape == (2, vertices, 3)
    compared = answer(run("compare", small_rig, out, "--json"))
    assert compared["mean"]["absolute"] < 1e-3
    text = run("compare", small_rig, out)
    assert text.exit_code == 0
    assert text.stdout.split()[0] == "shape"
    assert "mean of 2 shapes" in text.stdout


def test_a_folder_of_meshes_is_a_source_and_a_target_of_clones(
    small_rig: Path, tmp_path: Path
) -> None:
    folder = tmp_path / "shapes"
    write_obj_folder(Rig.load(small_rig), folder)
    (folder / "rig.json").unlink()
    out = tmp_path / "clone"
    result = run(
        "clone", folder, "builtin", "-o", out,
        "--source-landmarks", asset("head.landmarks.json"),
    )  # fmt: skip
    assert result.exit_code == 0, result.stderr
    assert "landmarks in common" in result.stdout
    assert sorted(file.name for file in out.iterdir()) == [
        "jawOpen.obj", "joy.obj", "neutral.obj", "rig.json",
    ]  # fmt: skip


def test_a_source_without_landmarks_is_refused_with_the_way_out(
    small_rig: Path, tmp_path: Path
) -> None:
    bare = tmp_path / "bare.npz"
    replace(Rig.load(small_rig), landmarks={}).save(bare)
    result = run("clone", bare, "builtin", "-o", tmp_path / "out.npz")
    assert result.exit_code == 1
    assert "--source-landmarks" in result.stderr
    assert not (tmp_path / "out.npz").exists()


def test_a_mesh_without_shapes_is_no_source(tmp_path: Path) -> None:
    result = run("clone", asset("head.obj"), "builtin", "-o", tmp_path / "out.npz")
    assert result.exit_code == 1
    assert "cannot read a rig with the ending '.obj'" in result.stderr


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["--local-scale", "2"], "local_scale: 2 is above 1"),
        (["-o", "out.xyz"], "cannot write a rig with the ending '.xyz'"),
    ],
)
def test_wrong_settings_are_refused(small_rig: Path, options: list[str], words: str) -> None:
    given = options if "-o" in options else ["-o", "out.npz", *options]
    result = run("clone", small_rig, "builtin", *given)
    assert result.exit_code == 1
    assert words in result.stderr


def test_rigs_of_different_heads_are_not_compared(small_rig: Path, tmp_path: Path) -> None:
    rig = Rig.load(small_rig)
    other = tmp_path / "other.npz"
    replace(rig, mesh=replace(rig.mesh, positions=2.0 * rig.mesh.positions)).save(other)
    result = run("compare", small_rig, other)
    assert result.exit_code == 1
    assert "only rigs of one mesh can be compared" in result.stderr
