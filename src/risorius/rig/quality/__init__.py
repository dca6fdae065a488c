"""The quality report of a rig: what every shape does, and what is wrong with it."""

from risorius.rig.quality.bar import shortcomings
from risorius.rig.quality.inspection import inspect_rig
from risorius.rig.quality.report import QualityReport, ShapeQuality
from risorius.rig.quality.still import still_zone
from risorius.rig.quality.sums import played_sums, with_sums

__all__ = [
    "QualityReport",
    "ShapeQuality",
    "inspect_rig",
    "played_sums",
    "shortcomings",
    "still_zone",
    "with_sums",
]
