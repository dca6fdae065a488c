"""Ctrl-C and failing writes leave what was there before."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from risorius.cli import sources
from risorius.render import read_png
from tests.cli.running import answer, run


def _interrupt(*_: object, **__: object) -> None:
    raise KeyboardInterrupt


def test_ctrl_c_ends_with_130_and_keeps_the_old_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    out = tmp_path / "face.glb"
    out.write_bytes(b"old")
    monkeypatch.setattr(sources, "bake", _interrupt)
    result = run("rig", "builtin", "-o", out)
    assert result.exit_code == 130
    assert "interrupted" in result.stderr
    assert "Traceback" not in result.stderr
    assert out.read_bytes() == b"old"
    assert list(tmp_path.iterdir()) == [out]


@pytest.mark.parametrize("name", ["face.glb", "face.npz"])
def test_a_full_disk_keeps_the_old_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    out = tmp_path / name
    out.write_bytes(b"old")

    def full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)
    result = run("rig", "builtin", "-o", out, "--shapes", "emotions", "--json")
    assert result.exit_code == 1
    assert "No space left on device" in result.stderr
    told = answer(result)
    assert told["ok"] is False
    assert "No space left" in told["error"]
    assert out.read_bytes() == b"old"
    assert list(tmp_path.iterdir()) == [out]


@pytest.mark.skipif(sys.platform == "win32", reason="signals of POSIX")
def test_a_signal_in_the_middle_of_the_work_leaves_only_whole_files(tmp_path: Path) -> None:
    out = tmp_path / "demo"
    command = "from risorius.cli.entry import run; run()"
    with subprocess.Popen(
        [sys.executable, "-c", command, "demo", "-o", str(out)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    ) as process:
        while not (out / "demo.glb").exists() and process.poll() is None:
            time.sleep(0.02)
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=120)
    assert process.returncode == 130, errors
    assert "Traceback" not in errors
    assert (out / "demo.glb").is_file()
    assert not (out / "views.png").exists()
    for picture in out.glob("*.png"):
        read_png(picture)
    assert not list(out.glob(".*"))


@pytest.mark.skipif(sys.platform == "win32", reason="signals of POSIX")
@pytest.mark.parametrize("delay", [0.0, 0.1, 0.3, 0.6, 1.0])
def test_a_signal_while_the_libraries_load_is_no_traceback(tmp_path: Path, delay: float) -> None:
    command = "from risorius.cli.entry import run; print(flush=True); run()"
    with subprocess.Popen(
        [sys.executable, "-c", command, "demo", "-o", str(tmp_path / "demo")],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    ) as process:
        assert process.stdout is not None
        process.stdout.readline()
        time.sleep(delay)
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=120)
    assert process.returncode == 130, errors
    assert "Traceback" not in errors
