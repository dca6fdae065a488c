"""The craft of each method."""

from __future__ import annotations

from risorius.studio.drawing.craft import Craft
from risorius.studio.drawing.layered import LayeredCraft
from risorius.studio.drawing.springs import SpringCraft
from risorius.studio.drawing.vector import VectorCraft

__all__ = ["CRAFTS"]

CRAFTS: dict[str, type[Craft]] = {
    "layered": LayeredCraft,
    "vector": VectorCraft,
    "springs": SpringCraft,
}
"""By the method of the project."""
