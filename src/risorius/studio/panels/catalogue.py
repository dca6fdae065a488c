"""All panels in the order of their tabs."""

from __future__ import annotations

from risorius.studio.panel import Panel
from risorius.studio.panels.export import ExportPanel
from risorius.studio.panels.face import FacePanel
from risorius.studio.panels.landmarks import LandmarkPanel
from risorius.studio.panels.muscles import MusclePanel
from risorius.studio.panels.play import PlayPanel
from risorius.studio.panels.project import ProjectPanel
from risorius.studio.panels.tune import TunePanel

__all__ = ["PANELS"]

PANELS: tuple[type[Panel], ...] = (
    FacePanel,
    MusclePanel,
    LandmarkPanel,
    TunePanel,
    PlayPanel,
    ExportPanel,
    ProjectPanel,
)
"""Panels from top to bottom."""
