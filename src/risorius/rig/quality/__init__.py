"""The quality report of a rig: what every shape does, and what is wrong with it."""

from risorius.rig.quality.bar import shortcomings
from risorius.rig.quality.inspection import inspect_rig
from risorius.rig.quality.report import QualityReport, ShapeQuality
from risorius.rig.quality.still import still_zone

__all__ = ["QualityReport", "ShapeQuality", "inspect_rig", "shortcomings", "still_zone"]
