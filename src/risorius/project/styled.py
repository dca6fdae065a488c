"""A project whose muscles and presets wear a style that was tuned on another head."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

from risorius.head.head import Head
from risorius.project.assemble import presets_of, vectors_of
from risorius.project.layered import muscle_map_of
from risorius.project.preset_document import presets_document_of, with_emotions
from risorius.project.project import Project
from risorius.project.springs import recipe_of
from risorius.springmuscle.fit_parameters import FitParameters
from risorius.springmuscle.recipe_file import recipe_to_json
from risorius.tuning.candidates import paired_controls
from risorius.tuning.genome import Parameter
from risorius.tuning.map_genes import map_parameters
from risorius.tuning.muscle_genes import muscle_parameters
from risorius.tuning.outline_genes import outline_parameters
from risorius.tuning.style import Style
from risorius.vectormuscle.export_points import find_features

__all__ = ["styled", "unknown_of"]

Worn = tuple[str, dict[str, Any]]


def styled(project: Project, style: Style, head: Head, *, source: str) -> Project:
    """Return the project with its muscles and presets in a style.

    Parameters
    ----------
    project : Project
    style : Style
    head : Head
        The project's head; vector muscles are fitted to it before they are changed.
    source : str
        Where the style comes from, for messages.

    Raises
    ------
    ParameterError
        If it is a style of another method.
    RisoriusError
        If a recipe of the project is refused.
    """
    style.require_method(project.method, source=source)
    name, document = _WORN[project.method](project, style, head)
    inline = {**project.inline, name: document}
    presets = presets_of(project)
    worn = style.on_presets(presets)
    changed = {name: pose for name, pose in worn.emotions.items() if pose != presets.emotions[name]}
    if changed:
        inline["presets"] = with_emotions(presets_document_of(project), changed)
    return replace(project, inline=inline)


def unknown_of(project: Project, style: Style) -> tuple[str, ...]:
    """Return the parameters of a style that the project's muscles and presets do not have."""
    muscles = [parameter.name for parameter in _KNOWN[project.method](project)]
    intensities = [
        f"{name}.{control}"
        for name, pose in presets_of(project).emotions.items()
        for control in (*pose, *paired_controls(pose))
    ]
    return style.unknown([*muscles, *intensities])


def _map(project: Project, style: Style, head: Head) -> Worn:
    return "muscle_map", style.on_map(muscle_map_of(project)).to_json()


def _recipe(project: Project, style: Style, head: Head) -> Worn:
    fit = FitParameters.of_profile(project.profile)
    return "recipe", recipe_to_json(style.on_recipe(recipe_of(project), fit=fit))


def _vectors(project: Project, style: Style, head: Head) -> Worn:
    fitted = vectors_of(project).fitted(head)
    worn = style.on_vectors(fitted.muscles, width=find_features(head).width)
    return "vector_set", fitted.replaced(worn).to_json()


def _map_parameters(project: Project) -> tuple[Parameter, ...]:
    muscle_map = muscle_map_of(project)
    return map_parameters(muscle_map, muscle_map.by_name, genes="all")


def _outline_parameters(project: Project) -> tuple[Parameter, ...]:
    recipe = recipe_of(project)
    return outline_parameters(recipe, [each.name for each in recipe.muscles], genes="all")


def _muscle_parameters(project: Project) -> tuple[Parameter, ...]:
    return muscle_parameters(vectors_of(project).muscles, genes="all")


_WORN: dict[str, Callable[[Project, Style, Head], Worn]] = {
    "layered": _map,
    "springs": _recipe,
    "vector": _vectors,
}
_KNOWN: dict[str, Callable[[Project], tuple[Parameter, ...]]] = {
    "layered": _map_parameters,
    "springs": _outline_parameters,
    "vector": _muscle_parameters,
}
