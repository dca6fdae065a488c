"""The rig: a neutral head and its morph targets, and the interface of whatever makes them."""

from risorius.rig.bake import bake
from risorius.rig.face import Face
from risorius.rig.rig import MorphTarget, Rig

__all__ = ["Face", "MorphTarget", "Rig", "bake"]
