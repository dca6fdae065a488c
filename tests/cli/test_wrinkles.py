"""`risorius wrinkles`."""

from __future__ import annotations

import json
from pathlib import Path

from risorius.render.png import read_png
from tests.cli.running import answer, run


def test_maps_and_what_drives_them_are_written(rig_file: Path, tmp_path: Path) -> None:
    folder, sheet = tmp_path / "maps", tmp_path / "sheet.png"
    options = ["-o", folder, "--map", "brow=browInnerUp", "--size", "256", "--sheet", sheet]
    told = answer(run("wrinkles", rig_file, *options, "--json"))
    assert told["ok"]
    content = json.loads((folder / "wrinkles.json").read_text())
    assert content["schema"] == "risorius/wrinkles"
    (entry,) = content["maps"]
    assert entry["left"] == entry["right"] == ["browInnerUp"]
    assert read_png(folder / entry["file"]).shape == (256, 256, 3)
    assert read_png(folder / content["side"]).shape == (256, 256, 3)
    assert read_png(sheet).size


def test_what_makes_no_sense_is_refused(rig_file: Path, tmp_path: Path) -> None:
    for options, told in (
        (["--map", "brow"], "not of the form name=A+B"),
        (["--map", "a=beauty"], "no target 'beauty'"),
        (["--map", "still=eyeLookInLeft"], "no shape wrinkles its skin"),
    ):
        result = run("wrinkles", rig_file, "-o", tmp_path / "maps", *options)
        assert result.exit_code == 1
        assert told in result.stderr
        assert "Traceback" not in result.stderr
    missing = run("wrinkles", tmp_path / "no.glb", "-o", tmp_path / "maps")
    assert missing.exit_code == 1
    assert "no.glb" in missing.stderr
