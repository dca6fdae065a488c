"""`risorius transfer` and `risorius tune`."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from risorius.anatomy.template import builtin_head
from risorius.cli.asking import Answer, choose, parse_answer, scripted
from risorius.cli.main import app
from risorius.errors import ParameterError
from risorius.project import read_vector_set
from risorius.render import read_png
from risorius.tuning import Genome, Parameter, Session
from risorius.tuning.style import read_style
from tests.cli.running import answer, asset, run


def test_muscles_carried_to_their_own_head_are_the_same_and_rig_takes_them(tmp_path: Path) -> None:
    out, sheet = tmp_path / "own.json", tmp_path / "own.png"
    told = answer(run("transfer", "builtin", "-o", out, "--sheet", sheet, "--json"))
    assert told["output"] == str(out)
    assert told["features"]["nose_tip"]["from"] == "9.3"
    carried = read_vector_set(out)
    for before, after in zip(
        carried.muscles, read_vector_set(out).fitted(builtin_head()).muscles, strict=True
    ):
        assert np.abs(before.ends() - after.ends()).max() < 0.01
    assert read_png(sheet).std() > 15.0
    rig = tmp_path / "own.npz"
    options = ("--shapes", "emotions", "--method", "vector", "-q")
    assert run("rig", "builtin", "--vectors", out, "-o", rig, *options).exit_code == 0


def test_picks_written_on_the_command_line_tune_and_make_a_style(tmp_path: Path) -> None:
    out, style = tmp_path / "tuned.json", tmp_path / "mine.style.json"
    done = run(
        "tune", "builtin", "-o", out, "--expression", "anger", "--strategy", "genetic",
        "--picks", "4,1,7", "--style-output", style, "--json",
    )  # fmt: skip
    told = answer(done)
    assert told["ok"]
    assert told["style"] == pytest.approx(read_style(style).parameters, abs=1e-6)
    assert any(name.startswith("procerus.") for name in told["style"])
    assert read_png(tmp_path / "tuned.png").shape[0] > 800
    plain, worn = tmp_path / "plain.json", tmp_path / "worn.json"
    run("transfer", "builtin", "-o", plain, "-q")
    run("transfer", "builtin", "-o", worn, "--style", style, "-q")
    assert worn.read_text() == out.read_text() != plain.read_text()


def test_numbers_are_asked_for_over_a_plain_line(tmp_path: Path) -> None:
    out = tmp_path / "typed.json"
    words = ["tune", "builtin", "-o", str(out), "--expression", "disgust", "--json"]
    typed = "?\nnonsense\na 2\n"
    result = CliRunner().invoke(app, [*words, "--strategy", "genetic"], input=typed)
    assert result.exit_code == 0, result.stderr
    assert "'nonsense' is not understood" in result.stderr
    assert "numbers of the faces you like" in result.stderr
    assert json.loads(result.stdout)["style"]


def test_a_sculpted_head_needs_nobody(tmp_path: Path) -> None:
    lines = asset("head.obj").read_text().splitlines()
    lifted = []
    for line in lines:
        if line.startswith("v "):
            x, y, z = map(float, line.split()[1:4])
            rise = 4.0 * np.exp(-(((abs(x) - 26.0) / 9.0) ** 2) - ((y + 69.0) / 12.0) ** 2)
            line = f"v {x:.4f} {y + (rise if z > 20.0 else 0.0):.4f} {z:.4f}"
        lifted.append(line)
    sculpted = tmp_path / "smile.obj"
    sculpted.write_text("\n".join(lifted))
    options = ("--target", sculpted, "--generations", "4", "--expression", "disgust", "--json")
    told = answer(run("tune", "builtin", "-o", tmp_path / "fit.json", *options))
    assert told["distances"]["disgust"]["after"] <= told["distances"]["disgust"]["before"]


def test_lines_mean_what_the_help_says() -> None:
    assert parse_answer("1, 4 7") == Answer("pick", (0, 3, 6))
    assert parse_answer("") == Answer("reroll")
    assert parse_answer("u") == Answer("undo")
    assert parse_answer("l a.b c") == Answer("lock", names=("a.b", "c"))
    assert parse_answer("a") == Answer("accept")
    assert parse_answer("A 3") == Answer("accept", (2,))
    assert parse_answer("q") == Answer("quit")
    for text in ("yes", "1;2", "a 1 2", "2.5"):
        with pytest.raises(ParameterError, match="is not understood"):
            parse_answer(text)


def test_a_script_locks_opens_and_ends() -> None:
    session = Session(Genome((Parameter("a", 0.0, 1.0, 0.5), Parameter("b", 0.0, 1.0, 0.5))))
    shown: list[int] = []
    values, ended = choose(
        session,
        scripted("2;l a;3,4;o a;r;q"),
        lambda now: shown.append(now.generation.number),
        forgiving=False,
    )
    assert ended
    assert shown == [0, 1, 1, 2, 2, 2]
    assert values == session.best
    with pytest.raises(ParameterError, match="give different numbers"):
        choose(session, scripted("12"), lambda now: None, forgiving=False)


@pytest.mark.parametrize(
    ("options", "code", "sentence"),
    [
        (["--expression", "bliss"], 1, "'bliss' is not one of"),
        (["--expression", ","], 1, "give at least one of"),
        (["--picks", "0"], 1, "give different numbers"),
        (["--strategy", "luck"], 2, "luck"),
        (["--target-point", "nose=1,2"], 2, "is not NAME=X,Y,Z"),
        (["--target-point", "chin=1,2,3"], 1, "chin is none of nose_tip"),
        (["--target", "a.obj", "--expression", "joy,anger"], 1, "shows one expression"),
        (["-o", "x.txt"], 1, "a recipe is a text file"),
        (["--view", "back"], 1, "'back' is not one of"),
    ],
)
def test_wrong_wishes_are_refused(
    tmp_path: Path, options: list[str], code: int, sentence: str
) -> None:
    output = [] if "-o" in options else ["-o", str(tmp_path / "x.json")]
    result = run("tune", "builtin", *output, "--strategy", "genetic", *options)
    assert result.exit_code == code
    assert sentence in " ".join(result.stderr.split())
    assert not list(tmp_path.glob("*.json"))
