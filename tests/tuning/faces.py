"""Faces whose muscles tests tune; each is built once."""

from __future__ import annotations

from functools import cache

from risorius.anatomy.template import builtin_head
from risorius.controls.presets import default_presets
from risorius.layered.workbench import Workbench
from risorius.rig.face import Face
from risorius.springmuscle.face import SpringFace
from risorius.tuning.genome import Parameter


@cache
def builtin_bench() -> Workbench:
    """Return the layered muscles of the built-in head, ready to be drawn anew."""
    return Workbench.build(builtin_head())


@cache
def builtin_springs() -> SpringFace:
    """Return the spring muscles of the built-in head."""
    return SpringFace.build(builtin_head())


def expression(face: Face, name: str) -> dict[str, float]:
    """Return an emotion of the presets that ship, as a face can make it."""
    pose = default_presets().fit(default_presets().emotions[name], face.controls).pose
    return {control: value for control, value in pose.items() if value}


def values_at(parameters: tuple[Parameter, ...], share: float) -> dict[str, float]:
    """Return values that lie at `share` of the way from low to high."""
    return {each.name: each.low + share * (each.high - each.low) for each in parameters}
