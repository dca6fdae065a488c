"""Run verbs inside the test process."""

from __future__ import annotations

import json
from importlib.resources import as_file, files
from pathlib import Path
from typing import Any

from click.testing import Result
from typer.testing import CliRunner

from risorius.cli.main import app

# Plain text of one width wherever the tests run.
_TERMINAL = {"COLUMNS": "100", "NO_COLOR": "1", "_TYPER_FORCE_DISABLE_TERMINAL": "1"}
REPOSITORY = Path(__file__).resolve().parents[2]


def run(*arguments: object) -> Result:
    """Run `risorius` with these arguments."""
    result = CliRunner(env=_TERMINAL).invoke(app, [str(argument) for argument in arguments])
    unexpected = result.exception
    if unexpected is not None and not isinstance(unexpected, SystemExit):
        raise unexpected
    return result


def answer(result: Result) -> dict[str, Any]:
    """Return the JSON object that is all of standard output."""
    return json.loads(result.stdout)


def asset(name: str) -> Path:
    """Return a file of the built-in head."""
    with as_file(files("risorius.anatomy").joinpath("assets").joinpath(name)) as path:
        return path
