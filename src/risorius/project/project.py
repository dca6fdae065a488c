"""The project: which head, which landmarks, which method, with what settings."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from risorius._check import one_of
from risorius.controls.shape_sets import ALL_SHAPE_SETS, SHAPE_SETS
from risorius.head.head import HeadOptions
from risorius.head.part import PART_KINDS

__all__ = ["BONES", "BUILTIN", "INLINE", "METHODS", "PROFILES", "Project"]

BUILTIN = "builtin"
"""What stands for a path where the head that ships with risorius is meant."""

METHODS = ("layered", "springs", "vector")
"""Methods that pose a face."""

INLINE = ("landmarks", "vector_set", "muscle_map", "recipe", "presets")
"""Recipes that may stand in the project file itself instead of in a file of their own."""

BONES = ("given", "builtin", "cut")
"""Where spring muscles find skull and jaw: files, the built-in skull, the head's own mesh."""

PROFILES = ("improved", "faithful")
"""How closely a method follows its publication."""


@dataclass(frozen=True)
class Project:
    """Everything that `risorius rig` needs to know; nothing in it is derived.

    Parameters
    ----------
    head : Path or None
        Mesh file; None for the built-in head.
    landmarks : Path or None
        Landmark file; None where the head brings its own, or has a file
        ``<head>.landmarks.json`` beside it.
    unit, axes : str or None
        See `HeadOptions`; None to detect them.
    parts : mapping of str to str
        Part kind -> name of object, group or material.
    flip_landmarks : bool
        Exchange left and right in the landmark names.
    method : str
        One of `METHODS`.
    profile : str
        One of `PROFILES`.
    parameters : mapping of str to value
        Parameters of the method that differ from its profile.
    vector_set, muscle_map, recipe, presets : Path or None
        Recipes of the methods (outlines of spring muscles: `recipe`) and poses; None for those
        that ship with risorius.
    bones : str or None
        Where spring muscles find their bones, one of `BONES`; None for the given skull, else the
        built-in one.
    skull, mandible, skull_landmarks : Path or None
        A skull of one's own; the mandible where it has a file of its own.
    shapes : tuple of str
        Sets of shapes to bake.
    inline : mapping of str to dict
        Contents of recipes that stand in the project file itself, by `INLINE`; they go before
        the path of the same name.
    poses : mapping of str to mapping of str to float
        Poses that a person keeps, by name.

    Raises
    ------
    ParameterError
        If a word is not one of its choices.
    """

    head: Path | None = None
    landmarks: Path | None = None
    unit: str | None = None
    axes: str | None = None
    parts: Mapping[str, str] = field(default_factory=dict[str, str])
    flip_landmarks: bool = False
    method: str = "layered"
    profile: str = "improved"
    parameters: Mapping[str, float | str] = field(default_factory=dict[str, float | str])
    vector_set: Path | None = None
    muscle_map: Path | None = None
    recipe: Path | None = None
    presets: Path | None = None
    bones: str | None = None
    skull: Path | None = None
    mandible: Path | None = None
    skull_landmarks: Path | None = None
    shapes: tuple[str, ...] = SHAPE_SETS
    inline: Mapping[str, Mapping[str, Any]] = field(default_factory=dict[str, Mapping[str, Any]])
    poses: Mapping[str, Mapping[str, float]] = field(default_factory=dict[str, Mapping[str, float]])

    def __post_init__(self) -> None:
        one_of("method", self.method, METHODS)
        one_of("profile", self.profile, PROFILES)
        if self.bones is not None:
            one_of("bones", self.bones, BONES)
        for name in self.shapes:
            one_of("shapes", name, ALL_SHAPE_SETS)
        for kind in self.parts:
            one_of("part", kind, PART_KINDS)
        for name in self.inline:
            one_of("inline", name, INLINE)

    @property
    def options(self) -> HeadOptions:
        """What a person said about the head."""
        return HeadOptions(self.unit, self.axes, dict(self.parts), self.flip_landmarks)

    @property
    def name(self) -> str:
        """The head in words."""
        return BUILTIN if self.head is None else str(self.head)
