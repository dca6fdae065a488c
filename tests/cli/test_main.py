"""The program as a whole: help, version, speed of the first answer, errors."""

from __future__ import annotations

import subprocess
import sys

import pytest

import risorius
from risorius.cli import sources
from risorius.landmarks import feature_points
from tests.cli.running import answer, run

VERBS = [
    ["demo"],
    ["check"],
    ["rig"],
    ["inspect"],
    ["clone"],
    ["compare"],
    ["render"],
    ["transfer"],
    ["tune"],
    ["play"],
    ["convert"],
    ["blend"],
    ["compress"],
    ["wrinkles"],
    ["studio"],
    ["landmarks"],
    ["bench"],
    ["project", "new"],
    ["project", "set"],
    ["project", "show"],
    ["project", "upgrade"],
]


@pytest.mark.parametrize("verb", VERBS, ids=" ".join)
def test_the_help_of_every_verb_has_an_example_and_the_common_options(verb: list[str]) -> None:
    result = run(*verb, "--help")
    assert result.exit_code == 0
    assert f"risorius {' '.join(verb)}" in " ".join(result.stdout.split())
    for word in ("Example:", "--json", "--quiet", "--debug"):
        assert word in result.stdout


def test_the_version_is_printed() -> None:
    assert run("--version").stdout == f"risorius {risorius.__version__}\n"


def test_no_arguments_show_the_help() -> None:
    result = run()
    assert "risorius demo" in result.stdout + result.stderr
    assert result.exit_code in (0, 2)


def test_an_unknown_verb_or_option_ends_with_2() -> None:
    assert run("dance").exit_code == 2
    assert run("rig", "builtin").exit_code == 2
    assert run("rig", "--no-such-option").exit_code == 2


def test_the_first_answer_loads_nothing_heavy() -> None:
    code = (
        "import sys; sys.argv = ['risorius', '--help']\n"
        "from risorius.cli.entry import run\n"
        "try: run()\n"
        "except SystemExit: pass\n"
        "print(*sys.modules)"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True, timeout=60
    )
    loaded = set(done.stdout.rpartition("\n")[0].rpartition("\n")[2].split())
    loaded |= set(done.stdout.split())
    assert "risorius.cli.main" in loaded
    assert not loaded & {"numpy", "scipy", "numba", "trimesh", "PIL", "risorius.io"}


def test_debug_shows_where_an_error_comes_from() -> None:
    assert "Traceback" not in run("inspect", "none.glb").stderr
    assert "Traceback" in run("inspect", "none.glb", "--debug").stderr


def test_an_error_of_ours_that_is_a_mistake_in_the_code_is_not_hidden(monkeypatch) -> None:
    def broken(*_: object) -> None:
        raise ZeroDivisionError

    monkeypatch.setattr(sources, "read_mesh", broken)
    with pytest.raises(ZeroDivisionError):
        run("rig", "builtin", "-o", "f.glb")


def test_an_error_is_in_the_json_too() -> None:
    result = run("inspect", "none.glb", "--json")
    told = answer(result)
    assert told == {"ok": False, "notes": [], "seconds": told["seconds"], "error": told["error"]}
    assert told["error"] == "none.glb: no such file; check its name and its folder"
    assert result.exit_code == 1


def test_landmarks_lists_the_whole_table() -> None:
    told = answer(run("landmarks", "--json"))
    assert [point["name"] for point in told["landmarks"]] == list(feature_points())
    text = run("landmarks").stdout
    assert "tip of the nose" in text
    needed = run("landmarks", "--needed").stdout
    assert len(needed.splitlines()) < len(text.splitlines()) / 3
