"""Muscle kinds; a new one is a new file here and one line below."""

from risorius.vectormuscle.kinds.linear import LinearMuscle
from risorius.vectormuscle.kinds.roll import RollMuscle
from risorius.vectormuscle.kinds.sheet import SheetMuscle
from risorius.vectormuscle.kinds.sphincter import SphincterMuscle

__all__ = ["LinearMuscle", "RollMuscle", "SheetMuscle", "SphincterMuscle"]
