"""The project's own promises: metadata, documents, what importing costs."""

from __future__ import annotations

import re
import subprocess
import sys
import tomllib
from importlib import import_module

import pytest

import risorius
from tests.conventions import REPOSITORY, SOURCE

PROJECT = tomllib.loads((REPOSITORY / "pyproject.toml").read_text("utf-8"))
DOCUMENTS = [*sorted(REPOSITORY.glob("*.md")), *sorted((REPOSITORY / "docs").rglob("*.md"))]
TEST_COMMAND = (
    "python3 -m venv .venv && .venv/bin/pip install -e '.[dev]' && .venv/bin/python -m pytest"
)


def _read(name: str) -> str:
    return (REPOSITORY / name).read_text("utf-8")


def test_importing_the_package_loads_nothing_heavy() -> None:
    done = subprocess.run(
        [sys.executable, "-c", "import risorius, sys; print(*sys.modules)"],
        capture_output=True,
        text=True,
        check=True,
        timeout=60,
    )
    loaded = {name.partition(".")[0] for name in done.stdout.split()}
    assert "risorius" in loaded
    assert not loaded & {"numpy", "scipy", "numba", "trimesh", "igl", "rich", "typer", "PIL"}


def test_every_public_name_is_found_on_demand() -> None:
    for name in risorius.__all__:
        assert getattr(risorius, name) is not None
        assert name in dir(risorius)


def test_an_unknown_public_name_is_refused() -> None:
    with pytest.raises(AttributeError, match="no attribute 'Hedd'"):
        _ = risorius.Hedd  # pyright: ignore


def test_formats_are_registered_at_the_first_question() -> None:
    code = (
        "import sys, risorius; from risorius._formats import formats;"
        "assert 'risorius.io' not in sys.modules; print(*(f.name for f in formats()))"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True, timeout=60
    )
    assert "obj" in done.stdout.lower().split()


def test_the_changelog_speaks_of_this_version_first() -> None:
    versions = re.findall(r"^## (\d+\.\d+\.\d+)", _read("CHANGELOG.md"), re.MULTILINE)
    assert versions[0] == risorius.__version__


def test_types_are_shipped() -> None:
    assert (SOURCE / "py.typed").is_file()


def test_every_script_points_to_a_function() -> None:
    for entry in PROJECT["project"]["scripts"].values():
        module, _, function = entry.partition(":")
        assert callable(getattr(import_module(module), function))


def test_every_extra_that_the_code_names_exists() -> None:
    named = {
        extra
        for path in SOURCE.rglob("*.py")
        for extra in re.findall(r"risorius\[(\w+)\]", path.read_text("utf-8"))
    }
    assert named <= set(PROJECT["project"]["optional-dependencies"])


def test_continuous_integration_runs_the_test_command_of_the_readme() -> None:
    assert TEST_COMMAND in _read("README.md")
    script = _read(".ci/run")
    for piece in TEST_COMMAND.split(" && "):
        assert piece in script


@pytest.mark.parametrize("path", DOCUMENTS, ids=lambda path: path.name)
def test_every_link_in_the_documents_leads_somewhere(path) -> None:
    text = path.read_text("utf-8")
    broken = [
        target
        for target in re.findall(r"\]\(([^)#\s]+)", text)
        if "://" not in target and not (path.parent / target).exists()
    ]
    assert broken == []


def test_every_file_that_contributing_names_exists() -> None:
    text = _read("CONTRIBUTING.md")
    named = set(re.findall(r"`((?:src|tests|tools|docs|benchmarks|examples|\.ci)/[\w./-]+)`", text))
    assert len(named) > 10
    assert {name for name in named if not (REPOSITORY / name).exists()} == set()


def test_the_map_in_contributing_names_every_folder() -> None:
    text = _read("CONTRIBUTING.md")
    folders = {path.parent.name for path in SOURCE.glob("*/__init__.py")}
    assert {name for name in folders if f"`{name}/`" not in text} == set()
