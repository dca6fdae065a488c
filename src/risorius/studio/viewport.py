"""The viewport as an element of the page."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import nicegui
from nicegui.element import Element

__all__ = ["STREAM", "Pad", "Timeline", "Viewport"]

STREAM = "/studio/stream"
"""Where the viewport finds its binary stream."""

_THREE = str(Path(nicegui.__file__).parent / "elements" / "scene" / "dist")


class Viewport(
    Element,
    component="browser/viewport.js",
    esm={"nicegui-scene": _THREE, "risorius-studio": "browser/modules"},
):
    """Meshes, handles and lines in one or more views; see ``browser/modules``.

    Its events are ``select``, ``place``, ``finish``, ``dragging``, ``dropped``, ``handle``,
    ``choose`` and ``seek``.

    Parameters
    ----------
    page : str
        By which its stream is told from those of other pages.
    """

    def __init__(self, page: str) -> None:
        super().__init__()
        self._props["stream"] = f"{STREAM}?page={page}"

    def set(self, **settings: Any) -> None:
        """Change opacity, layout, tool, drawOn, hidden or selected."""
        self.run_method("set", settings)

    def overlay(
        self,
        *,
        handles: Sequence[Mapping[str, Any]] = (),
        lines: Sequence[Mapping[str, Any]] = (),
        segments: Sequence[Mapping[str, Any]] = (),
        dots: Sequence[Mapping[str, Any]] = (),
    ) -> None:
        """Show these instead of what is there.

        Parameters
        ----------
        handles : sequence of mapping
            Points that can be dragged: id, at, normal, colour, label, on.
        lines : sequence of mapping
            Tubes through points: points, colour, width.
        segments : sequence of mapping
            Many thin lines: points, two by two in one row of numbers, and colour.
        dots : sequence of mapping
            Points that are only seen: at, colour.
        """
        content = {"handles": handles, "lines": lines, "segments": segments, "dots": dots}
        self.run_method("overlay", {name: list(value) for name, value in content.items()})

    def look(self, preset: str) -> None:
        """Turn the camera: front, three_quarter, left, right, eyes or mouth."""
        self.run_method("look", preset)

    def choose(self, marks: Sequence[int]) -> None:
        """Mark chosen faces, the best first."""
        self.run_method("choose", list(marks))

    def rest(self) -> None:
        """End playing: show the pose again."""
        self.run_method("rest")

    def picture(self, name: str) -> None:
        """Let the browser save what it shows as a PNG file."""
        self.run_method("picture", name)


class Pad(Element, component="browser/pad.js"):
    """A field with a knob for two numbers at once; its events are ``moved`` and ``kept``."""

    def __init__(self, *, low: tuple[float, float], high: tuple[float, float]) -> None:
        super().__init__()
        self._props["low"] = list(low)
        self._props["high"] = list(high)
        self._props["value"] = [0.0, 0.0]

    def put(self, x: float, y: float) -> None:
        """Move the knob."""
        if self._props["value"] != [x, y]:
            self._props["value"] = [x, y]
            self.update()


class Timeline(Element, component="browser/timeline.js"):
    """Play, scrub, speed and loop, timed by the browser; what moves is the viewport of the page."""

    def load(self, facts: Mapping[str, Any]) -> None:
        """Show a take: its `number`, `duration` [s], `rate` and `curve` (0..1)."""
        self.run_method("load", dict(facts))

    def toggle(self) -> None:
        """Play or pause."""
        self.run_method("toggle")
