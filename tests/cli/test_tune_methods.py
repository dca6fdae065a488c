"""`risorius tune` on other methods, intensities and sculpted heads; `risorius rig --style`."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from risorius.controls.presets import default_presets
from risorius.layered.muscle_map import default_muscle_map, read_muscle_map
from risorius.project import read_presets
from risorius.rig.rig import Rig
from risorius.springmuscle.recipe_file import default_recipe, read_recipe
from risorius.tuning.map_genes import apply_map_genes
from risorius.tuning.style import Style, read_style, write_style
from tests.cli.running import answer, run
from tests.tuning.faces import builtin_bench, expression

GENETIC = ("--strategy", "genetic")


def _shape(path: Path, name: str) -> np.ndarray:
    rig = Rig.load(path)
    return rig.target(name).dense(rig.mesh.vertex_count)


@pytest.mark.parametrize("method", ["layered", "springs"])
def test_a_pick_tunes_the_muscles_of_a_method_and_makes_its_style(
    tmp_path: Path, method: str
) -> None:
    out, style = tmp_path / "tuned.json", tmp_path / "mine.style.json"
    options = ("--method", method, "--expression", "disgust", "--picks", "3;a", *GENETIC)
    done = run("tune", "builtin", "-o", out, *options, "--style-output", style, "--json")
    told = answer(done)
    assert told["method"] == method == read_style(style).method
    assert told["style"] == pytest.approx(read_style(style).parameters, abs=1e-6)
    tuned = {name.partition(".")[0] for name in told["style"]}
    assert {"levator_alae_nasi", "corrugator"} <= tuned
    if method == "layered":
        old, new = default_muscle_map().by_name, read_muscle_map(out).by_name
        changed = {name for name in old if old[name].action != new[name].action}
    else:
        old, new = ({m.name: m for m in r.muscles} for r in (default_recipe(), read_recipe(out)))
        changed = {name for name in old if old[name].settings != new[name].settings}
    assert changed == tuned


def test_rig_wears_a_style(tmp_path: Path) -> None:
    style, rig = tmp_path / "mine.style.json", tmp_path / "rig.npz"
    parameters = {"corrugator.shortening": 0.7, "levator_alae_nasi.origin_y": 0.03}
    write_style(Style({**parameters, "disgust.procerus": -0.2}, "layered"), style)
    made = run("rig", "builtin", "--shapes", "emotions", "--style", style, "-o", rig, "-q")
    assert made.exit_code == 0, made.stderr
    bench = builtin_bench()
    face = bench.redrawn(apply_map_genes(default_muscle_map(), parameters)).face
    pose = expression(face, "disgust")
    pose["procerus"] -= 0.2
    shape = _shape(rig, "disgust")
    assert np.abs(shape - face.displace(pose)).max() < 1e-3
    untuned = bench.face.displace(expression(bench.face, "disgust"))
    assert np.abs(shape - untuned).max() > 0.3


def test_intensities_alone_make_presets(tmp_path: Path) -> None:
    out = tmp_path / "mine.presets.json"
    options = ("--genes", "intensities", "--expression", "anger,joy", "--picks", "4;a 2;3;a")
    told = answer(run("tune", "builtin", "-o", out, *options, *GENETIC, "--json"))
    assert all(name.partition(".")[0] in ("anger", "joy") for name in told["style"])
    book, before = read_presets(out), default_presets()
    assert book.emotions["anger"] != before.emotions["anger"] and book.arkit == before.arkit
    assert book.emotions["fear"] == before.emotions["fear"]
    for name, value in book.emotions["anger"].items():
        gene = f"anger.{name.removesuffix('_l').removesuffix('_r')}"
        change = told["style"].get(gene, 0.0)
        assert value == pytest.approx(before.emotions["anger"][name] + change, abs=1e-4)


@pytest.mark.parametrize("method", ["layered", "vector"])
def test_an_expression_of_ones_own_is_tuned(tmp_path: Path, method: str) -> None:
    presets, out = tmp_path / "own.json", tmp_path / "tuned.json"
    assert run("blend", "joy=0.5,anger=0.2", "--preset", "wry", "-o", presets).exit_code == 0
    options = ("--presets", presets, "--expression", "wry", "--picks", "2;a", *GENETIC)
    told = answer(run("tune", "builtin", "-m", method, "-o", out, *options, "--json"))
    tuned = {name.partition(".")[0] for name in told["style"]}
    assert {"corrugator", "zygomaticus_major"} <= tuned


def test_presets_that_lack_the_expression_are_refused(tmp_path: Path) -> None:
    presets = tmp_path / "few.json"
    content = {"schema": "risorius/presets", "version": 1, "emotions": {"calm": {"risorius": 0.1}}}
    presets.write_text(json.dumps(content))
    result = run("tune", "builtin", "--presets", presets, "-o", tmp_path / "x.json")
    assert result.exit_code == 1
    assert "expression: 'joy' is not one of calm" in result.stderr


def test_sides_of_intensities_may_differ(tmp_path: Path) -> None:
    out = tmp_path / "mine.presets.json"
    options = ("--genes", "intensities", "--no-mirror", "--picks", "5;a", "-m", "layered")
    told = answer(run("tune", "builtin", "-o", out, *options, *GENETIC, "--json"))
    joy = read_presets(out).emotions["joy"]
    assert "joy.risorius_r" in told["style"]
    assert joy["risorius_l"] != joy["risorius_r"]


def test_muscles_and_intensities_go_into_files_of_their_own(tmp_path: Path) -> None:
    out, presets, style = (tmp_path / f"{name}.json" for name in ("set", "presets", "style"))
    options = ("--genes", "published,intensities", "--expression", "anger", "--picks", "3;a")
    wanted = ("--presets-output", presets, "--style-output", style)
    assert run("tune", "builtin", "-o", out, *options, *GENETIC, *wanted, "-q").exit_code == 0
    rigs = {}
    for name, extra in {
        "files": ("--vectors", out, "--presets", presets),
        "style": ("--style", style),
    }.items():
        rig = tmp_path / f"{name}.npz"
        made = run("rig", "builtin", "-m", "vector", "--shapes", "emotions", *extra, "-o", rig)
        assert made.exit_code == 0, made.stderr
        rigs[name] = _shape(rig, "anger")
    # The set of the export went through the warp of each group, the style through the landmarks.
    assert np.abs(rigs["files"] - rigs["style"]).max() < 0.05 * np.abs(rigs["files"]).max()


@pytest.mark.parametrize("method", ["layered", "vector"])
def test_shapes_that_a_rig_has_are_fitted_and_the_distances_told(
    tmp_path: Path, method: str
) -> None:
    # Sculpted: weaker and shifted expressions of the same method.
    change = {"levator_labii.origin_y": 0.03, "disgust.levator_labii": -0.2, "anger.procerus": -0.3}
    wish, rig = tmp_path / "wish.style.json", tmp_path / "sculpted.npz"
    write_style(Style(change, method), wish)
    options = ("-m", method, "--shapes", "emotions", "--style", wish, "-q")
    assert run("rig", "builtin", *options, "-o", rig).exit_code == 0
    told = answer(
        run(
            "tune", "builtin", "-o", tmp_path / "fit.json", "-m", method, "--target", rig,
            "--expression", "disgust,anger", "--genes", "intensities", "--json",
        )
    )  # fmt: skip
    assert told["strategy"] == "least-squares"
    for distance in (told["distances"][name] for name in ("anger", "disgust")):
        assert distance["after"] < 0.8 * distance["before"] < distance["neutral"]
        assert 0.5 < distance["motion"] <= 1.0
    assert told["style"]["anger.procerus"] == pytest.approx(-0.3, abs=0.1)


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        (["--genes", "some"], "'some' is not one of all, intensities, published"),
        (["--genes", ""], "give published or all"),
        (["--genes", "published,all"], "give published or all"),
        (["--genes", "all,intensities"], "name a file for them with --presets-output"),
        (["--presets-output", "p.json"], "add intensities to --genes"),
        (["--strategy", "least-squares"], "needs a shape to fit; give --target"),
        (["-m", "layered", "--no-mirror"], "are drawn once for both sides"),
        (["-m", "springs", "--from", "a.obj"], "only vector muscles are carried"),
        (["-m", "layered", "--target-point", "nose_tip=0,0,0"], "only vector muscles are carried"),
        (["--target", "gone.obj"], "gone.obj: no such file"),
        (["--target", "a.glb", "--target-shape", "b", "--expression", "joy,fear"], "give one, or"),
    ],
)
def test_wishes_that_contradict_each_other_are_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, options: list[str], sentence: str
) -> None:
    monkeypatch.chdir(tmp_path)
    result = run("tune", "builtin", "-o", "x.json", *options)
    assert result.exit_code == 1
    assert sentence in " ".join(result.stderr.split())
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("verb", ["rig", "tune", "transfer"])
def test_a_style_of_another_method_is_refused(tmp_path: Path, verb: str) -> None:
    style = tmp_path / "mine.style.json"
    parameters = {"risorius.reach": 1.2}
    content = {"schema": "risorius/style", "version": 1, "method": "layered"}
    style.write_text(json.dumps({**content, "parameters": parameters}))
    out = tmp_path / ("x.npz" if verb == "rig" else "x.json")
    method = () if verb == "transfer" else ("-m", "vector")
    result = run(verb, "builtin", *method, "--style", style, "-o", out)
    assert result.exit_code == 1
    told = " ".join(result.stderr.split())
    assert "tuned on layered muscles, not on vector muscles; use it with --method layered" in told
    assert not out.exists()


def test_parameters_of_a_style_that_nothing_has_are_told(tmp_path: Path) -> None:
    style = tmp_path / "mine.style.json"
    content = {"schema": "risorius/style", "version": 1, "method": "vector"}
    style.write_text(json.dumps({**content, "parameters": {"vomer.reach": 1.2}}))
    result = run("rig", "builtin", "-m", "vector", "--style", style, "--shapes", "emotions",
                 "-o", tmp_path / "x.npz")  # fmt: skip
    assert result.exit_code == 0
    assert "no muscle or preset has the parameter vomer.reach" in result.stderr


def test_a_project_is_tuned_by_its_own_method(tmp_path: Path) -> None:
    project = tmp_path / "head.json"
    assert run("project", "new", "builtin", "-o", project, "--method", "springs").exit_code == 0
    out = tmp_path / "out.json"
    options = ("--genes", "intensities", "--picks", "2;a", *GENETIC, "--json")
    assert answer(run("tune", project, "-o", out, *options))["method"] == "springs"
