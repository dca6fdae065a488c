"""Named sets of shapes: which poses become the morph targets of a rig."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from risorius.controls.arkit import arkit_shapes
from risorius.controls.control import Control, Pose
from risorius.controls.presets import PresetBook
from risorius.errors import ParameterError

__all__ = ["SHAPE_SETS", "ShapeList", "list_shapes"]

SHAPE_SETS = ("singles", "emotions", "arkit")
"""Known sets, in the order in which their shapes appear in a rig."""


@dataclass(frozen=True)
class ShapeList:
    """Shapes to bake.

    `poses` by target name; `left_out` says why a wanted shape cannot be made.
    """

    poses: dict[str, Pose]
    left_out: dict[str, str]


def list_shapes(
    controls: Sequence[Control], presets: PresetBook, *, sets: Sequence[str] = SHAPE_SETS
) -> ShapeList:
    """List the shapes of the named `sets` that a face with `controls` can make.

    Singles are named by their control at its upper end, with ``_neg`` behind the name for the
    lower end of a two-way control.

    Raises
    ------
    ParameterError
        If a set is unknown.
    """
    unknown = [name for name in sets if name not in SHAPE_SETS]
    if unknown:
        raise ParameterError(
            f"shapes: {', '.join(unknown)} is not known; choose from {', '.join(SHAPE_SETS)}"
        )
    poses: dict[str, Pose] = {}
    left_out: dict[str, str] = {}
    if "singles" in sets:
        for control in controls:
            poses[control.name] = {control.name: control.high}
            if control.low < control.default:
                poses[f"{control.name}_neg"] = {control.name: control.low}
    wanted: dict[str, Pose] = {}
    if "emotions" in sets:
        wanted |= dict(presets.emotions)
    if "arkit" in sets:
        for shape in arkit_shapes():
            if shape.name in presets.arkit:
                wanted[shape.name] = presets.arkit[shape.name]
            else:
                left_out[shape.name] = "no pose in the presets makes it"
    for name, pose in wanted.items():
        fitted = presets.fit(pose, controls)
        if fitted.missing and len(fitted.missing) == len(pose):
            left_out[name] = f"the face has no {', '.join(fitted.missing)}"
        else:
            poses[name] = fitted.pose
            if fitted.missing:
                left_out[f"{name} (in part)"] = f"made without {', '.join(fitted.missing)}"
    return ShapeList(poses, left_out)
