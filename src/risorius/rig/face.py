"""The one interface of everything that poses a head."""

from __future__ import annotations

from typing import Protocol, runtime_checkable

from risorius._check import FloatArray
from risorius.controls.control import Control, Pose
from risorius.head.head import Head

__all__ = ["Face"]


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
