"""Controls: the named inputs of a face, with range and unit."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

from risorius._check import as_number
from risorius.errors import ParameterError

__all__ = ["Control", "ControlGroup", "Pose", "ResolvedPose", "resolve_pose"]

ControlGroup = Literal["muscle", "jaw", "lid", "gaze", "tongue", "lips", "cheek"]
Pose = Mapping[str, float]
"""Control name -> value; controls left out rest at their default."""


@dataclass(frozen=True)
class Control:
    """A named input of a face.

    Parameters
    ----------
    name : str
        snake_case, ``_l`` / ``_r`` at the end for the character's left and right.
    low, high : float
        Range; values outside are clamped.
    default : float
        Value at rest.
    unit : str
        ``"1"``, ``"deg"`` or ``"mm"``.
    group : str
        What it belongs to.
    mirror : str
        Control of the other side; the control itself on the midline.
    mirror_sign : float
        -1 where the mirrored motion has the opposite sign (yaw).
    """

    name: str
    low: float
    high: float
    default: float
    unit: str
    group: ControlGroup
    mirror: str
    mirror_sign: float = 1.0


@dataclass(frozen=True)
class ResolvedPose:
    """A pose with every control of a face, clamped, and what had to be said about it."""

    values: Mapping[str, float]
    clamped: tuple[str, ...]


def resolve_pose(controls: Sequence[Control], pose: Pose) -> ResolvedPose:
    """Fill in defaults and clamp.

    Raises
    ------
    ParameterError
        If a name is unknown or a value is not a finite number.
    """
    values = {control.name: control.default for control in controls}
    ranges = {control.name: control for control in controls}
    clamped: list[str] = []
    for name, value in pose.items():
        control = ranges.get(name)
        if control is None:
            raise ParameterError(
                f"pose: this face has no control {name!r}; it has {', '.join(sorted(ranges))}"
            )
        number = as_number(f"pose: {name}", value)
        inside = min(max(number, control.low), control.high)
        if inside != number:
            clamped.append(
                f"{name} {number:g} clamped to {inside:g} [{control.low:g}, {control.high:g}]"
            )
        values[name] = inside
    return ResolvedPose(values, tuple(clamped))
