"""All panels in the order of their tabs."""

from __future__ import annotations

from risorius.studio.panel import Panel
from risorius.studio.panels.face import FacePanel

__all__ = ["PANELS"]

PANELS: tuple[type[Panel], ...] = (FacePanel,)
"""Panels from top to bottom."""
