"""`risorius compress`: a small rig that does nearly what a large one does."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from risorius.cli.options import AsJson, Debug, FlipLandmarks, LandmarkFile, Presets, Quiet
from risorius.cli.talk import talking

__all__ = ["compress"]


def compress(
    rig: Annotated[
        str,
        typer.Argument(metavar="RIG", help="Rig, head, project or 'builtin'.", show_default=False),
    ],
    output: Annotated[
        str,
        typer.Option(
            "--output",
            "-o",
            metavar="OUT",
            help="Small rig to write: .glb, .usd*, .npz, or a folder of OBJ files. With --stream a "
            "GLB or USD also plays it.",
            show_default=False,
        ),
    ],
    stream: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE",
            help="Motion that matters (.fap, .csv, .json).  [default: every shape by itself]",
            show_default=False,
        ),
    ] = None,
    count: Annotated[
        int | None,
        typer.Option(
            metavar="K",
            min=1,
            help="How many shapes the small rig has.  [default: as --error says]",
            show_default=False,
        ),
    ] = None,
    error: Annotated[
        float | None,
        typer.Option(
            metavar="MM",
            help="As few shapes as keep this error, root mean square over poses and moving "
            "vertices.  [default: 0.1]",
            show_default=False,
        ),
    ] = None,
    weights: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE",
            help="Also write the weights of the small rig that reproduce --stream (.csv, .json).",
            show_default=False,
        ),
    ] = None,
    presets: Presets = None,
    landmarks: LandmarkFile = None,
    flip_landmarks: FlipLandmarks = False,
    json: AsJson = False,
    quiet: Quiet = False,
    debug: Debug = False,
) -> None:
    """Turn a rig into one of few shapes: the principal components of its poses.

    The error is stated for none, one, two ... shapes, so that you can choose. The weights of a
    stream follow for the small rig; they may be negative.

    Example:  risorius compress face.glb --stream joy.fap --count 12 -o small.glb --weights joy.csv
    """
    with talking(json=json, quiet=quiet, debug=debug) as talk:
        from risorius.cli.compressing import Wish, compress_rig
        from risorius.cli.sources import Given

        given = Given(landmarks=landmarks, flip_landmarks=flip_landmarks, presets=presets)
        if count is not None and error is not None:
            raise typer.BadParameter("give either --count or --error", param_hint="--error")
        if weights is not None and stream is None:
            raise typer.BadParameter(
                "needs --stream, whose weights it holds", param_hint="--weights"
            )
        bar = 0.1 if count is None and error is None else error
        compress_rig(rig, given, Wish(output, stream, count, bar, weights), talk)
        talk.say_seconds()
