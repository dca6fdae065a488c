"""`risorius blend`."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from risorius.controls import default_presets
from risorius.io.motion import read_stream
from risorius.project import read_presets
from tests.cli.running import answer, run


def test_emotions_come_stay_and_go(tmp_path: Path) -> None:
    out = tmp_path / "x.csv"
    curve = ("--onset", "0.2", "--apex", "0.4", "--offset", "0.2", "--rate", "10")
    told = answer(run("blend", "joy=0.6,surprise=0.3", "-o", out, *curve, "--json"))
    assert (told["frames"], told["duration"]) == (9, pytest.approx(0.8))
    frames = list(read_stream(out))
    assert [frame.values["joy"] for frame in frames] == pytest.approx(
        [0.0, 0.3, 0.6, 0.6, 0.6, 0.6, 0.6, 0.3, 0.0]
    )
    assert frames[3].values["surprise"] == pytest.approx(0.3)


def test_a_blend_becomes_an_expression_of_a_presets_file(tmp_path: Path) -> None:
    out = tmp_path / "mine.presets.json"
    result = run("blend", "joy=0.5,anger=0.5", "-o", out, "--preset", "smirk")
    assert result.exit_code == 0, result.stderr
    book, shipped = read_presets(out), default_presets()
    joy, anger = shipped.emotions["joy"], shipped.emotions["anger"]
    pose = book.emotions["smirk"]
    assert set(pose) == {*joy, *anger}
    for name, value in pose.items():
        wanted = 0.5 * joy.get(name, 0.0) + 0.5 * anger.get(name, 0.0)
        assert value == pytest.approx(wanted, abs=1e-4)
    assert book.arkit == shipped.arkit
    assert "zygomaticus_major" in json.loads(out.read_text())["emotions"]["smirk"]
    rig = tmp_path / "x.glb"
    options = ("--presets", out, "--shapes", "emotions", "-m", "vector", "--json")
    assert "smirk" in answer(run("rig", "builtin", "-o", rig, *options))["shapes"]


def test_no_muscle_of_a_blend_leaves_its_range(tmp_path: Path) -> None:
    out = tmp_path / "mine.json"
    run("blend", "joy,disgust,anger,sadness,fear,surprise", "-o", out, "--preset", "all_at_once")
    pose = read_presets(out).emotions["all_at_once"]
    assert max(value for name, value in pose.items() if not name.startswith("jaw")) == 1.0


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("happy=1", "-o", "x.csv"), "'happy' is not one of joy"),
        (("joy=2", "-o", "x.csv"), "joy: 2 is above 1"),
        (("joy", "-o", "x.csv", "--onset", "-1"), "onset: -1 is below 0"),
        (("joy", "-o", "x.bvh"), "is no ending of a stream"),
        (("joy", "-o", "x.json", "--preset", "fear"), "is the name of a standard shape"),
        (("joy", "-o", "x.json", "--preset", "a b"), "is no name of a shape"),
        (("joy", "-o", "x.csv", "--preset", "mine"), "ends in .json"),
    ],
)
def test_what_makes_no_blend_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, arguments: tuple[str, ...], message: str
) -> None:
    monkeypatch.chdir(tmp_path)
    result = run("blend", *arguments)
    assert result.exit_code == 1
    assert message in " ".join(result.stderr.split())
    assert list(tmp_path.iterdir()) == []
