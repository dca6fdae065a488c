"""All panels in the order of their tabs."""

from __future__ import annotations

from risorius.studio.panel import Panel
from risorius.studio.panels.face import FacePanel
from risorius.studio.panels.landmarks import LandmarkPanel
from risorius.studio.panels.muscles import MusclePanel
from risorius.studio.panels.tune import TunePanel

__all__ = ["PANELS"]

PANELS: tuple[type[Panel], ...] = (FacePanel, MusclePanel, LandmarkPanel, TunePanel)
"""Panels from top to bottom."""
