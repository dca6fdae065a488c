"""`risorius demo`."""

from __future__ import annotations

from pathlib import Path

import pytest

from risorius import Rig
from risorius.controls import arkit_shapes
from risorius.controls.presets import EMOTIONS
from risorius.render import read_png
from tests.cli.running import answer, run


@pytest.mark.slow
def test_the_demo_makes_a_rig_and_pictures_of_it(tmp_path: Path) -> None:
    out = tmp_path / "out"
    told = answer(run("demo", "-o", out, "--json"))
    assert told["ok"] is True
    rig = Rig.load(out / "demo.glb")
    wanted = {*EMOTIONS, *(shape.name for shape in arkit_shapes())} - set(told["left_out"])
    assert wanted <= set(rig.names)
    assert "zygomaticus_major_l" in rig.names
    sheet, views = read_png(out / "sheet.png"), read_png(out / "views.png")
    # A row of ten pictures has about this height; there is one for each shape.
    assert sheet.shape[0] > 150 * len(rig.names) / 10
    assert views.std() > 20.0
    assert sorted(path.name for path in out.iterdir()) == ["demo.glb", "sheet.png", "views.png"]


def test_a_file_in_the_place_of_the_folder_is_refused(tmp_path: Path) -> None:
    (tmp_path / "out").write_text("mine")
    result = run("demo", "-o", tmp_path / "out")
    assert result.exit_code == 1
    assert "is a file, a folder was expected" in result.stderr
    assert (tmp_path / "out").read_text() == "mine"


def test_a_folder_in_a_missing_folder_is_refused(tmp_path: Path) -> None:
    result = run("demo", "-o", tmp_path / "none" / "out")
    assert result.exit_code == 1
    assert "does not exist; create it first" in result.stderr
