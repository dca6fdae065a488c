"""Named sets of shapes: which poses become the morph targets of a rig."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from risorius.controls.arkit import MADE_UPON, arkit_shapes
from risorius.controls.control import Control, Pose
from risorius.controls.presets import PresetBook
from risorius.controls.standard_sets import STANDARD_SETS
from risorius.errors import ParameterError

__all__ = ["ALL_SHAPE_SETS", "SHAPE_SETS", "SOLVED_SETS", "ShapeList", "list_shapes"]

SHAPE_SETS = ("singles", "emotions", "arkit")
"""Sets that a rig gets unless others are chosen, in the order of their shapes."""

SOLVED_SETS = ("fap", "mpeg4_84")
"""Sets whose poses depend on the head and are solved on it (`risorius.playback.fap_shapes`)."""

ALL_SHAPE_SETS = (*SHAPE_SETS, *STANDARD_SETS, *SOLVED_SETS)
"""Every set that can be chosen.

``fap`` are the low-level parameters of MPEG-4, both ways where they have two; ``mpeg4_84`` is the
set of the thesis: 64 of them in their positive direction, the 14 visemes and the six expressions.
"""

_CONTROLS_UPON = {"lips_together": "jaw_pitch"}
"""Controls that mean something at the upper end of another only, as `MADE_UPON` says of shapes."""

_NO_POSE = "no pose in the presets makes it"


@dataclass(frozen=True)
class ShapeList:
    """Shapes to bake.

    `poses` by target name; `left_out` says why a wanted shape cannot be made; `upon` is the pose on
    top of which a shape is made, for the few that mean nothing alone (`MADE_UPON`).
    """

    poses: dict[str, Pose]
    left_out: dict[str, str]
    upon: dict[str, Pose] = field(default_factory=dict[str, Pose])


def list_shapes(
    controls: Sequence[Control], presets: PresetBook, *, sets: Sequence[str] = SHAPE_SETS
) -> ShapeList:
    """List the shapes of the named `sets` that a face with `controls` can make.

    Singles are named by their control at its upper end, with ``_neg`` behind the name for the
    lower end of a two-way control. Of `SOLVED_SETS` only the shapes that presets hold are listed.

    Raises
    ------
    ParameterError
        If a set is unknown.
    """
    unknown = [name for name in sets if name not in ALL_SHAPE_SETS]
    if unknown:
        raise ParameterError(
            f"shapes: {', '.join(unknown)} is not known; choose from {', '.join(ALL_SHAPE_SETS)}"
        )
    poses: dict[str, Pose] = {}
    left_out: dict[str, str] = {}
    if "singles" in sets:
        for control in controls:
            poses[control.name] = {control.name: control.high}
            if control.low < control.default:
                poses[f"{control.name}_neg"] = {control.name: control.low}
    wanted = _wanted(presets, sets, left_out)
    for name, pose in wanted.items():
        fitted = presets.fit(pose, controls)
        if fitted.missing and len(fitted.missing) == len(pose):
            left_out[name] = f"the face has no {', '.join(fitted.missing)}"
        else:
            poses[name] = fitted.pose
            if fitted.missing:
                left_out[f"{name} (in part)"] = f"made without {', '.join(fitted.missing)}"
    upon = {
        name: presets.fit(presets.arkit[base], controls).pose
        for name, base in MADE_UPON.items()
        if name in poses and base in presets.arkit
    }
    ranges = {control.name: control for control in controls}
    for name, base in _CONTROLS_UPON.items():
        if name in poses and base in ranges:
            upon[name] = {base: ranges[base].high}
    return ShapeList(poses, left_out, upon)


def _add_standard(
    section: str, presets: PresetBook, wanted: dict[str, Pose], left_out: dict[str, str]
) -> None:
    """Add the shapes of a standard to those that are `wanted` or `left_out`."""
    standard = STANDARD_SETS[section]
    poses = presets.standards.get(section, {})
    reasons = standard.left_out()
    for entry in standard.entries():
        found = [name for name in (entry, f"{entry}_l", f"{entry}_r") if name in poses]
        for name in found:
            wanted[standard.prefix + name] = poses[name]
        if not found:
            left_out[standard.prefix + entry] = reasons.get(entry, _NO_POSE)


def _wanted(presets: PresetBook, sets: Sequence[str], left_out: dict[str, str]) -> dict[str, Pose]:
    """Return the poses of the sets in the presets; what they lack goes to `left_out`."""
    wanted: dict[str, Pose] = {}
    if "emotions" in sets or "mpeg4_84" in sets:
        wanted |= dict(presets.emotions)
    if "arkit" in sets:
        for shape in arkit_shapes():
            if shape.name in presets.arkit:
                wanted[shape.name] = presets.arkit[shape.name]
            else:
                left_out[shape.name] = _NO_POSE
    for section in STANDARD_SETS:
        if section in sets or (section == "visemes_mpeg4" and "mpeg4_84" in sets):
            _add_standard(section, presets, wanted, left_out)
    return wanted
