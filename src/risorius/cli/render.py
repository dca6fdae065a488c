"""`risorius render`: pictures of a head or of a rig."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from risorius.cli.options import (
    AsJson,
    Debug,
    FlipLandmarks,
    LandmarkFile,
    Quiet,
    as_size,
    as_weights,
)
from risorius.cli.talk import talking

__all__ = ["render"]


def render(
    subject: Annotated[
        str,
        typer.Argument(
            metavar="RIG_OR_HEAD",
            help="Rig (GLB, .npz, folder of OBJ files), head (OBJ, PLY, STL), project (.json) or "
            "'builtin'.",
            show_default=False,
        ),
    ],
    output: Annotated[
        Path,
        typer.Option("--output", "-o", metavar="PNG", help="Picture to write.", show_default=False),
    ],
    view: Annotated[
        str,
        typer.Option(
            metavar="VIEW,...",
            help="front, three-quarter, profile, face, mouth or eyes; several make one page.",
        ),
    ] = "front",
    yaw: Annotated[
        float | None,
        typer.Option(
            help="Turn of the camera in degrees, positive to the character's left.",
            show_default=False,
        ),
    ] = None,
    pitch: Annotated[
        float | None,
        typer.Option(help="Lift of the camera in degrees.", show_default=False),
    ] = None,
    pose: Annotated[
        str | None,
        typer.Option(
            metavar="NAME=WEIGHT,...",
            help="Shapes to show, such as joy=0.8,jawOpen=0.3.",
            show_default=False,
        ),
    ] = None,
    sheet: Annotated[
        bool, typer.Option("--sheet", help="Draw every shape on one page instead.")
    ] = False,
    size: Annotated[
        str, typer.Option(metavar="WxH", help="Size of the picture in pixels.")
    ] = "800x800",
    landmarks: LandmarkFile = None,
    flip_landmarks: FlipLandmarks = False,
    json: AsJson = False,
    quiet: Quiet = False,
    debug: Debug = False,
) -> None:
    """Draw a head or a rig.

    A head without shapes that is to be posed gets them on the way, as `risorius rig` would make
    them. For a turntable, call it with --yaw 0, 10, 20 ...

    Example:  risorius render face.glb -o smile.png --pose joy=1 --view three-quarter
    """
    with talking(json=json, quiet=quiet, debug=debug) as talk:
        from risorius.cli.outputs import require_picture_output
        from risorius.cli.pictures import Shot, draw, subject_of
        from risorius.cli.sources import Given
        from risorius.cli.written import size_of, write_sheet

        require_picture_output(output)
        shot = Shot(
            views=tuple(name.strip() for name in view.split(",") if name.strip()),
            weights=as_weights(pose),
            size=as_size(size),
            yaw=yaw,
            pitch=pitch,
        )
        given = Given(landmarks=landmarks, flip_landmarks=flip_landmarks)
        rig = subject_of(subject, given, talk, needs=None if sheet else tuple(shot.weights))
        if sheet:
            write_sheet(rig, output, talk)
            return
        with talk.stage("draw") as tick:
            draw(rig, shot, output, tick)
        talk.put(output=output, view=list(shot.views), pose=shot.weights, size=list(shot.size))
        talk.say(f"wrote {output}: {size_of(output)}")
