"""`risorius rig`."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from risorius import Rig, builtin_head
from risorius.cli import sources
from risorius.controls.presets import EMOTIONS
from risorius.landmarks import mirror_name
from tests.cli.running import answer, asset, run
from tests.tools import require_module

STAGES = ["read", "parts+lips+lids", "muscles", "bake", "normals+write"]


def _swapped_landmarks(folder: Path) -> Path:
    document = json.loads(asset("head.landmarks.json").read_text("utf-8"))
    document["landmarks"] = {
        mirror_name(name): place for name, place in document["landmarks"].items()
    }
    path = folder / "swapped.json"
    path.write_text(json.dumps(document))
    return path


@pytest.mark.parametrize("name", ["face.glb", "face.npz", "face"])
def test_every_ending_holds_the_shapes_and_the_neutral_head(tmp_path: Path, name: str) -> None:
    result = run("rig", "builtin", "-o", tmp_path / name, "--shapes", "emotions")
    assert result.exit_code == 0, result.stderr
    rig = Rig.load(tmp_path / name)
    assert sorted(rig.names) == sorted(EMOTIONS)
    assert np.allclose(rig.mesh.positions, builtin_head().source.positions, atol=1e-5)
    assert len(rig.target("joy").vertices) > 100


def test_usd_is_written(tmp_path: Path) -> None:
    require_module("pxr")
    result = run("rig", "builtin", "-o", tmp_path / "face.usda", "--shapes", "emotions")
    assert result.exit_code == 0, result.stderr
    assert "joy" in (tmp_path / "face.usda").read_text()


def test_usd_without_its_extra_is_refused_before_the_work(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("risorius.cli.outputs.find_spec", lambda name: None)
    result = run("rig", "builtin", "-o", tmp_path / "face.usdc")
    assert result.exit_code == 1
    assert "pip install risorius[usd]" in result.stderr


def test_json_is_all_there_is_on_standard_output(tmp_path: Path) -> None:
    out = tmp_path / "face.glb"
    result = run("rig", "builtin", "-o", out, "--shapes", "emotions", "--json")
    told = answer(result)
    assert result.stderr == ""
    assert told["ok"] is True
    assert told["output"] == str(out)
    assert told["bytes"] == out.stat().st_size
    assert sorted(told["shapes"]) == sorted(EMOTIONS)
    assert told["left_out"] == {}
    assert list(told["seconds"]) == STAGES
    assert all(seconds >= 0.0 for seconds in told["seconds"].values())
    assert told["frame"]["description"] == "unit mm (1 mm), up +Y, forward +Z"
    assert told["parts"]["tongue"] > 50


def test_text_tells_frame_parts_shapes_and_seconds(tmp_path: Path) -> None:
    result = run("rig", "builtin", "-o", tmp_path / "face.glb", "--shapes", "emotions")
    assert "frame: unit mm (1 mm), up +Y, forward +Z" in result.stdout
    assert "parts: skin, eye_left" in result.stdout
    assert f"{len(EMOTIONS)} shapes" in result.stdout
    for stage in STAGES:
        assert f"{stage} " in result.stdout


def test_quiet_says_nothing(tmp_path: Path) -> None:
    result = run("rig", "builtin", "-o", tmp_path / "face.npz", "--shapes", "emotions", "--quiet")
    assert (result.exit_code, result.stdout, result.stderr) == (0, "", "")


def test_the_same_command_writes_the_same_bytes(tmp_path: Path) -> None:
    for name in ("a.glb", "b.glb"):
        run("rig", "builtin", "-o", tmp_path / name, "--shapes", "emotions", "--animation")
    assert (tmp_path / "a.glb").read_bytes() == (tmp_path / "b.glb").read_bytes()


def test_unit_and_axes_of_the_input_are_found_and_kept(tmp_path: Path) -> None:
    lines = asset("head.obj").read_text("utf-8").splitlines()
    turned = []
    for line in lines:
        words = line.split()
        if words and words[0] == "v":  # millimetres, +Y+Z -> centimetres, +Z-Y
            x, y, z = (0.1 * float(word) for word in words[1:4])
            line = f"v {x!r} {-z!r} {y!r}"
        turned.append(line)
    head = tmp_path / "head.obj"
    head.write_text("\n".join(turned) + "\n")
    (tmp_path / "head.landmarks.json").write_bytes(asset("head.landmarks.json").read_bytes())
    result = run("rig", head, "-o", tmp_path / "face.npz", "--shapes", "emotions")
    assert result.exit_code == 0, result.stderr
    assert "unit cm (10 mm), up +Z, forward -Y" in result.stdout
    rig = Rig.load(tmp_path / "face.npz")
    usual = Rig.load(_built_in(tmp_path))
    x, y, z = usual.target("joy").deltas.T
    moved = rig.target("joy").dense(rig.mesh.vertex_count)[usual.target("joy").vertices]
    assert np.allclose(moved, 0.1 * np.stack([x, -z, y], axis=1), atol=1e-4)


def _built_in(folder: Path) -> Path:
    run("rig", "builtin", "-o", folder / "usual.npz", "--shapes", "emotions")
    return folder / "usual.npz"


def test_landmarks_beside_the_head_are_taken(tmp_path: Path) -> None:
    result = run("rig", asset("head.obj"), "-o", tmp_path / "f.npz", "--shapes", "emotions", "-q")
    assert result.exit_code == 0, result.stderr


@pytest.mark.parametrize(
    ("head", "output", "sentence"),
    [
        ("none.obj", "f.glb", "no such file"),
        ("folder", "f.glb", "folder"),
        ("bare.obj", "f.glb", "give a landmark file with --landmarks"),
        ("builtin", "f.fbx", "cannot write a rig with the ending '.fbx'; known: .glb"),
        ("builtin", "f.obj", "an OBJ file holds one shape only; give a folder"),
        ("builtin", "none/f.glb", "none does not exist; create it first"),
        ("builtin", "file/f.glb", "does not exist"),
        ("builtin", "file", "is a file"),
    ],
)
def test_what_cannot_be_used_is_refused_in_one_sentence(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, head: str, output: str, sentence: str
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("folder").mkdir()
    Path("file").write_text("mine")
    Path("bare.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    before = sorted(tmp_path.iterdir())
    result = run("rig", head, "-o", output)
    assert result.exit_code == 1
    assert result.stderr.startswith("risorius: ")
    assert result.stderr.count("\n") == 1
    assert sentence in result.stderr
    assert sorted(tmp_path.iterdir()) == before


@pytest.mark.parametrize("output", ["f.fbx", "none/f.glb"])
def test_the_output_is_checked_before_the_work(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, output: str
) -> None:
    def work(*_: object) -> None:
        pytest.fail("the head was read")

    monkeypatch.setattr(sources, "read_mesh", work)
    assert run("rig", "builtin", "-o", tmp_path / output).exit_code == 1
    assert run("rig", "builtin", "-o", tmp_path / "f.glb", "--sheet", "s.jpg").exit_code == 1


def test_swapped_landmarks_are_refused_with_the_way_out(tmp_path: Path) -> None:
    marks = _swapped_landmarks(tmp_path)
    command = ("rig", asset("head.obj"), "-l", marks, "-o", tmp_path / "f.npz", "--shapes", "arkit")
    result = run(*command)
    assert result.exit_code == 1
    assert "left and right are swapped" in result.stderr
    assert "--flip-landmarks" in result.stderr
    assert run(*command, "--flip-landmarks").exit_code == 0


@pytest.mark.real
def test_a_mask_whose_mouth_and_eyes_are_not_open_is_refused(
    tmp_path: Path, real_data: Path
) -> None:
    folder = real_data / "mediapipe_canonical"
    head = next(folder.glob("*.obj"))
    result = run("rig", head, "-l", folder / "landmarks.json", "-o", tmp_path / "f.glb")
    assert result.exit_code == 1
    assert "the mouth cannot be opened" in result.stderr
    assert not (tmp_path / "f.glb").exists()


def test_shapes_that_cannot_be_made_are_listed_with_the_reason(tmp_path: Path) -> None:
    book = {
        "schema": "risorius/presets",
        "version": 1,
        "arkit": {"jawOpen": {"jaw_pitch": 10.0}, "mouthFunnel": {"nose_wiggle": 1.0}},
    }
    presets = tmp_path / "presets.json"
    presets.write_text(json.dumps(book))
    command = ("rig", "builtin", "-o", tmp_path / "f.npz", "--presets", presets)
    result = run(*command, "--shapes", "arkit")
    assert "left out (51):" in result.stdout
    assert "  eyeBlinkLeft: no pose in the presets makes it" in result.stdout
    assert "  mouthFunnel: the face has no nose_wiggle" in result.stdout
    told = answer(run(*command, "--shapes", "arkit", "--json"))
    assert told["shapes"] == ["jawOpen"]
    assert len(told["left_out"]) == 51


def test_notes_are_said_once_and_stand_in_the_answer(tmp_path: Path) -> None:
    document = json.loads(asset("head.landmarks.json").read_text("utf-8"))
    document["landmarks"]["my_point"] = {"vertex": 3}
    marks = tmp_path / "marks.json"
    marks.write_text(json.dumps(document))
    command = ("rig", asset("head.obj"), "-l", marks, "-o", tmp_path / "f.npz")
    result = run(*command, "--shapes", "emotions")
    assert result.stderr.count("note: ") == 1
    assert "'my_point' are not MPEG-4 feature points" in result.stderr
    told = answer(run(*command, "--shapes", "emotions", "--json"))
    assert len(told["notes"]) == 1


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        (["--part", "tongue"], "is not KIND=NAME"),
        (["--part", "tongue=a", "--part", "tongue=b"], "contradict each other"),
        (["--part", "tongue=a", "--part", "skin=a"], "contradict each other"),
        (["--method", "magic"], "'magic'"),
        (["--profile", "best"], "'best'"),
    ],
)
def test_a_command_written_wrongly_ends_with_2(
    tmp_path: Path, options: list[str], sentence: str
) -> None:
    result = run("rig", "builtin", "-o", tmp_path / "f.glb", *options)
    assert result.exit_code == 2
    assert sentence in result.stderr


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        (["--part", "ear=head"], "'ear' is not one of"),
        (["--part", "tongue=zunge"], "nothing in the file is named 'zunge'"),
        (["--shapes", "visemes"], "'visemes' is not one of"),
        (["--unit", "parsec"], "'parsec' is not one of"),
        (["--axes", "+Y"], "'+Y' is not understood"),
    ],
)
def test_a_word_that_does_not_exist_is_refused_with_the_choices(
    tmp_path: Path, options: list[str], sentence: str
) -> None:
    result = run("rig", "builtin", "-o", tmp_path / "f.glb", *options)
    assert result.exit_code == 1
    assert sentence in result.stderr


def test_the_profile_changes_the_shapes(tmp_path: Path) -> None:
    for profile in ("improved", "faithful"):
        out = tmp_path / f"{profile}.npz"
        run(
            "rig",
            "builtin",
            "-o",
            out,
            "-m",
            "vector",
            "--profile",
            profile,
            "--shapes",
            "emotions",
        )
    improved, faithful = (
        Rig.load(tmp_path / f"{name}.npz").target("joy").dense(builtin_head().vertex_count)
        for name in ("improved", "faithful")
    )
    assert np.abs(improved - faithful).max() > 0.1


def test_spring_muscles_stand_on_the_bones_that_were_asked_for(tmp_path: Path) -> None:
    out = tmp_path / "face.npz"
    options = ("--method", "springs", "--bones", "cut", "--shapes", "emotions")
    assert run("rig", "builtin", "-o", out, *options).exit_code == 0
    assert {"joy", "fear"} <= {target.name for target in Rig.load(out).targets}
    result = run("rig", "builtin", "-o", out, "--method", "springs", "--bones", "given")
    assert result.exit_code == 1
    assert "'given' needs a skull; name it with --skull" in result.stderr


@pytest.mark.parametrize("name", ["face.glb/", "v1.2/"])
def test_a_new_folder_with_an_ending_is_refused_before_the_work(tmp_path: Path, name: str) -> None:
    result = run("rig", "builtin", "-o", f"{tmp_path}/{name}")
    assert result.exit_code == 1
    assert "a name without ending; leave out" in result.stderr
    assert "seconds" not in result.stdout
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("shapes", ["", " , "])
def test_an_empty_list_of_shapes_is_refused(tmp_path: Path, shapes: str) -> None:
    result = run("rig", "builtin", "-o", tmp_path / "f.npz", "--shapes", shapes)
    assert result.exit_code == 1
    assert "names no set; choose from singles" in result.stderr
    assert not list(tmp_path.iterdir())
