"""A rig of the built-in head that many tests look at."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.cli.running import run


@pytest.fixture(scope="session")
def rig_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("rig") / "face.glb"
    result = run("rig", "builtin", "-o", path, "--shapes", "emotions,arkit")
    assert result.exit_code == 0, result.stderr
    return path
