"""A line plot in plain pixels: median error against generation."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw, ImageFont

_INKS = ((31, 119, 180), (214, 39, 40), (44, 160, 44), (148, 103, 189), (120, 120, 120), (0, 0, 0))
_LEFT, _TOP, _WIDTH, _HEIGHT = 60, 40, 560, 320


def write_plot(path: Path, lines: Mapping[str, np.ndarray], *, title: str) -> None:
    """Draw `lines` (generations,) from 0 to 1.05, with a legend."""
    page = Image.new("RGB", (_LEFT + _WIDTH + 230, _TOP + _HEIGHT + 50), "white")
    pen, font = ImageDraw.Draw(page), ImageFont.load_default(13)
    pen.text((_LEFT, 10), title, "black", font)
    for tick in (0.0, 0.25, 0.5, 0.75, 1.0):
        y = _TOP + _HEIGHT * (1.0 - tick / 1.05)
        pen.line((_LEFT, y, _LEFT + _WIDTH, y), (225, 225, 225))
        pen.text((_LEFT - 8, y), f"{tick:g}", "black", font, anchor="rm")
    for number, (name, values) in enumerate(lines.items()):
        ink = _INKS[number % len(_INKS)]
        steps = len(values) - 1
        points = [
            (_LEFT + _WIDTH * step / steps, _TOP + _HEIGHT * (1.0 - min(value, 1.05) / 1.05))
            for step, value in enumerate(values)
        ]
        pen.line(points, ink, 2)
        pen.text((_LEFT + _WIDTH + 12, _TOP + 20 * number), name, ink, font)
    for step in range(0, len(next(iter(lines.values()))), 2):
        x = _LEFT + _WIDTH * step / (len(next(iter(lines.values()))) - 1)
        pen.text((x, _TOP + _HEIGHT + 8), str(step), "black", font, anchor="ma")
    pen.text((_LEFT + _WIDTH / 2, _TOP + _HEIGHT + 28), "generation", "black", font, anchor="ma")
    page.save(path)
