"""Documents and examples say what is true."""

from __future__ import annotations

import importlib.util
import json
import re
from importlib.resources import files
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

from risorius import Rig
from risorius.io.bounded import parse_json
from risorius.project import read_project
from risorius.render import read_png
from risorius.rig.quality import inspect_rig
from risorius.tuning.style import read_style
from tests.cli.running import REPOSITORY, run
from tests.cli.test_main import VERBS

CLI = (REPOSITORY / "docs" / "cli.md").read_text("utf-8")
FORMATS = (REPOSITORY / "docs" / "file-formats.md").read_text("utf-8")
EXAMPLES = sorted((REPOSITORY / "examples").glob("*.py"))


@pytest.mark.parametrize("verb", VERBS, ids=" ".join)
def test_every_option_is_described(verb: list[str]) -> None:
    options = set(re.findall(r"(?<!\w)--[a-z-]+", run(*verb, "--help").stdout))
    assert "--json" in options
    assert {option for option in options if f"`{option}" not in CLI} == set()


def test_every_documented_option_exists() -> None:
    known = {"--version", "--install-completion", "--show-completion"}
    for verb in VERBS:
        known |= set(re.findall(r"(?<!\w)--[a-z-]+", run(*verb, "--help").stdout))
    assert set(re.findall(r"(?<![\w-])--[a-z]+(?:-[a-z]+)*", CLI)) - known == set()


def test_every_column_of_inspect_is_described(rig_file: Path) -> None:
    one = Rig.load(rig_file).subset(["jawOpen"])
    (row,) = inspect_rig(one).rows()
    section = CLI.partition("## risorius inspect")[2].partition("\n## ")[0]
    described = {
        name.strip()
        for cells in re.findall(r"^\| ([a-z_, ]+) \|", section, re.MULTILINE)
        for name in cells.split(",")
    }
    assert set(row) - {"shape"} <= described


def _blocks(text: str) -> list[str]:
    return re.findall(r"^```json\n(.*?)^```", text, re.MULTILINE | re.DOTALL)


def test_every_json_block_is_json_and_names_its_schema() -> None:
    blocks = _blocks(FORMATS)
    schemas = [parse_json(block.encode(), "docs")["schema"] for block in blocks]
    assert schemas == [
        "risorius/landmarks",
        "risorius/presets",
        "risorius/vector-set",
        "risorius/project",
    ]


def test_the_project_on_the_page_is_one(tmp_path: Path) -> None:
    block = next(block for block in _blocks(FORMATS) if "risorius/project" in block)
    (tmp_path / "p.json").write_text(block)
    read = read_project(tmp_path / "p.json")
    assert read.head == tmp_path / "head.obj"
    assert dict(read.parts) == {"tongue": "Object_7"}


def test_every_entry_of_the_recipes_that_ship_is_described() -> None:
    recipe = files("risorius.vectormuscle").joinpath("data/vector_set.json").read_text("utf-8")
    book = files("risorius.controls").joinpath("data/presets.json").read_text("utf-8")
    entries = {key for muscle in json.loads(recipe)["muscles"] for key in muscle}
    entries |= {muscle["kind"] for muscle in json.loads(recipe)["muscles"]}
    entries |= set(json.loads(book)) - {"about"}
    missing = {entry for entry in entries if not re.search(rf"[`\"]{entry}[`\"]", FORMATS)}
    assert missing == set()


def _load(path: Path) -> ModuleType:
    spec = importlib.util.spec_from_file_location(path.stem, path)
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_every_example_is_run_below() -> None:
    assert [path.stem for path in EXAMPLES] == [
        "carry_a_style", "own_expression", "rig_a_head", "turntable",
    ]  # fmt: skip


def test_the_example_that_carries_a_style_ends_with_a_wider_smile(tmp_path: Path) -> None:
    style = _load(REPOSITORY / "examples" / "carry_a_style.py").main([str(tmp_path)])
    assert read_style(tmp_path / "wide.style.json") == style
    pictures = [read_png(tmp_path / f"smile_{when}.png") for when in ("before", "after")]
    assert np.abs(pictures[0].astype(float) - pictures[1]).mean() > 0.5
    assert style.parameters["zygomaticus_major.shortening"] > 1.0


def test_the_example_that_rigs_a_head_ends_with_a_rig(tmp_path: Path, monkeypatch) -> None:
    monkeypatch.chdir(tmp_path)
    rig = _load(REPOSITORY / "examples" / "rig_a_head.py").main([])
    assert Rig.load("face.glb").names == rig.names
    assert "jawOpen" in rig.names


def test_the_example_with_an_own_expression_ends_with_a_wry_face(tmp_path: Path) -> None:
    rig = _load(REPOSITORY / "examples" / "own_expression.py").main([str(tmp_path)])
    wry = rig.target("wry").dense(rig.mesh.vertex_count)
    left, right = (
        wry[[rig.landmarks[name].vertex]][0] for name in ("2.4", "2.5")
    )  # the mouth corners
    assert np.linalg.norm(left) > 2.0 * np.linalg.norm(right)
    assert read_png(tmp_path / "wry.png").std() > 20.0


def test_the_example_of_a_turntable_ends_with_different_frames(tmp_path: Path) -> None:
    frames = _load(REPOSITORY / "examples" / "turntable.py").main([str(tmp_path), "3"])
    pictures = [read_png(frame).astype(float) for frame in frames]
    assert len(pictures) == 3
    assert np.abs(pictures[0] - pictures[1]).mean() > 5.0
