"""`risorius play` and `risorius convert`."""

from __future__ import annotations

from pathlib import Path

import pytest

from risorius.io.motion import read_stream
from tests.cli.running import answer, run
from tests.io.glb import unpack
from tests.io.motion.streams import stream_of
from tests.tools import require_module


@pytest.fixture(scope="module")
def take(tmp_path_factory: pytest.TempPathFactory) -> Path:
    from risorius.io.motion import write_stream

    path = tmp_path_factory.mktemp("take") / "take.fap"
    write_stream(stream_of([{"fap_3": 30.0 * n, "fap_48": 5.0} for n in range(4)]), path)
    return path


def test_a_stream_becomes_the_animation_of_the_rig(
    tmp_path: Path, rig_file: Path, take: Path
) -> None:
    out = tmp_path / "x.glb"
    result = run("play", rig_file, take, "-o", out, "--rate", "50", "--loops", "2", "--json")
    assert result.exit_code == 0, result.stderr
    told = answer(result)
    assert (told["frames"], told["rate"]) == (14, 50.0)
    assert (told["unmatched"], told["turns_head"]) == ({}, True)
    json, _ = unpack(out.read_bytes())
    assert [animation["name"] for animation in json["animations"]] == ["take"]


def test_a_name_without_ending_becomes_a_folder_of_pictures(
    tmp_path: Path, rig_file: Path, take: Path
) -> None:
    result = run("play", rig_file, take, "-o", tmp_path / "film", "--size", "32x32", "--rate", "10")
    assert result.exit_code == 0, result.stderr
    assert len(list((tmp_path / "film").glob("frame_*.png"))) == 2
    assert "not played" not in result.stdout


@pytest.mark.parametrize(
    ("name", "options", "message"),
    [
        ("x.bvh", (), "no ending of motion; known: .glb .usd .usda .usdc .usdz .mp4"),
        ("none/x.glb", (), "the folder"),
        ("x.glb", ("--speed", "0"), "speed: 0 is below 0.001"),
        ("x.glb", ("--easing", "bouncy"), "easing: 'bouncy' is not one of"),
        ("x.glb", ("--size", "huge"), "is not WIDTHxHEIGHT"),
        ("x.glb", ("--live",), "has no muscles any more"),
    ],
)
def test_what_cannot_end_well_is_refused_before_the_work(
    tmp_path: Path, rig_file: Path, take: Path, name: str, options: tuple[str, ...], message: str
) -> None:
    result = run("play", rig_file, take, "-o", tmp_path / name, *options)
    assert result.exit_code in (1, 2)
    assert message in " ".join(result.stderr.replace("│", " ").split())
    assert list(tmp_path.iterdir()) == []


def test_a_stream_becomes_time_samples_of_usd(tmp_path: Path, rig_file: Path, take: Path) -> None:
    require_module("pxr")
    from pxr import Usd, UsdSkel

    out = tmp_path / "x.usdc"
    result = run("play", rig_file, take, "-o", out)
    assert result.exit_code == 0, result.stderr
    stage = Usd.Stage.Open(str(out))
    animation = UsdSkel.Animation(stage.GetPrimAtPath("/Head/Animation"))
    assert animation.GetBlendShapeWeightsAttr().GetTimeSamples() == [0.0, 1.0, 2.0, 3.0]
    assert animation.GetRotationsAttr().GetTimeSamples() == [0.0, 1.0, 2.0, 3.0]


def test_the_face_of_a_project_plays_live(tmp_path: Path, take: Path) -> None:
    project = tmp_path / "head.project.json"
    assert run("project", "new", "builtin", "-o", project, "-m", "vector").exit_code == 0
    out = tmp_path / "x.glb"
    told = answer(run("play", project, take, "-o", out, "--live", "--json"))
    assert told["frames"] == 4
    assert told["physics"] is False
    assert told["shapes"] <= 4
    json, _ = unpack(out.read_bytes())
    assert {c["target"]["path"] for c in json["animations"][0]["channels"]} == {
        "weights",
        "rotation",
    }


def test_a_stream_becomes_one_of_another_standard(
    tmp_path: Path, rig_file: Path, take: Path
) -> None:
    out = tmp_path / "take.csv"
    result = run("convert", take, out, "--rig", rig_file)
    assert result.exit_code == 0, result.stderr
    assert "4 frames of arkit" in result.stdout
    stream = read_stream(out)
    assert "jawOpen" in stream.names
    back = tmp_path / "back.fap"
    told = answer(run("convert", out, back, "--rig", rig_file, "--json"))
    assert told["to"] == "fap"
    *_, last = read_stream(back)
    assert last.values["fap_3"] == pytest.approx(90.0, abs=5.0)


def test_a_set_that_the_rig_lacks_is_refused(tmp_path: Path, rig_file: Path, take: Path) -> None:
    result = run("convert", take, tmp_path / "x.csv", "--rig", rig_file, "--to", "facs")
    assert result.exit_code == 1
    assert "no shapes of the set 'facs'" in result.stderr
    assert list(tmp_path.iterdir()) == []
