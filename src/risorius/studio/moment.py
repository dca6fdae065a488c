"""What stands in for the pose of the sliders while something else is shown."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from risorius._check import FloatArray
from risorius.studio.scene import Stage

__all__ = ["Moment", "Played", "Turn"]

Turn = tuple[float, float, float, float, float, float, float]
"""A turn of the whole head: its pivot [mm] and a unit quaternion (x, y, z, w), canonical frame."""


@dataclass(frozen=True, eq=False)
class Moment:
    """The meshes of a stage at one moment.

    Parameters
    ----------
    meshes : mapping of str to (k, 3) float64
        Vertices by mesh [mm].
    turn : tuple of float, optional
        How the whole head is turned; see `Turn`.
    """

    meshes: Mapping[str, FloatArray]
    turn: Turn | None = None


Played = Callable[[Stage, set[str]], Moment]
"""Gives the moment for the groups that some page shows; runs in the worker thread."""
