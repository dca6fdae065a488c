"""From a project to its layered face."""

from __future__ import annotations

from risorius.anatomy.mechanics import Mechanics
from risorius.anatomy.skull import Skull, builtin_skull, load_skull
from risorius.errors import ParameterError
from risorius.head.head import Head
from risorius.layered.face import LayeredFace
from risorius.layered.faithful import FaithfulFace
from risorius.layered.muscle_map import (
    MuscleMap,
    default_muscle_map,
    parse_muscle_map,
    read_muscle_map,
)
from risorius.project.project import Project
from risorius.rig.face import Face

__all__ = ["layered_face", "muscle_map_of", "require_no_parameters", "skull_of"]


def muscle_map_of(project: Project) -> MuscleMap:
    """Return the muscle map of a project, or the one that ships with risorius."""
    if "muscle_map" in project.inline:
        return parse_muscle_map(project.inline["muscle_map"], source="project: muscle_map")
    return (
        default_muscle_map() if project.muscle_map is None else read_muscle_map(project.muscle_map)
    )


def skull_of(project: Project, muscle_map: MuscleMap) -> Skull:
    """Return the skull of a project, or the one that ships with risorius.

    Raises
    ------
    ParameterError
        If a skull comes without landmarks, or landmarks or a mandible without a skull.
    """
    if project.skull is None:
        if project.mandible or project.skull_landmarks:
            raise ParameterError("skull: a mandible or skull landmarks were given without a skull")
        return builtin_skull()
    if project.skull_landmarks is None:
        raise ParameterError(
            f"skull: {project.skull} needs bone landmarks that place it; give a file of them with "
            "--skull-landmarks"
        )
    files = (project.skull,) if project.mandible is None else (project.skull, project.mandible)
    return load_skull(files, project.skull_landmarks, marks=muscle_map.landmarks)


def layered_face(project: Project, head: Head, mechanics: Mechanics | None) -> Face:
    """Bind the layered face to a head.

    Raises
    ------
    ParameterError
        If the project asks for a parameter that the method does not have.
    """
    require_no_parameters(project)
    muscle_map = muscle_map_of(project)
    skull = skull_of(project, muscle_map)
    if project.profile == "faithful":
        return FaithfulFace.build(head, muscle_map, skull=skull, mechanics=mechanics)
    return LayeredFace.build(head, muscle_map, skull=skull, mechanics=mechanics)


def require_no_parameters(project: Project) -> None:
    """Refuse parameters, of which the layered face has none outside its map.

    Raises
    ------
    ParameterError
        If the project sets one.
    """
    if project.parameters:
        raise ParameterError(
            f"parameters: the method {project.method!r} has no {next(iter(project.parameters))!r}; "
            "its parameters stand in the muscle map (--muscle-map FILE)"
        )
