"""Show a GLB in three.js inside a headless browser."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any

from tests.tools import NODE_FOLDER, require_module, require_node_package, require_tool

FLAGS = ["--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--no-sandbox"]


class _Handler(SimpleHTTPRequestHandler):
    """Serve the page with its packages, and the model from wherever it lies."""

    def __init__(self, *args: Any, model: Path, **kwargs: Any) -> None:
        self._model = model
        super().__init__(*args, directory=str(NODE_FOLDER), **kwargs)

    def translate_path(self, path: str) -> str:
        return str(self._model) if path == "/model.glb" else super().translate_path(path)

    def log_message(self, format: str, *args: Any) -> None:
        """Stay silent."""


@contextmanager
def served(model: Path) -> Iterator[str]:
    """Serve the page and `model` on this machine only; yield the address of the page."""
    with ThreadingHTTPServer(("127.0.0.1", 0), partial(_Handler, model=model)) as server:
        thread = threading.Thread(target=server.serve_forever)
        thread.start()
        try:
            yield f"http://127.0.0.1:{server.server_address[1]}/three.html"
        finally:
            server.shutdown()
            thread.join()


@contextmanager
def three_page(model: Path) -> Iterator[Any]:
    """Yield a browser page that has loaded `model`; skip without browser or packages."""
    require_node_package("three")
    chromium = require_tool("chromium")
    require_module("playwright")
    from playwright.sync_api import sync_playwright

    with served(model) as address, sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=str(chromium), args=FLAGS)
        try:
            page = browser.new_page(viewport={"width": 400, "height": 400})
            errors: list[str] = []
            page.on("pageerror", lambda error: errors.append(str(error)))
            page.goto(address)
            page.wait_for_function("window.report", timeout=60_000)
            yield page
            assert errors == []
        finally:
            browser.close()
