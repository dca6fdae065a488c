"""Motion cloning: all shapes of one head, on any other."""

from risorius.cloning.clone import Clone, clone, clone_with_report
from risorius.cloning.cloning import Cloning
from risorius.cloning.measures import (
    Comparison,
    ShapeComparison,
    absolute_error,
    compare_rigs,
    direction_cosine,
    motion_error,
    roughness,
)
from risorius.cloning.parameters import CloneParameters, clone_parameters
from risorius.cloning.report import CloneReport, ShapeReport

__all__ = [
    "Clone",
    "CloneParameters",
    "CloneReport",
    "Cloning",
    "Comparison",
    "ShapeComparison",
    "ShapeReport",
    "absolute_error",
    "clone",
    "clone_parameters",
    "clone_with_report",
    "compare_rigs",
    "direction_cosine",
    "motion_error",
    "roughness",
]
