"""`risorius transfer`: vector muscles of one head for another head."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

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
        from risorius.cli.exporting import Way, as_feature, begin_export, write_vectors
        from risorius.cli.outputs import require_json_output, require_picture_output
        from risorius.cli.sources import Given
        from risorius.cli.tuning_pictures import write_emotions
        from risorius.tuning.style import read_style
        from risorius.vectormuscle.export import export_muscles

        target = require_json_output(output)
        if sheet is not None:
            require_picture_output(sheet)
        worn = read_style(style) if style is not None else None
        given = Given(
            landmarks=landmarks, unit=unit, axes=axes, parts=as_parts(part),
            flip_landmarks=flip_landmarks, profile=profile.value if profile else None,
            presets=presets, vector_set=vectors,
        )  # fmt: skip
        way = Way(
            given,
            from_head,
            from_landmarks,
            as_feature(source_point, "--source-point"),
            as_feature(target_point, "--target-point"),
        )
        export, book = begin_export(head, way, talk)
        with talk.stage("muscles"):
            width = export.features[1].width
            if worn is None:
                carried = export_muscles(export)
            else:
                carried = export_muscles(
                    export,
                    tune=lambda now: worn.applied(
                        now.proposal(now.group.muscles if now.group else ()), width=width
                    ),
                )
                # Muscles outside all groups wear the style as well; it would be lost on others.
                grouped = {name for group in export.groups for name in group.muscles}
                rest = [muscle for muscle in carried.muscles if muscle.name not in grouped]
                carried = carried.replaced(worn.applied(rest, width=width))
                for name in worn.unknown(carried.muscles):
                    talk.note(f"style: no muscle has the parameter {name}")
        write_vectors(carried, target, talk)
        if sheet is not None:
            write_emotions(export.target, carried, book, sheet, talk)
        talk.say_seconds()
