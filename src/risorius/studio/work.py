"""Everything human-made at one moment, and the way between it and a project."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any, TypeVar

from risorius.controls.control import Pose
from risorius.errors import RisoriusError
from risorius.io.landmarks import landmarks_to_json
from risorius.landmarks.landmark_set import LandmarkSpec
from risorius.layered.muscle_map import MuscleMap
from risorius.project import Project, landmarks_of, read_mesh, vectors_of
from risorius.project.layered import muscle_map_of
from risorius.project.springs import recipe_of
from risorius.springmuscle.recipe import OutlineRecipe
from risorius.springmuscle.recipe_file import recipe_to_json
from risorius.vectormuscle.vector_set import VectorSet

__all__ = ["CURRENT", "Shelf", "Work", "originals_of", "project_of", "work_of"]

CURRENT = "current"
"""Name under which a project keeps the pose that its sliders show."""

# Recipes in a project that the studio hands on as they are.
_HANDED_ON = ("presets",)

Value = TypeVar("Value")
Json = dict[str, Any]


@dataclass(frozen=True, eq=False)
class Work:
    """Everything human-made, at one moment.

    Parameters
    ----------
    project : Project
        Head, method, settings; without the recipes below.
    muscle_map : MuscleMap
    vectors : VectorSet
    recipe : OutlineRecipe
    landmarks : mapping of str to LandmarkSpec
        Of the head, as its file counts.
    pose : mapping of str to float
        What the sliders show.
    """

    project: Project
    muscle_map: MuscleMap
    vectors: VectorSet
    recipe: OutlineRecipe
    landmarks: Mapping[str, LandmarkSpec]
    pose: Pose = field(default_factory=dict[str, float])

    @property
    def poses(self) -> Mapping[str, Pose]:
        """Poses that a person keeps, by name."""
        return {name: pose for name, pose in self.project.poses.items() if name != CURRENT}


class Shelf:
    """Recipes that were read already: what is the same in two projects is one object.

    Faces are changed where objects are the same, and built anew where they are not.
    """

    def __init__(self) -> None:
        self._known: dict[object, Any] = {}

    def take(
        self, name: str, project: Project, read: Callable[[Project], Value], *outside: object
    ) -> Value:
        """Return what `read` makes of a project's recipe `name`, reading it once.

        Parameters
        ----------
        name : str
        project : Project
        read : callable
        *outside : object
            What else it depends on.
        """
        inline, place = project.inline.get(name), getattr(project, name)
        if inline is not None:
            place = hashlib.sha256(json.dumps(inline, sort_keys=True).encode()).digest()
        key = (name, place, *outside)
        if key not in self._known:
            self._known[key] = read(project)
        return self._known[key]


def work_of(project: Project, shelf: Shelf | None = None) -> Work:
    """Read everything that a project names.

    Parameters
    ----------
    project : Project
    shelf : Shelf, optional
        Of the works that it belongs to.

    Raises
    ------
    RisoriusError
        If something is missing or malformed.
    """
    known = shelf or Shelf()
    handed_on = {name: project.inline[name] for name in _HANDED_ON if name in project.inline}
    return Work(
        project=replace(project, inline=handed_on),
        muscle_map=known.take("muscle_map", project, muscle_map_of),
        vectors=known.take("vector_set", project, vectors_of),
        recipe=known.take("recipe", project, recipe_of),
        landmarks=known.take("landmarks", project, _landmarks, project.head),
        pose=dict(project.poses.get(CURRENT, {})),
    )


def project_of(work: Work, before: Project, originals: Mapping[str, Json | None]) -> Project:
    """Return the project with every recipe in it that a person has changed.

    Parameters
    ----------
    work : Work
    before : Project
        As it was opened.
    originals : mapping of str to dict
        Recipes as they ship or stand in files that the project names; see `originals_of`.
    """
    inline: dict[str, Mapping[str, Any]] = {}
    for name in _HANDED_ON:
        if name in before.inline:
            inline[name] = before.inline[name]
    content = {
        "muscle_map": work.muscle_map.to_json(),
        "vector_set": work.vectors.to_json(),
        "recipe": recipe_to_json(work.recipe),
        "landmarks": _landmark_document(work.landmarks),
    }
    for name, now in content.items():
        foreign = name == "landmarks" and before.head != work.project.head
        if foreign or now != originals.get(name):
            inline[name] = now
    poses = dict(work.poses)
    if work.pose:
        poses[CURRENT] = dict(work.pose)
    return replace(work.project, inline=inline, poses=poses)


def originals_of(project: Project) -> dict[str, Json | None]:
    """Return the recipes that a project gets from outside itself, as they stand in files.

    None where such a file has gone: what was read of it is then kept in the project.
    """
    bare = replace(project, inline={})
    readers: dict[str, Callable[[], Json]] = {
        "muscle_map": lambda: muscle_map_of(bare).to_json(),
        "vector_set": lambda: vectors_of(bare).to_json(),
        "recipe": lambda: recipe_to_json(recipe_of(bare)),
        "landmarks": lambda: _landmark_document(_landmarks(bare)),
    }
    return {name: _quiet(reader) for name, reader in readers.items()}


def _landmarks(project: Project) -> Mapping[str, LandmarkSpec]:
    return dict(landmarks_of(project, read_mesh(project)[1]))


def _quiet(reader: Callable[[], Json]) -> Json | None:
    try:
        return reader()
    except RisoriusError:
        return None


def _landmark_document(specs: Mapping[str, LandmarkSpec]) -> Json:
    return {
        "schema": "risorius/landmarks",
        "version": 1,
        "landmarks": landmarks_to_json(specs),
    }
