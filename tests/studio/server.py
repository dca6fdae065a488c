"""A studio in a process of its own, and a browser that looks at it."""

from __future__ import annotations

import os
import signal
import socket
import subprocess
import sys
import time
import urllib.error
import urllib.request
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from tests.tools import require_module, require_tool

_FLAGS = [
    "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--no-sandbox",
    "--ignore-gpu-blocklist", "--disable-background-networking", "--disable-component-update",
    "--disable-sync", "--no-first-run",
]  # fmt: skip
# Keys of the server's own environment that would change how it starts.
_FOREIGN = ("PYTEST_CURRENT_TEST", "NICEGUI_USER_SIMULATION")


def free_port() -> int:
    with socket.socket() as trial:
        trial.bind(("127.0.0.1", 0))
        return trial.getsockname()[1]


@contextmanager
def studio(project: Path, *, quiet: bool = True) -> Iterator[tuple[int, subprocess.Popen[str]]]:
    """Serve a project; give the port and the process, which may be killed.

    Its log must hold no failure if it is to be `quiet`.
    """
    port = free_port()
    command = [sys.executable, "-m", "risorius", "studio", str(project)]
    command += ["--port", str(port), "--no-browser", "--debug"]
    environment = {key: value for key, value in os.environ.items() if key not in _FOREIGN}
    log = project.with_suffix(".log")
    with log.open("w") as output:
        process = subprocess.Popen(
            command, env=environment, stdout=output, stderr=subprocess.STDOUT, text=True
        )
        try:
            _wait(port, process, log)
            yield port, process
        finally:
            if process.poll() is None:
                process.send_signal(signal.SIGINT)
                try:
                    process.wait(15)
                except subprocess.TimeoutExpired:
                    process.kill()
                    process.wait()
    words = log.read_text()
    assert not quiet or "Traceback" not in words, words


def _wait(port: int, process: subprocess.Popen[str], log: Path) -> None:
    end = time.monotonic() + 90
    while time.monotonic() < end:
        try:
            with urllib.request.urlopen(f"http://127.0.0.1:{port}/", timeout=20) as answer:
                answer.read()
                return
        except (urllib.error.URLError, ConnectionError, TimeoutError):
            assert process.poll() is None, log.read_text()
            time.sleep(0.2)
    raise AssertionError(f"the studio did not start: {log.read_text()}")


@contextmanager
def pages(size: tuple[int, int]) -> Iterator[Any]:
    """Give a function that opens pages of a window of `size` in headless Chromium."""
    program = require_tool("chromium")
    require_module("playwright.sync_api")
    from playwright.sync_api import sync_playwright

    with sync_playwright() as play:
        browser = play.chromium.launch(executable_path=str(program), args=_FLAGS)
        try:
            yield lambda: browser.new_page(viewport={"width": size[0], "height": size[1]})
        finally:
            browser.close()
