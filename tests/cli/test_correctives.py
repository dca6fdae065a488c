"""`risorius rig --correctives`."""

from __future__ import annotations

from pathlib import Path

from risorius.rig import Rig
from tests.cli.running import answer, run


def test_correctives_are_added_behind_the_shapes_and_their_gain_is_told(tmp_path: Path) -> None:
    out = tmp_path / "x.glb"
    options = ("--shapes", "visemes_oculus", "--correctives", "3", "-m", "vector", "--json")
    told = answer(run("rig", "builtin", "-o", out, *options))
    assert 1 <= len(told["correctives"]) <= 3
    names = [f"pair_{pair['first']}__{pair['second']}" for pair in told["correctives"]]
    assert list(Rig.load(out).names[-len(names) :]) == names
    assert all(pair["after"] < pair["before"] for pair in told["correctives"])


def test_a_negative_number_of_correctives_is_refused(tmp_path: Path) -> None:
    assert run("rig", "builtin", "-o", tmp_path / "x.glb", "--correctives", "-1").exit_code == 2
