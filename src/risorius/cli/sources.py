"""From the arguments of a verb to a project, a head and a rig."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from difflib import get_close_matches
from pathlib import Path
from typing import Any

from risorius import _formats
from risorius.anatomy.mechanics import Mechanics
from risorius.cli.talk import Talk
from risorius.controls.shape_sets import ALL_SHAPE_SETS, SOLVED_SETS, ShapeList, list_shapes
from risorius.errors import ParameterError
from risorius.head.head import Head, HeadOptions
from risorius.playback.pairs import CorrectivePair, find_pairs, with_pairs
from risorius.playback.shape_names import set_of
from risorius.playback.solved_sets import with_solved_sets
from risorius.project import (
    BUILTIN,
    Project,
    face_of,
    landmarks_of,
    presets_of,
    read_mesh,
    read_project,
    vectors_of,
)
from risorius.project.styled import styled, unknown_of
from risorius.rig.bake import bake, empty_rig
from risorius.rig.rig import Rig
from risorius.tuning.style import read_style

__all__ = [
    "Baked",
    "Given",
    "bake_head",
    "is_rig",
    "load_rig",
    "read_head",
    "require_shapes",
    "resolve",
    "with_given",
    "with_head",
]

_REPLACED = (
    "landmarks", "unit", "axes", "method", "profile", "presets", "vector_set", "muscle_map",
    "recipe", "bones", "skull", "mandible", "skull_landmarks",
)  # fmt: skip
_RIG_ENDINGS = (".glb", ".gltf", ".npz")


@dataclass(frozen=True)
class Given:
    """What stood on the command line; None and empty where nothing was said."""

    landmarks: Path | None = None
    unit: str | None = None
    axes: str | None = None
    parts: dict[str, str] = field(default_factory=dict[str, str])
    flip_landmarks: bool = False
    method: str | None = None
    profile: str | None = None
    parameters: dict[str, float | str] = field(default_factory=dict[str, float | str])
    shapes: str | None = None
    presets: Path | None = None
    vector_set: Path | None = None
    muscle_map: Path | None = None
    recipe: Path | None = None
    bones: str | None = None
    skull: Path | None = None
    mandible: Path | None = None
    skull_landmarks: Path | None = None


def resolve(head: str, given: Given) -> Project:
    """Return the project that `head` names or stands for, with what was given on top.

    Raises
    ------
    FormatError
        If a project file is missing or malformed.
    ParameterError
        If a word is not one of its choices.
    """
    if head.lower().endswith(".json"):
        return with_given(read_project(head), given)
    return with_given(with_head(Project(), head), given)


def with_head(base: Project, head: str | None) -> Project:
    """Return `base` with another head, if one was given."""
    if head is None:
        return base
    return replace(base, head=None if head == BUILTIN else Path(head))


def with_given(base: Project, given: Given) -> Project:
    """Return `base` with everything replaced that was given."""
    changed: dict[str, Any] = {
        name: getattr(given, name) for name in _REPLACED if getattr(given, name) is not None
    }
    if given.parts:
        changed["parts"] = {**base.parts, **given.parts}
    if given.parameters:
        changed["parameters"] = {**base.parameters, **given.parameters}
    if given.flip_landmarks:
        changed["flip_landmarks"] = not base.flip_landmarks
    if given.shapes is not None:
        changed["shapes"] = tuple(name.strip() for name in given.shapes.split(",") if name.strip())
        if not changed["shapes"]:
            raise ParameterError(
                f"shapes: {given.shapes!r} names no set; choose from {', '.join(ALL_SHAPE_SETS)}"
            )
    return replace(base, **changed)


def is_rig(path: str) -> bool:
    """Return whether `path` names a rig: a GLB, an archive or a folder of OBJ files."""
    return Path(path).suffix.lower() in _RIG_ENDINGS or Path(path).is_dir()


def read_head(project: Project, talk: Talk) -> Head:
    """Read the head of a project and say which frame was found."""
    with talk.stage("read"):
        mesh, carried = read_mesh(project)
        specs = landmarks_of(project, carried)
    with talk.stage("parts+lips+lids"):
        head = Head.from_mesh(mesh, specs, options=project.options)
    talk.put(
        head=project.name,
        vertices=head.vertex_count,
        polygons=mesh.polygon_count,
        frame={
            "unit": head.frame.unit,
            "millimetres": head.frame.scale,
            "description": head.frame.describe(),
        },
        parts={kind: len(part.source) for kind, part in head.parts.items()},
    )
    talk.say(f"{project.name}: {head.vertex_count} vertices, {mesh.polygon_count} polygons")
    talk.say(f"  frame: {head.frame.describe()}")
    talk.say(f"  parts: {', '.join(head.parts)}")
    return head


def load_rig(path: str, landmarks: Path | None, *, flip_landmarks: bool = False) -> Rig:
    """Read a rig; `landmarks` place and part one that was made elsewhere.

    Raises
    ------
    RisoriusError
        If the rig cannot be read or the landmarks do not fit it.
    """
    rig = Rig.load(path)
    if landmarks is None:
        return rig
    specs = _formats.read_landmarks(landmarks)
    options = HeadOptions(flip_landmarks=flip_landmarks)
    head = Head.from_mesh(rig.mesh, specs, options=options)
    return empty_rig(head).with_targets(rig.targets, controls=rig.controls, left_out=rig.left_out)


@dataclass(frozen=True, eq=False)
class Baked:
    """A rig and what its making had to leave out."""

    rig: Rig
    left_out: dict[str, str]
    pairs: tuple[CorrectivePair, ...] = ()


def bake_head(
    project: Project,
    talk: Talk,
    *,
    only: Sequence[str] | None = None,
    correctives: int = 0,
    style: Path | None = None,
) -> Baked:
    """Read a head, bind the method and bake its shapes, or `only` those named.

    Parameters
    ----------
    project : Project
    talk : Talk
    only : sequence of str, optional
        Shapes to bake; all of the project's sets if left out.
    correctives : int
        How many corrective pairs of ARKit shapes to add, of all shapes in a rig without ARKit.
    style : Path, optional
        What was tuned on another head.

    Raises
    ------
    RisoriusError
        If something of it is refused.
    """
    vectors_of(project)  # refused now, not after the long work
    presets = presets_of(project)
    worn = read_style(style) if style is not None else None
    if worn is not None:
        worn.require_method(project.method, source=str(style))
    head = read_head(project, talk)
    if worn is not None:
        for name in unknown_of(project, worn):
            talk.note(f"style: no muscle or preset has the parameter {name}")
        project = styled(project, worn, head, source=str(style))
        presets = presets_of(project)
    with talk.stage("parts+lips+lids"):
        mechanics = Mechanics.build(head)
    with talk.stage("muscles"):
        face = face_of(project, head, mechanics=mechanics)
    for note in mechanics.notes:
        talk.note(note)
    shapes = list_shapes(face.controls, presets, sets=project.shapes)
    if set(project.shapes) & set(SOLVED_SETS):
        with talk.stage("solve") as tick:
            shapes = with_solved_sets(shapes, face, project.shapes, progress=tick)
    if only is not None:
        shapes = _chosen(shapes, only)
    with talk.stage("bake") as tick:
        rig = bake(face, shapes.poses, left_out=shapes.left_out, upon=shapes.upon, progress=tick)
    pairs: tuple[CorrectivePair, ...] = ()
    if correctives:
        with talk.stage("correctives") as tick:
            wanted = {n: p for n, p in shapes.poses.items() if set_of(n) == "arkit"}
            pairs = find_pairs(
                face, wanted or shapes.poses, budget=correctives, upon=shapes.upon, progress=tick
            )
            rig = with_pairs(rig, pairs)
    return Baked(rig, dict(shapes.left_out), pairs)


def require_shapes(
    names: Iterable[str], known: Collection[str], left_out: Mapping[str, str]
) -> None:
    """Refuse names of shapes that are not `known`, with the reason or the nearest names.

    Raises
    ------
    ParameterError
        For the first unknown name.
    """
    for name in names:
        if name in known:
            continue
        if name in left_out:
            raise ParameterError(f"shapes: {name!r} was left out: {left_out[name]}")
        near = get_close_matches(name, known, n=3)
        way = f"did you mean {' or '.join(near)}?" if near else "`risorius inspect` lists them"
        raise ParameterError(f"shapes: there is no {name!r} among {len(known)}; {way}")


def _chosen(shapes: ShapeList, names: Sequence[str]) -> ShapeList:
    require_shapes(names, shapes.poses, shapes.left_out)
    return replace(shapes, poses={name: shapes.poses[name] for name in names}, left_out={})
