"""What a person does in the studio, by mouse and key."""

from __future__ import annotations

import os
import time
from pathlib import Path
from typing import Any

import numpy as np

_READY = "window.risoriusViewport && risoriusViewport.stats.serial > 0"


class Visitor:
    """A person at one page; `complaints` are errors of the browser."""

    def __init__(self, page: Any, port: int) -> None:
        self.page = page
        self.complaints: list[str] = []
        self.foreign: list[str] = []
        page.on("pageerror", lambda error: self.complaints.append(str(error)))
        page.on("request", self._look_at)
        self._own = f"127.0.0.1:{port}"
        page.goto(f"http://{self._own}/")
        page.wait_for_function(_READY, timeout=60_000)

    def _look_at(self, request: Any) -> None:
        if self._own not in request.url and not request.url.startswith(("data:", "blob:")):
            self.foreign.append(request.url)

    def picture(self, name: str) -> None:
        """Keep a picture for people to look at, where RISORIUS_SCREENSHOTS names a folder."""
        folder = os.environ.get("RISORIUS_SCREENSHOTS")
        if folder:
            width = self.page.viewport_size["width"]
            self.page.screenshot(path=str(Path(folder) / f"{name}_{width}.png"))

    def panel(self, name: str) -> None:
        self.page.get_by_role("tab", name=name).click()

    def mark(self, name: str) -> Any:
        return self.page.locator(f'[data-mark="{name}"]')

    def click(self, name: str) -> None:
        self.mark(name).click()

    def spot(self, place: np.ndarray) -> tuple[float, float]:
        found = self.page.evaluate(
            "p => risoriusViewport.locate(p[0], p[1], p[2])", [float(value) for value in place]
        )
        return found["x"], found["y"]

    def click_at(self, place: np.ndarray) -> None:
        x, y = self.spot(place)
        self.page.mouse.move(x, y)
        self.page.mouse.click(x, y)

    def slide(self, name: str, share: float) -> None:
        """Drag the knob of a slider to a share of its track."""
        slider = self.mark(name)
        slider.scroll_into_view_if_needed()
        box = slider.bounding_box()
        x, y = box["x"], box["y"] + box["height"] / 2
        low, high, now = slider.evaluate(
            "e => { const k = e.matches('[role=slider]') ? e : e.querySelector('[role=slider]');"
            "return ['min', 'max', 'now'].map(p => Number(k.getAttribute('aria-value' + p))) }"
        )
        start = (now - low) / (high - low)
        self.page.mouse.move(x + start * box["width"], y)
        self.page.mouse.down()
        self.page.mouse.move(x + 0.5 * (start + share) * box["width"], y)
        self.page.mouse.move(x + share * box["width"], y)
        self.page.mouse.up()

    def positions(self, mesh: str) -> np.ndarray:
        """The vertices of a mesh as the page shows them."""
        flat = self.page.evaluate("n => risoriusViewport.shown(n)", mesh)
        return np.array(flat).reshape(-1, 3)

    def drop(self, path: Path, mark: str = ".rv-canvas") -> None:
        """Drop a text file on the picture, or on what a selector finds."""
        self.page.evaluate(
            """async ([where, name, text]) => {
              const files = new DataTransfer();
              files.items.add(new File([text], name));
              for (const kind of ["dragenter", "dragover", "drop"]) {
                const event = new DragEvent(
                  kind, { dataTransfer: files, bubbles: true, cancelable: true });
                const field = document.querySelector(`${where} .q-uploader__dnd`);
                (field ?? document.querySelector(where)).dispatchEvent(event);
                if (!event.defaultPrevented && kind == "drop") throw Error("the page would leave");
                await new Promise((done) => setTimeout(done, 60));
              }
            }""",
            [mark, path.name, path.read_text()],
        )

    def has(self, mesh: str) -> bool:
        return self.page.evaluate("n => risoriusViewport.meshes.byName.has(n)", mesh)

    def until(self, condition: Any, what: str, *, seconds: float = 30.0) -> None:
        """Wait until `condition()` holds."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            if condition():
                return
            self.page.wait_for_timeout(60)
        raise AssertionError(f"waited in vain: {what}")

    def settle(self) -> None:
        """Wait until no newer frame comes."""
        last = -1
        for _ in range(200):
            now = self.page.evaluate("risoriusViewport.stats.received")
            if now == last:
                return
            last = now
            self.page.wait_for_timeout(250)
