"""External programs and real heads that some tests need: skip without them, or fail on request."""

from __future__ import annotations

import os
import shutil
from pathlib import Path
from typing import NoReturn

import pytest

REPOSITORY = Path(__file__).resolve().parent.parent
NODE_FOLDER = REPOSITORY / "tests" / "io" / "tools"

# A program may go by several names; the first one found is used.
_PROGRAMS = {
    "node": ("node", "nodejs"),
    "npm": ("npm",),
    "chromium": ("chromium", "chromium-browser", "google-chrome"),
}
_HOW = {
    "node": "install Node.js",
    "npm": "install npm",
    "chromium": "install the system package chromium",
}


def _absent(variable: str, reason: str) -> NoReturn:
    """Fail where `variable` says that nothing may be missing, else skip."""
    if os.environ.get(variable) == "1":
        pytest.fail(f"{reason} ({variable}=1 forbids skipping)", pytrace=False)
    pytest.skip(reason)


def require_tool(name: str) -> Path:
    """Return the path of the program `name`; skip the test without it.

    With ``RISORIUS_REQUIRE_TOOLS=1`` in the environment the test fails instead.
    """
    for program in _PROGRAMS.get(name, (name,)):
        found = shutil.which(program)
        if found:
            return Path(found)
    _absent("RISORIUS_REQUIRE_TOOLS", f"{name} is not installed; {_HOW.get(name, 'install it')}")


def require_node_package(name: str) -> Path:
    """Return the folder of the npm package `name` below tests/io/tools; skip or fail without it."""
    folder = NODE_FOLDER / "node_modules" / name
    if (folder / "package.json").is_file():
        return folder
    _absent(
        "RISORIUS_REQUIRE_TOOLS",
        f"npm package {name} is not installed; run `npm install` in tests/io/tools",
    )


def require_module(name: str) -> None:
    """Skip (or fail, see `require_tool`) unless the optional Python module `name` imports."""
    try:
        __import__(name)
    except ImportError:
        _absent("RISORIUS_REQUIRE_TOOLS", f"Python module {name} is not installed")


def real_data_folder() -> Path:
    """Return the folder of real heads; skip without it.

    It is ``../shared/data`` beside the repository, or ``RISORIUS_REAL_DATA``. With
    ``RISORIUS_REQUIRE_REAL=1`` the test fails instead of skipping.
    """
    given = os.environ.get("RISORIUS_REAL_DATA")
    folder = Path(given) if given else REPOSITORY.parent / "shared" / "data"
    if folder.is_dir():
        return folder
    _absent(
        "RISORIUS_REQUIRE_REAL",
        f"no real heads in {folder}; set RISORIUS_REAL_DATA to their folder",
    )
