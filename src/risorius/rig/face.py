"""The one interface of everything that poses a head."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol, runtime_checkable

from risorius._check import FloatArray
from risorius.controls.control import Control, Pose
from risorius.head.head import Head

__all__ = ["Face", "ManyPoses"]


@runtime_checkable
class Face(Protocol):
    """A method bound to a head."""

    @property
    def head(self) -> Head:
        """The head it moves."""
        ...

    @property
    def controls(self) -> tuple[Control, ...]:
        """What can be moved."""
        ...

    def displace(self, pose: Pose) -> FloatArray:
        """Return the displacement (n, 3) [mm, canonical frame] of every input vertex.

        Depends on the pose only; values out of range are clamped; exactly zero at rest.
        """
        ...

    def pose(self, pose: Pose) -> FloatArray:
        """Return the posed positions (n, 3) [mm, canonical frame] of every input vertex."""
        ...


@runtime_checkable
class ManyPoses(Protocol):
    """A face that solves many poses faster side by side than one after the other."""

    def displace_all(self, poses: Sequence[Pose]) -> list[FloatArray]:
        """Return the displacement (n, 3) [mm, canonical frame] of every pose."""
        ...
