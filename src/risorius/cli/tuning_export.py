"""Tune the groups of an export of vector muscles, or all muscles of another method."""

from __future__ import annotations

from collections.abc import Iterable

from risorius.anatomy.mechanics import Mechanics
from risorius.cli.talk import Talk
from risorius.cli.tuning import Tuning
from risorius.project.tunable import Tunable
from risorius.tuning.candidates import FaceCandidates
from risorius.tuning.muscle_genes import MuscleCandidates
from risorius.vectormuscle.export import Export, export_muscles, export_order
from risorius.vectormuscle.face import VectorFace
from risorius.vectormuscle.muscle import VectorMuscle
from risorius.vectormuscle.vector_set import VectorSet

__all__ = ["tune_export", "tune_muscles"]


def tune_export(export: Export, tuning: Tuning, talk: Talk) -> VectorSet:
    """Go through the groups of an export; return the set on the target.

    Parameters
    ----------
    export : Export
        Before its first group.
    tuning : Tuning
        Its style grows.
    talk : Talk

    Raises
    ------
    RisoriusError
        If something is refused.
    """
    mechanics = Mechanics.build(export.target)
    width = export.features[1].width

    def tune_group(now: Export) -> Iterable[VectorMuscle]:
        group = now.group
        assert group is not None
        proposal = now.proposal(group.muscles)
        if tuning.wants(group.expression):
            with talk.stage("muscles"):
                face = VectorFace.build(now.target, now.vector_set(), mechanics=mechanics)
            muscles = None
            choices = tuning.choices
            if choices.genes is not None:
                pose = tuning.pose_of(group.expression, face)
                muscles = MuscleCandidates(
                    face, group.muscles, pose, width, mirror=choices.mirror, genes=choices.genes
                )
            tuning.run(group.expression, face, muscles)
        return tuning.style.on_vectors(proposal, width=width)

    vectors = export_muscles(
        export,
        tune=tune_group,
        finish=lambda rest: tuning.style.on_vectors(rest, width=width),
    )
    grouped = {group.expression for group in export.groups}
    for expression in export_order(tuning.presets):
        if expression not in grouped and tuning.wants(expression):
            face = VectorFace.build(export.target, vectors, mechanics=mechanics)
            tuning.run(expression, face, None)
    return vectors


def tune_muscles(subject: Tunable, tuning: Tuning) -> None:
    """Go through the expressions of layered or spring muscles.

    A muscle is tuned in the first of the wanted expressions that contracts it.

    Parameters
    ----------
    subject : Tunable
    tuning : Tuning
        Its style grows.

    Raises
    ------
    RisoriusError
        If something is refused.
    """
    taken: set[str] = set()
    for expression in export_order(tuning.presets):
        if not tuning.wants(expression):
            continue
        pose = tuning.pose_of(expression, subject.face)
        names = tuple(name for name in subject.muscles(pose) if name not in taken)
        taken.update(names)
        muscles: FaceCandidates | None = None
        if names and tuning.choices.genes is not None:
            muscles = subject.candidates(
                names, pose, style=tuning.style, genes=tuning.choices.genes
            )
        face = subject.face if muscles is not None else subject.face_in(tuning.style)
        tuning.run(expression, face, muscles)
