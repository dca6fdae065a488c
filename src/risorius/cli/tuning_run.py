"""Run `risorius tune`: bind the head, tune, write what was tuned."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from risorius._check import FloatArray, one_of
from risorius.anatomy.mechanics import Mechanics
from risorius.cli.exporting import Way, begin_export, write_vectors
from risorius.cli.sources import read_head
from risorius.cli.talk import Talk
from risorius.cli.tuning import LEAST_SQUARES, Tuning, TuningChoices
from risorius.cli.tuning_export import tune_export, tune_muscles
from risorius.errors import ParameterError
from risorius.head.head import Head
from risorius.io.atomic import write_json
from risorius.project import Project, presets_of
from risorius.project.preset_document import presets_document_of, with_emotions
from risorius.project.styled import unknown_of
from risorius.project.tunable import tunable_of
from risorius.tuning.style import Style, read_style, write_style
from risorius.tuning.target import may_have_shapes, read_target

__all__ = ["Target", "TuningFiles", "run_tuning"]


@dataclass(frozen=True)
class TuningFiles:
    """Where results go: OUT, presets beside muscles, the style; and the style to begin with."""

    output: Path
    presets: Path | None = None
    style: Path | None = None
    begin: Path | None = None


@dataclass(frozen=True)
class Target:
    """A sculpted head, or weights of shapes of a rig."""

    path: Path
    shapes: Mapping[str, float] = field(default_factory=dict[str, float])


def run_tuning(
    project: Project,
    choices: TuningChoices,
    files: TuningFiles,
    talk: Talk,
    *,
    way: Way,
    target: Target | None = None,
) -> None:
    """Tune the muscles of a project's head and write them.

    Parameters
    ----------
    project : Project
    choices : TuningChoices
    files : TuningFiles
    talk : Talk
    way : Way
        From where vector muscles are carried.
    target : Target, optional
        What the expressions shall look like.

    Raises
    ------
    RisoriusError
        If something is refused.
    """
    presets = presets_of(project)
    for name in choices.expressions:
        one_of("expression", name, presets.emotions)
    _require(project, choices, files, way, target)
    worn = Style(method=project.method) if files.begin is None else read_style(files.begin)
    worn.require_method(project.method, source=str(files.begin))
    for name in unknown_of(project, worn) if worn.parameters else ():
        talk.note(f"style: no muscle or preset has the parameter {name}")

    def tuning_of(head: Head) -> Tuning:
        return Tuning(head, presets, worn, choices, _goals(head, choices, target), talk)

    if project.method == "vector":
        export = begin_export(project, way, talk, first=choices.expressions)
        tuning = tuning_of(export.target)
        vectors = tune_export(export, tuning, talk)
        if choices.genes is not None:
            write_vectors(vectors, files.output, talk)
    else:
        head = read_head(project, talk)
        tuning = tuning_of(head)
        with talk.stage("muscles"):
            subject = tunable_of(project, head, mechanics=Mechanics.build(head))
        tune_muscles(subject, tuning)
        if choices.genes is not None:
            count = subject.write(tuning.style, files.output)
            talk.say(f"wrote {files.output}: {count} muscles")
    if choices.intensities:
        path = files.output if files.presets is None else files.presets
        emotions = tuning.style.on_presets(presets).emotions
        wanted = {name: emotions[name] for name in choices.expressions}
        changed = with_emotions(presets_document_of(project), wanted)
        write_json(path, changed)
        talk.say(f"wrote {path}: presets with {', '.join(wanted)} as tuned")
    talk.put(
        output=files.output, style=dict(tuning.style.parameters), method=project.method,
        strategy=choices.strategy_for(target is not None), seed=choices.seed,
    )  # fmt: skip
    if files.style is not None:
        write_style(tuning.style, files.style)
        talk.say(f"wrote {files.style}: {len(tuning.style.parameters)} tuned parameters")


def _goals(head: Head, choices: TuningChoices, target: Target | None) -> dict[str, FloatArray]:
    if target is None:
        return {}
    several = len(choices.expressions) > 1
    return {
        name: read_target(
            target.path, head, shapes={name: 1.0} if several else target.shapes, expression=name
        )
        for name in choices.expressions
    }


def _require(
    project: Project, choices: TuningChoices, files: TuningFiles, way: Way, target: Target | None
) -> None:
    """Refuse wishes that contradict each other, before the long work."""
    muscles = choices.genes is not None
    one_head = target is not None and (target.shapes or not may_have_shapes(target.path))
    if one_head and len(choices.expressions) > 1:
        raise ParameterError(
            "target: a sculpted head shows one expression; give one, or a rig that has a shape for "
            "each"
        )
    if target is None and choices.strategy == LEAST_SQUARES:
        raise ParameterError(
            f"strategy: {LEAST_SQUARES} needs a shape to fit; give --target, or another strategy"
        )
    if choices.intensities and muscles and files.presets is None:
        raise ParameterError(
            "genes: intensities are kept in presets, and OUT holds the muscles; name a file for "
            "them with --presets-output"
        )
    if files.presets is not None and not (choices.intensities and muscles):
        raise ParameterError(
            "presets-output: is for intensities that are tuned beside muscles; add intensities to "
            "--genes, or leave it out"
        )
    if project.method == "vector":
        return
    if muscles and not choices.mirror:
        raise ParameterError(
            f"no-mirror: {project.method} muscles are drawn once for both sides; only vector "
            "muscles and --genes intensities have sides of their own"
        )
    if way != Way():
        raise ParameterError(
            "from: only vector muscles are carried from another head; a style carries what was "
            f"tuned of {project.method} muscles (--style)"
        )
