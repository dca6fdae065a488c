"""The folders import one another only along the data flow."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from tests.conventions import REPOSITORY, SOURCE

_CONTRACT = """\
[importlinter]
root_package = {package}

[importlinter:contract:order]
name = order
type = layers
containers = {package}
exhaustive = True
layers =
    high
    low
"""


def _lint(folder: Path) -> subprocess.CompletedProcess[str]:
    """Run the import check with the settings and the package found in `folder`."""
    command = "from importlinter.cli import lint_imports_command as lint; lint()"
    return subprocess.run(
        [sys.executable, "-c", command, "--no-cache"],
        cwd=folder,
        capture_output=True,
        text=True,
        check=False,
        timeout=120,
    )


def test_every_folder_imports_only_from_those_before_it() -> None:
    done = _lint(REPOSITORY)
    assert done.returncode == 0, done.stdout + done.stderr


def test_every_folder_is_a_package() -> None:
    folders = {path.parent for path in SOURCE.rglob("*.py")}
    assert SOURCE / "mesh" in folders
    # A folder without __init__.py is invisible to the import check.
    bare = [str(folder.relative_to(SOURCE)) for folder in folders if not _is_package(folder)]
    assert bare == []


def _is_package(folder: Path) -> bool:
    return (folder / "__init__.py").is_file()


@pytest.mark.parametrize(
    ("low", "high", "extra", "passes"),
    [
        ("", "from {package} import low\n", None, True),
        ("from {package} import high\n", "", None, False),
        ("def late():\n    import {package}.high\n", "", None, False),
        ("", "", "unlisted", False),
    ],
)
def test_the_import_check_can_fail(
    tmp_path: Path, low: str, high: str, extra: str | None, passes: bool
) -> None:
    package = "layered_fake"
    folder = tmp_path / package
    folder.mkdir()
    (folder / "__init__.py").write_text("")
    (folder / "low.py").write_text(low.format(package=package))
    (folder / "high.py").write_text(high.format(package=package))
    if extra:
        (folder / f"{extra}.py").write_text("")
    (tmp_path / ".importlinter").write_text(_CONTRACT.format(package=package))
    done = _lint(tmp_path)
    assert (done.returncode == 0) == passes, done.stdout + done.stderr
