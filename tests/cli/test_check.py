"""`risorius check`."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.cli.running import answer, asset, run


def _landmarks_without(folder: Path, *names: str) -> Path:
    document = json.loads(asset("head.landmarks.json").read_text("utf-8"))
    for name in names:
        del document["landmarks"][name]
    path = folder / "fewer.json"
    path.write_text(json.dumps(document))
    return path


def test_the_built_in_head_is_fit() -> None:
    result = run("check", "builtin")
    assert result.exit_code == 0
    assert "fit: this head can be rigged" in result.stdout
    assert "frame: unit mm (1 mm)" in result.stdout
    assert "in 1 piece" in result.stdout
    told = answer(run("check", "builtin", "--json"))
    assert told["fit"] is True
    assert told["topology"]["non_manifold_edges"] == 0
    assert told["missing_parts"] == {}
    assert told["lids"] == ["l", "r"]
    assert "jawOpen" in told["shapes"]
    assert all(not feature["missing"] for feature in told["features"] if feature["required"])


def test_missing_landmarks_are_named_with_what_they_serve(tmp_path: Path) -> None:
    marks = _landmarks_without(tmp_path, "3.1", "7.1")
    result = run("check", asset("head.obj"), "-l", marks)
    assert result.exit_code == 0
    assert "left eyelids: 1 of 4 missing; without them the left eye does not blink" in result.stdout
    assert "3.1  " in result.stdout
    assert "left eyelids left out: landmarks 3.1 are missing" in result.stderr
    told = answer(run("check", asset("head.obj"), "-l", marks, "--json"))
    assert told["lids"] == ["r"]
    assert "eyeBlinkLeft" in told["left_out"]
    assert "eyeBlinkRight" in told["shapes"]


@pytest.mark.parametrize(
    ("name", "sentence"),
    [
        ("2.4", "telling the lips apart needs 2.4"),
        ("3.7", "the frame of the head needs 3.7"),
        ("9.3", "9.3"),
    ],
)
def test_a_head_that_cannot_be_rigged_ends_with_1_and_says_why(
    tmp_path: Path, name: str, sentence: str
) -> None:
    marks = _landmarks_without(tmp_path, name)
    result = run("check", asset("head.obj"), "-l", marks)
    assert result.exit_code == 1
    assert "not fit:" in result.stdout
    assert name in result.stdout.partition("not fit:")[2]
    told = answer(run("check", asset("head.obj"), "-l", marks, "--json"))
    assert told["ok"] is False
    assert told["fit"] is False
    assert name in told["problem"]


def test_every_required_landmark_is_needed_in_truth(tmp_path: Path) -> None:
    told = answer(run("landmarks", "--needed", "--json"))
    names = [point["name"] for point in told["landmarks"]]
    assert len(names) >= 12
    for name in names:
        marks = _landmarks_without(tmp_path, name)
        result = run("check", asset("head.obj"), "-l", marks, "--quiet")
        assert result.exit_code == 1, name


def test_a_missing_file_is_an_error_and_no_verdict() -> None:
    result = run("check", "none.obj")
    assert result.exit_code == 1
    assert result.stderr == "risorius: none.obj: no such file; check its name and its folder\n"


@pytest.mark.real
def test_a_mask_is_told_apart_from_a_head(real_data: Path) -> None:
    folder = real_data / "mediapipe_canonical"
    result = run("check", next(folder.glob("*.obj")), "-l", folder / "landmarks.json")
    assert result.exit_code == 1
    assert "the mouth cannot be opened" in result.stdout
    assert "no eye_left" in result.stdout


@pytest.mark.real
@pytest.mark.parametrize(
    ("head", "marks", "frame"),
    [
        ("ict_facekit/ict_neutral.obj", "ict_facekit/landmarks.json", "unit cm (10 mm)"),
        (
            "makehuman_head/african_female_young.obj",
            "makehuman_head/landmarks.json",
            "unit dm (100 mm)",
        ),
    ],
)
def test_real_heads_are_fit(real_data: Path, head: str, marks: str, frame: str) -> None:
    told = answer(run("check", real_data / head, "-l", real_data / marks, "--json"))
    assert told["fit"] is True
    assert told["frame"]["description"].startswith(frame)
    assert told["left_out"] == {}
