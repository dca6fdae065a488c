"""From a project to its spring-muscle face."""

from __future__ import annotations

from dataclasses import fields, replace
from typing import Any, cast

from risorius._check import as_number
from risorius.anatomy.mechanics import Mechanics
from risorius.anatomy.skull import Skull
from risorius.errors import ParameterError
from risorius.head.head import Head
from risorius.layered.muscle_map import default_muscle_map
from risorius.project.layered import skull_of
from risorius.project.project import Project
from risorius.rig.face import Face
from risorius.springmuscle.bones import BoneWay
from risorius.springmuscle.face import SpringFace
from risorius.springmuscle.parameters import Profile, SpringParameters
from risorius.springmuscle.recipe import OutlineRecipe
from risorius.springmuscle.recipe_file import default_recipe, parse_recipe, read_recipe

__all__ = ["recipe_of", "spring_face", "spring_parameters"]


def recipe_of(project: Project) -> OutlineRecipe:
    """Return the outline recipe of a project, or the one that ships with risorius."""
    inline = project.inline.get("recipe")
    if inline is not None:
        return parse_recipe(inline, source=f"{project.name}: recipe")
    return default_recipe() if project.recipe is None else read_recipe(project.recipe)


def spring_face(project: Project, head: Head, mechanics: Mechanics | None) -> Face:
    """Bind the spring-muscle face to a head.

    Raises
    ------
    ParameterError
        If the project sets a parameter that the method does not have, or out of range, or wants
        a skull of its own and names none.
    """
    profile = cast(Profile, project.profile)
    way = project.bones or ("builtin" if project.skull is None else "given")
    skull = _skull(project, way)
    return SpringFace.build(
        head, recipe_of(project), bones=cast(BoneWay, way), skull=skull, profile=profile,
        mechanics=mechanics, parameters=spring_parameters(project),
    )  # fmt: skip


def _skull(project: Project, way: str) -> Skull | None:
    if way == "given":
        if project.skull is None:
            raise ParameterError(
                "bones: 'given' needs a skull; name it with --skull, or choose builtin or cut"
            )
        return skull_of(project, default_muscle_map())
    for name in ("skull", "mandible", "skull_landmarks"):
        if getattr(project, name) is not None:
            raise ParameterError(
                f"{name}: the way {way!r} to the bones makes no use of it; choose given, or leave "
                "it out"
            )
    return None


def spring_parameters(project: Project) -> SpringParameters:
    """Return the parameters of the profile with what the project changes.

    Raises
    ------
    ParameterError
        If the method does not have one, or its value is no such number.
    """
    base = SpringParameters.of_profile(cast(Profile, project.profile))
    numbers = {
        entry.name: getattr(base, entry.name)
        for entry in fields(base)
        if type(getattr(base, entry.name)) in (int, float)
    }
    changed: dict[str, Any] = {}
    for name, value in project.parameters.items():
        if name not in numbers:
            raise ParameterError(
                f"parameters: the method {project.method!r} has no {name!r}; it has "
                f"{', '.join(numbers)}"
            )
        number = as_number(f"parameters: {name}", value)
        whole = isinstance(numbers[name], int)
        if whole and not number.is_integer():
            raise ParameterError(f"parameters: {name}: {number:g} is not a whole number")
        changed[name] = int(number) if whole else number
    return replace(base, **changed)
