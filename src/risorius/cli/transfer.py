"""`risorius transfer`: vector muscles of one head for another head."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from risorius.cli.options import (
    AsJson,
    Axes,
    Debug,
    FlipLandmarks,
    FromHead,
    FromLandmarks,
    HeadArgument,
    LandmarkFile,
    Parts,
    Presets,
    ProfileOption,
    Quiet,
    SourcePoints,
    StyleFile,
    TargetPoints,
    Unit,
    Vectors,
    VectorsOutput,
    as_parts,
)
from risorius.cli.talk import talking

if TYPE_CHECKING:
    from risorius.vectormuscle.muscle import VectorMuscle

__all__ = ["transfer"]


def transfer(
    head: HeadArgument,
    output: VectorsOutput,
    from_head: FromHead = "builtin",
    from_landmarks: FromLandmarks = None,
    vectors: Vectors = None,
    style: StyleFile = None,
    landmarks: LandmarkFile = None,
    unit: Unit = None,
    axes: Axes = None,
    part: Parts = None,
    flip_landmarks: FlipLandmarks = False,
    profile: ProfileOption = None,
    presets: Presets = None,
    source_point: SourcePoints = None,
    target_point: TargetPoints = None,
    sheet: Annotated[
        Path | None,
        typer.Option(
            metavar="PNG",
            help="Also draw the six emotions on HEAD with the muscles carried.",
            show_default=False,
        ),
    ] = None,
    json: AsJson = False,
    quiet: Quiet = False,
    debug: Debug = False,
) -> None:
    """Carry vector muscles from one head to another.

    Ten feature points are found on both heads; a network trained on them and on the landmarks
    that both have carries the muscles. The result is a vector set for --vectors of
    `risorius rig`. To correct it by eye afterwards, use `risorius tune`.

    Example:  risorius transfer head.obj -l head.landmarks.json -o head.vectors.json
    """
    with talking(json=json, quiet=quiet, debug=debug) as talk:
        from risorius.cli.exporting import (
            Way,
            begin_export,
            tuned_expressions,
            write_vectors,
        )
        from risorius.cli.outputs import require_json_output, require_picture_output
        from risorius.cli.sources import Given, resolve
        from risorius.cli.tuning_pictures import write_emotions
        from risorius.project import presets_of
        from risorius.project.styled import unknown_of
        from risorius.tuning.style import Style, read_style
        from risorius.vectormuscle.export import export_muscles

        goal = require_json_output(output)
        if sheet is not None:
            require_picture_output(sheet)
        worn = read_style(style) if style is not None else Style()
        worn.require_method("vector", source=str(style))
        given = Given(
            landmarks=landmarks, unit=unit, axes=axes, parts=as_parts(part),
            flip_landmarks=flip_landmarks, method="vector",
            profile=profile.value if profile else None, presets=presets, vector_set=vectors,
        )  # fmt: skip
        project = resolve(head, given)
        way = Way(from_head, from_landmarks, source_point, target_point)
        first = tuned_expressions(project, worn)
        export = begin_export(project, way, talk, first=first)
        width = export.features[1].width
        for name in unknown_of(project, worn):
            talk.note(f"style: no muscle or preset has the parameter {name}")

        def wear(muscles: Iterable[VectorMuscle]) -> tuple[VectorMuscle, ...]:
            return worn.on_vectors(muscles, width=width)

        with talk.stage("muscles"):
            if worn.parameters:
                carried = export_muscles(
                    export,
                    tune=lambda now: wear(now.proposal(now.group.muscles if now.group else ())),
                    finish=wear,
                )
            else:
                carried = export_muscles(export)
        write_vectors(carried, goal, talk)
        if sheet is not None:
            write_emotions(
                export.target, carried, worn.on_presets(presets_of(project)), sheet, talk
            )
        talk.say_seconds()
