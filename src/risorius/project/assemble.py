"""From a project to what it names: mesh, landmarks, recipes, face."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import fields, replace
from importlib.resources import as_file, files
from pathlib import Path
from typing import Any, cast

from risorius import _formats
from risorius._check import as_number, one_of
from risorius.anatomy.mechanics import Mechanics
from risorius.controls.presets import PresetBook, default_presets, parse_presets
from risorius.errors import LandmarkError, ParameterError
from risorius.head.head import Head
from risorius.io.bounded import check_schema, read_json
from risorius.io.json_fields import Fields
from risorius.io.landmarks import landmarks_from_json
from risorius.landmarks.landmark_set import LandmarkSpec
from risorius.mesh.polygon_mesh import PolygonMesh
from risorius.project.layered import layered_face, require_no_parameters
from risorius.project.project import Project
from risorius.project.springs import spring_face, spring_parameters
from risorius.rig.face import Face
from risorius.vectormuscle.face import Profile, VectorFace, VectorParameters
from risorius.vectormuscle.vector_set import VectorSet, default_vector_set, parse_vector_set

__all__ = [
    "BUILDERS",
    "face_of",
    "landmarks_of",
    "presets_of",
    "read_mesh",
    "read_presets",
    "read_vector_set",
    "require_parameters",
    "vectors_of",
]

Specs = Mapping[str, LandmarkSpec]
_CHOICES = {"angular": ("smooth", "published")}
_RANGES = {"steps": (1, 64), "support": (0.0, 1.0), "drag": (0, 1)}


def read_mesh(project: Project) -> tuple[PolygonMesh, Specs]:
    """Read the mesh of a project's head, and the landmarks that its file carries.

    Raises
    ------
    FormatError
        If the file is missing or malformed.
    """
    if project.head is not None:
        return _formats.read_head(project.head)
    with as_file(_assets()) as folder:
        mesh, _ = _formats.read_head(folder / "head.obj")
        return mesh, _formats.read_landmarks(folder / "head.landmarks.json")


def landmarks_of(project: Project, carried: Specs) -> Specs:
    """Return the landmarks of a project's head.

    Those in the project itself come first, then the project's landmark file, then those that the
    head's own file `carried`, then the file ``<head>.landmarks.json`` beside it.

    Raises
    ------
    FormatError
        If a file is missing or malformed.
    LandmarkError
        If there are no landmarks at all.
    """
    if "landmarks" in project.inline:
        document = Fields(dict(project.inline["landmarks"]), "project: landmarks")
        check_schema(document.value, document.where, schema="risorius/landmarks", version=1)
        return landmarks_from_json(document.fields("landmarks").value, document.where)
    if project.landmarks is not None:
        return _formats.read_landmarks(project.landmarks)
    if carried or project.head is None:
        return carried
    beside = project.head.with_suffix(".landmarks.json")
    if beside.is_file():
        return _formats.read_landmarks(beside)
    raise LandmarkError(
        f"{project.head}: carries no landmarks and has no {beside.name} beside it; give a landmark "
        "file with --landmarks FILE (`risorius landmarks` lists the names)"
    )


def read_presets(path: str | Path) -> PresetBook:
    """Read a presets file.

    Raises
    ------
    FormatError
        If it is missing or malformed.
    """
    return parse_presets(read_json(path, schema="risorius/presets"), source=str(path))


def read_vector_set(path: str | Path) -> VectorSet:
    """Read a vector set.

    Raises
    ------
    FormatError
        If it is missing or malformed.
    """
    return parse_vector_set(read_json(path, schema="risorius/vector-set"), source=str(path))


def presets_of(project: Project) -> PresetBook:
    """Return the presets of a project, or those that ship with risorius."""
    if "presets" in project.inline:
        return parse_presets(project.inline["presets"], source="project: presets")
    return default_presets() if project.presets is None else read_presets(project.presets)


def vectors_of(project: Project) -> VectorSet:
    """Return the vector set of a project, or the one that ships with risorius."""
    if "vector_set" in project.inline:
        return parse_vector_set(project.inline["vector_set"], source="project: vector_set")
    if project.vector_set is None:
        return default_vector_set()
    return read_vector_set(project.vector_set)


def face_of(project: Project, head: Head, *, mechanics: Mechanics | None = None) -> Face:
    """Bind the project's method to its head.

    Parameters
    ----------
    project : Project
    head : Head
    mechanics : Mechanics, optional
        Already built for this head.

    Raises
    ------
    FormatError
        If a recipe is missing or malformed.
    ParameterError
        If the project sets a parameter that the method does not have, or out of range.
    LandmarkError, MeshError
        If the head is not fit.
    """
    return BUILDERS[project.method](project, head, mechanics)


def require_parameters(project: Project) -> None:
    """Refuse parameters that the project's method does not have, without building a face.

    Raises
    ------
    ParameterError
        With the parameters that it has, or the range that a value leaves.
    """
    _PARAMETERS[project.method](project)


def _vector_face(project: Project, head: Head, mechanics: Mechanics | None) -> Face:
    parameters = vector_parameters(project)
    return VectorFace.build(head, vectors_of(project), mechanics=mechanics, parameters=parameters)


def vector_parameters(project: Project) -> VectorParameters:
    """Return the parameters of the profile with what the project changes.

    Raises
    ------
    ParameterError
        If the method does not have one, or its value is out of range.
    """
    base = VectorParameters.of_profile(cast(Profile, project.profile))
    known = [entry.name for entry in fields(VectorParameters)]
    changed: dict[str, Any] = {}
    for name, value in project.parameters.items():
        if name not in known:
            raise ParameterError(
                f"parameters: the method {project.method!r} has no {name!r}; it has "
                f"{', '.join(known)}"
            )
        where = f"parameters: {name}"
        if name in _CHOICES:
            changed[name] = one_of(where, str(value), _CHOICES[name])
        else:
            low, high = _RANGES.get(name, (None, None))
            number = as_number(where, value, low=low, high=high)
            whole = isinstance(getattr(base, name), int)
            if whole and not number.is_integer():
                raise ParameterError(f"{where}: {number:g} is not a whole number")
            changed[name] = int(number) if whole else number
    return replace(base, **changed)


def _assets() -> Any:
    return files("risorius.anatomy").joinpath("assets")


Builder = Callable[[Project, Head, Mechanics | None], Face]
BUILDERS: dict[str, Builder] = {
    "layered": layered_face,
    "springs": spring_face,
    "vector": _vector_face,
}
"""How each method of `METHODS` is bound to a head."""

_PARAMETERS: dict[str, Callable[[Project], object]] = {
    "layered": require_no_parameters,
    "springs": spring_parameters,
    "vector": vector_parameters,
}
