"""Controls, poses, expression presets and the names of standards: types and data, no geometry."""

from risorius.controls.arkit import ArkitShape, arkit_shapes
from risorius.controls.control import Control, ControlGroup, Pose, ResolvedPose, resolve_pose
from risorius.controls.presets import (
    EMOTIONS,
    FittedPose,
    PresetBook,
    default_presets,
    mirrored,
    parse_presets,
)
from risorius.controls.shape_sets import SHAPE_SETS, ShapeList, list_shapes
from risorius.controls.standard import (
    MUSCLES,
    SINGLE_MUSCLES,
    bilateral,
    controls_of_muscles,
    device_controls,
    muscle_controls,
    sided,
)

__all__ = [
    "EMOTIONS",
    "MUSCLES",
    "SHAPE_SETS",
    "SINGLE_MUSCLES",
    "ArkitShape",
    "Control",
    "ControlGroup",
    "FittedPose",
    "Pose",
    "PresetBook",
    "ResolvedPose",
    "ShapeList",
    "arkit_shapes",
    "bilateral",
    "controls_of_muscles",
    "default_presets",
    "device_controls",
    "list_shapes",
    "mirrored",
    "muscle_controls",
    "parse_presets",
    "resolve_pose",
    "sided",
]
