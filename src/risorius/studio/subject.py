"""The face that a work makes: head, skull and muscles, built from what has changed."""

from __future__ import annotations

from dataclasses import dataclass, replace

from risorius.anatomy.mechanics import Mechanics
from risorius.anatomy.skin import mirror_partners
from risorius.anatomy.skull import Skull
from risorius.anatomy.skull_fit import FittedSkull, fit_skull, hidden_skin
from risorius.controls.presets import PresetBook
from risorius.head.head import Head
from risorius.layered.drawing import SkullSpace
from risorius.layered.workbench import Workbench
from risorius.project import Project, face_of, presets_of, read_mesh
from risorius.project.layered import skull_of
from risorius.rig.face import Face
from risorius.springmuscle.face import SpringFace
from risorius.springmuscle.recipe_file import recipe_to_json
from risorius.springmuscle.redrawing import redrawn
from risorius.studio.work import Work
from risorius.vectormuscle.face import VectorFace

__all__ = ["Subject", "build_subject"]


@dataclass(frozen=True, eq=False)
class Subject:
    """A face bound to a work.

    Parameters
    ----------
    work : Work
    head : Head
    mechanics : Mechanics
    presets : PresetBook
    skull : Skull
        As the muscle map was drawn on it.
    fitted : FittedSkull
        Inside the head.
    face : Face
    bench : Workbench or None
        Of a layered face in the default profile.
    """

    work: Work
    head: Head
    mechanics: Mechanics
    presets: PresetBook
    skull: Skull
    fitted: FittedSkull
    face: Face
    bench: Workbench | None

    @property
    def space(self) -> SkullSpace:
        """The way between the head and the muscle map."""
        return SkullSpace(self.skull, self.fitted)

    @property
    def vector_face(self) -> VectorFace | None:
        """The face, if it is one of vector muscles."""
        return self.face if isinstance(self.face, VectorFace) else None

    @property
    def spring_face(self) -> SpringFace | None:
        """The face, if it is one of spring muscles."""
        return self.face if isinstance(self.face, SpringFace) else None


def build_subject(work: Work, before: Subject | None = None) -> Subject:
    """Build the face of a work; what `before` shares with it is taken over.

    Raises
    ------
    RisoriusError
        If the head or a recipe is refused.
    """
    if before is not None and _same_head(work, before.work):
        head, mechanics, presets = before.head, before.mechanics, before.presets
    else:
        before = None
        mesh, _ = read_mesh(work.project)
        head = Head.from_mesh(mesh, work.landmarks, options=work.project.options)
        mechanics = Mechanics.build(head)
        presets = presets_of(work.project)
    skull, fitted = _skull(work, head, mechanics, before)
    project = work.project
    if project.method == "layered" and project.profile == "improved":
        bench = before.bench if before is not None else None
        if bench is not None and bench.skull is skull:
            if work.muscle_map is not bench.face.muscle_map:
                bench = bench.redrawn(work.muscle_map)
        else:
            bench = Workbench.build(head, work.muscle_map, skull=skull, mechanics=mechanics)
        return Subject(work, head, mechanics, presets, skull, bench.face.skull, bench.face, bench)
    face = _vector_face(work, before) or _spring_face(work, before)
    if face is None:
        face = face_of(_with_recipes(work), head, mechanics=mechanics)
    return Subject(work, head, mechanics, presets, skull, fitted, face, None)


def _same_head(work: Work, other: Work) -> bool:
    now, then = work.project, other.project
    return (now.head, now.options, now.presets) == (
        then.head,
        then.options,
        then.presets,
    ) and work.landmarks is other.landmarks


def _skull(
    work: Work, head: Head, mechanics: Mechanics, before: Subject | None
) -> tuple[Skull, FittedSkull]:
    names = ("skull", "mandible", "skull_landmarks")
    if before is not None and all(
        getattr(work.project, name) == getattr(before.work.project, name) for name in names
    ):
        return before.skull, before.fitted
    skull = skull_of(work.project, work.muscle_map)
    symmetric = mirror_partners(head.skin.mesh) is not None
    hidden = hidden_skin(mechanics.lips, mechanics.margins)
    return skull, fit_skull(skull, head, symmetric=symmetric, hidden=hidden)


def _vector_face(work: Work, before: Subject | None) -> Face | None:
    """Return the face of `before` with other muscles, if that is all that differs."""
    face = before.vector_face if before is not None else None
    if face is None or before is None or work.project.method != "vector":
        return None
    then = before.work
    if (work.project.profile, work.project.parameters) != (
        then.project.profile,
        then.project.parameters,
    ):
        return None
    if work.vectors is then.vectors:
        return face
    fitted = work.vectors.fitted(face.head)
    if tuple(each.name for each in fitted.muscles) != tuple(
        each.name for each in face.vectors.muscles
    ):
        return None
    old = {each.name: each for each in then.vectors.muscles}
    changed = [
        muscle
        for muscle, drawn in zip(fitted.muscles, work.vectors.muscles)
        if drawn is not old.get(drawn.name)
    ]
    return face.with_muscles(changed)


def _spring_face(work: Work, before: Subject | None) -> Face | None:
    """Return the face of `before` on other outlines, if that is all that differs."""
    face = before.spring_face if before is not None else None
    if face is None or before is None:
        return None
    names = ("method", "profile", "parameters", "bones", "skull", "mandible", "skull_landmarks")
    now, then = work.project, before.work.project
    if any(getattr(now, name) != getattr(then, name) for name in names):
        return None
    old = before.work.recipe
    return face if work.recipe is old else redrawn(face, old, work.recipe)


def _with_recipes(work: Work) -> Project:
    recipes = {
        **work.project.inline,
        "muscle_map": work.muscle_map.to_json(),
        "vector_set": work.vectors.to_json(),
        "recipe": recipe_to_json(work.recipe),
    }
    return replace(work.project, inline=recipes)
