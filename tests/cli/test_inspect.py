"""`risorius inspect`."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.cli.running import answer, run

# Limits that every rig passes.
GENEROUS = ["--bar", "lost=1e6", "--bar", "invented=1e6", "--bar", "cracks=1e6"]


def test_every_shape_is_a_row_and_an_entry(rig_file: Path) -> None:
    result = run("inspect", rig_file, *GENEROUS)
    assert result.exit_code == 0, result.stderr
    rows = [line.split()[0] for line in result.stdout.splitlines() if line]
    assert {"joy", "jawOpen", "eyeBlinkLeft"} <= set(rows)
    told = answer(run("inspect", rig_file, *GENEROUS, "--json"))
    shapes = {shape["name"]: shape for shape in told["report"]["shapes"]}
    assert shapes["jawOpen"]["motion"]["largest"] > 10.0
    assert told["beyond"] == []


def test_a_limit_that_is_passed_ends_with_1(rig_file: Path) -> None:
    result = run("inspect", rig_file, *GENEROUS, "--bar", "largest=10")
    assert result.exit_code == 1
    assert "beyond the bar: jawOpen: largest" in result.stdout
    told = answer(run("inspect", rig_file, *GENEROUS, "--bar", "largest=10", "--json"))
    assert told["ok"] is False
    assert any(text.startswith("jawOpen: largest") for text in told["beyond"])


def test_a_limit_that_is_just_reached_passes(rig_file: Path) -> None:
    told = answer(run("inspect", rig_file, *GENEROUS, "--json"))
    most = max(shape["motion"]["moved"] for shape in told["report"]["shapes"])
    assert run("inspect", rig_file, *GENEROUS, "--bar", f"moved={most}").exit_code == 0
    assert run("inspect", rig_file, *GENEROUS, "--bar", f"moved={most - 1}").exit_code == 1


def test_rows_are_sorted_largest_first(rig_file: Path) -> None:
    result = run("inspect", rig_file, *GENEROUS, "--sort", "largest")
    lines = result.stdout.splitlines()
    start = next(i for i, line in enumerate(lines) if line.startswith("---"))
    column = lines[start - 1].split().index("largest")
    values = []
    for line in lines[start + 1 :]:
        if line.startswith("lengths"):
            break
        values.append(float(line.split()[column]))
    assert len(values) > 40
    assert values == sorted(values, reverse=True)


@pytest.mark.parametrize("options", [["--sort", "beauty"], ["--bar", "beauty=1"]])
def test_a_column_that_does_not_exist_is_refused_with_the_choices(
    rig_file: Path, options: list[str]
) -> None:
    result = run("inspect", rig_file, *options)
    assert result.exit_code == 1
    assert "no column 'beauty'; there are shape, moved, largest" in result.stderr


def test_a_limit_without_number_is_a_wrong_command(rig_file: Path) -> None:
    result = run("inspect", rig_file, "--bar", "lost=few")
    assert result.exit_code == 2


def test_a_missing_rig_is_refused() -> None:
    result = run("inspect", "none.glb")
    assert result.exit_code == 1
    assert result.stderr == "risorius: none.glb: no such file; check its name and its folder\n"


def test_shapes_added_up_are_measured_too(rig_file: Path) -> None:
    told = answer(
        run("inspect", rig_file, *GENEROUS, "--sum", "jawOpen=0.5+eyeBlinkLeft", "--sum", "played",
            "--json")
    )  # fmt: skip
    shapes = {shape["name"]: shape for shape in told["report"]["shapes"]}
    both = shapes["jawOpen=0.5+eyeBlinkLeft"]
    assert both["lids"]["l"]["left"] == pytest.approx(shapes["eyeBlinkLeft"]["lids"]["l"]["left"])
    assert both["motion"]["largest"] == pytest.approx(
        0.5 * shapes["jawOpen"]["motion"]["largest"], rel=0.05
    )
    assert "eyeBlinkLeft+eyeLookUpLeft" in shapes


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("jawOpen", "is one shape"),
        ("jawOpen+", "not of the form"),
        ("jawOpen+jawOpen", "not of the form"),
        ("jawOpen=much+eyeBlinkLeft", "'much' is no number"),
        ("jawOpen=nan+eyeBlinkLeft", "jawOpen"),
        ("jawOpen+beauty", "no target 'beauty'"),
    ],
)
def test_a_sum_that_makes_no_sense_is_refused(rig_file: Path, text: str, told: str) -> None:
    result = run("inspect", rig_file, "--sum", text)
    assert result.exit_code != 0
    assert told in result.stderr
    assert "Traceback" not in result.stderr
