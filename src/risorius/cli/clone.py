"""`risorius clone`: the shapes of one head, on another."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from risorius.cli.options import (
    AsJson,
    Axes,
    Debug,
    FlipLandmarks,
    Parts,
    ProfileOption,
    Quiet,
    Unit,
    as_parts,
)
from risorius.cli.talk import talking

__all__ = ["clone"]


def clone(
    source: Annotated[
        str,
        typer.Argument(
            metavar="SOURCE",
            help="Rig with the shapes: GLB or glTF with morph targets, .npz, or a folder with "
            "neutral.obj and one OBJ file per shape.",
            show_default=False,
        ),
    ],
    target: Annotated[
        str,
        typer.Argument(
            metavar="TARGET",
            help="Head that shall have them: mesh, project (.json), or 'builtin'.",
            show_default=False,
        ),
    ],
    output: Annotated[
        str,
        typer.Option(
            "--output",
            "-o",
            metavar="OUT",
            help="Rig to write: .glb, .usd, .usda, .usdc or .npz; a name without ending makes a "
            "folder with one OBJ file per shape.",
            show_default=False,
        ),
    ],
    source_landmarks: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE",
            help="Named points of SOURCE.  [default: those that it carries]",
            show_default=False,
        ),
    ] = None,
    target_landmarks: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE",
            help="Named points of TARGET.  [default: those that it carries, or its name with the "
            "ending .landmarks.json]",
            show_default=False,
        ),
    ] = None,
    profile: ProfileOption = None,
    local_scale: Annotated[
        float | None,
        typer.Option(
            metavar="SHARE",
            help="How far motion follows the local size and turn of the features, 0 to 1.  "
            "[default: 0, one scale for the whole head]",
            show_default=False,
        ),
    ] = None,
    absolute: Annotated[
        bool,
        typer.Option(
            "--absolute",
            help="Put vertices on the deformed source, as published, instead of adding motion.",
        ),
    ] = False,
    sheet: Annotated[
        Path | None,
        typer.Option(metavar="PNG", help="Also draw all shapes on one page.", show_default=False),
    ] = None,
    unit: Unit = None,
    axes: Axes = None,
    part: Parts = None,
    flip_landmarks: FlipLandmarks = False,
    json: AsJson = False,
    quiet: Quiet = False,
    debug: Debug = False,
) -> None:
    """Copy all shapes of one head onto another of any topology.

    Both heads need landmarks with the same names. The clone has the vertex order, polygons, unit
    and axes of TARGET. --unit, --axes, --part and --flip-landmarks speak of TARGET.

    Example:  risorius clone actor.glb hero.obj --target-landmarks hero.landmarks.json -o hero.glb
    """
    with talking(json=json, quiet=quiet, debug=debug) as talk:
        from dataclasses import replace

        from risorius.cli.clone_words import report_lines
        from risorius.cli.outputs import require_picture_output, require_rig_output
        from risorius.cli.sources import Given, load_rig, read_head, resolve
        from risorius.cli.written import write_and_say, write_sheet
        from risorius.cloning import clone_parameters, clone_with_report

        path = require_rig_output(output)
        if sheet is not None:
            require_picture_output(sheet)
        settings = clone_parameters(profile.value if profile else "improved")
        if local_scale is not None:
            settings = replace(settings, local_scale=local_scale)
        if absolute:
            settings = replace(settings, form="absolute")
        given = Given(
            landmarks=target_landmarks,
            unit=unit,
            axes=axes,
            parts=as_parts(part),
            flip_landmarks=flip_landmarks,
        )
        head = read_head(resolve(target, given), talk)
        with talk.stage("read"):
            rig = load_rig(source, source_landmarks)
        talk.say(f"{source}: {rig.mesh.vertex_count} vertices, {len(rig.targets)} shapes")
        with talk.stage("clone") as tick:
            made = clone_with_report(rig, head, parameters=settings, progress=tick)
        for note in made.report.notes:
            talk.note(note)
        talk.put(source=source, target=target, report=made.report.to_json())
        for line in report_lines(made.report):
            talk.say(f"  {line}")
        write_and_say(made.rig, path, talk)
        if sheet is not None:
            write_sheet(made.rig, sheet, talk)
        talk.say_seconds()
