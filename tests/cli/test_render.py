"""`risorius render`."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from risorius.render import read_png
from tests.cli.running import answer, asset, run


def _picture(tmp_path: Path, *arguments: object) -> np.ndarray:
    out = tmp_path / "picture.png"
    result = run("render", *arguments, "-o", out, "--quiet")
    assert result.exit_code == 0, result.stderr
    return read_png(out)


@pytest.mark.parametrize("view", ["front", "three-quarter", "profile", "face", "mouth", "eyes"])
def test_every_view_shows_something_in_the_size_asked_for(
    tmp_path: Path, rig_file: Path, view: str
) -> None:
    picture = _picture(tmp_path, rig_file, "--view", view, "--size", "90x120")
    assert picture.shape == (120, 90, 3)
    assert picture.std() > 15.0


def test_a_pose_changes_the_picture_and_its_weight_how_much(tmp_path: Path, rig_file: Path) -> None:
    options = ("--view", "mouth", "--size", "96x96")
    rest = _picture(tmp_path, rig_file, *options).astype(float)
    half = _picture(tmp_path, rig_file, *options, "--pose", "jawOpen=0.3").astype(float)
    full = _picture(tmp_path, rig_file, *options, "--pose", "jawOpen").astype(float)
    assert 1.0 < np.abs(half - rest).mean() < np.abs(full - rest).mean()


def test_a_head_gets_its_shapes_on_the_way(tmp_path: Path, rig_file: Path) -> None:
    options = ("--size", "80x80", "--pose", "joy=1")
    of_rig = _picture(tmp_path, rig_file, *options)
    of_head = _picture(tmp_path, asset("head.obj"), *options)
    of_word = _picture(tmp_path, "builtin", *options)
    assert (of_head == of_word).all()
    # The rig keeps its positions as float32.
    assert np.abs(of_head.astype(float) - of_rig).mean() < 0.5


def test_the_camera_turns(tmp_path: Path, rig_file: Path) -> None:
    profile = _picture(tmp_path, rig_file, "--view", "profile", "--size", "64x64")
    turned = _picture(tmp_path, rig_file, "--yaw", 90, "--size", "64x64")
    assert (profile == turned).all()


def test_several_views_make_a_page(tmp_path: Path, rig_file: Path) -> None:
    page = _picture(tmp_path, rig_file, "--view", "front,mouth,eyes", "--size", "64x64")
    assert page.shape[1] > 3 * 64
    assert page.shape[0] > 64


def test_the_sheet_shows_all_shapes(tmp_path: Path) -> None:
    run("rig", "builtin", "-o", tmp_path / "six.npz", "--shapes", "emotions", "-q")
    page = _picture(tmp_path, tmp_path / "six.npz", "--sheet")
    assert page.shape[1] > 1000
    told = answer(
        run("render", tmp_path / "six.npz", "--sheet", "-o", tmp_path / "s.png", "--json")
    )
    assert told["sheet"] == str(tmp_path / "s.png")


@pytest.mark.parametrize(
    ("options", "code", "sentence"),
    [
        (["--view", "back"], 1, "'back' is not one of"),
        (["--view", ","], 1, "give at least one of"),
        (["--pose", "jawOpn"], 1, "there is no 'jawOpn' among"),
        (["--pose", "jawOpen=wide"], 2, "is not name=weight"),
        (["--size", "big"], 2, "is not WIDTHxHEIGHT"),
        (["--size", "9x9"], 2, "is not WIDTHxHEIGHT"),
    ],
)
def test_wrong_wishes_are_refused(
    tmp_path: Path, rig_file: Path, options: list[str], code: int, sentence: str
) -> None:
    result = run("render", rig_file, "-o", tmp_path / "p.png", *options)
    assert result.exit_code == code
    assert sentence in result.stderr
    assert not (tmp_path / "p.png").exists()


def test_a_near_name_is_offered(tmp_path: Path, rig_file: Path) -> None:
    result = run("render", rig_file, "-o", tmp_path / "p.png", "--pose", "jawOpn")
    assert "did you mean jawOpen" in result.stderr


def test_another_picture_format_is_refused(tmp_path: Path, rig_file: Path) -> None:
    result = run("render", rig_file, "-o", tmp_path / "p.jpg")
    assert result.exit_code == 1
    assert "pictures are PNG files" in result.stderr


def test_a_rig_from_elsewhere_is_framed_by_landmarks_that_are_given(
    tmp_path: Path, rig_file: Path
) -> None:
    foreign = tmp_path / "foreign"
    run("rig", rig_file, "-o", foreign, "--shapes", "emotions", "-q")
    (foreign / "rig.json").unlink()
    mouth = ("render", foreign, "-o", tmp_path / "p.png", "--view", "mouth", "--size", "64x64")
    result = run(*mouth)
    assert result.exit_code == 1
    assert "the view of the mouth needs 2.4" in result.stderr
    assert run(*mouth, "-l", asset("head.landmarks.json")).exit_code == 0
    assert _picture(tmp_path, foreign, "--pose", "joy", "--size", "64x64").std() > 15.0
