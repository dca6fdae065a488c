"""`risorius blend`: emotions by intensity become a stream or a preset."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from risorius.cli.options import AsJson, Debug, Presets, Quiet, as_weights
from risorius.cli.talk import talking

__all__ = ["blend"]


def blend(
    emotions: Annotated[
        str,
        typer.Argument(
            metavar="EMOTIONS",
            help="Emotions and their intensities from 0 to 1, such as joy=0.6,surprise=0.3.",
            show_default=False,
        ),
    ],
    output: Annotated[
        Path,
        typer.Option(
            "--output",
            "-o",
            metavar="OUT",
            help="Stream to write: .csv, .json or .fap; with --preset a presets file (.json).",
            show_default=False,
        ),
    ],
    onset: Annotated[float, typer.Option(metavar="S", help="Seconds until it is there.")] = 0.4,
    apex: Annotated[float, typer.Option(metavar="S", help="Seconds in which it stays.")] = 1.0,
    offset: Annotated[float, typer.Option(metavar="S", help="Seconds until it is gone.")] = 0.8,
    rate: Annotated[float, typer.Option(metavar="FPS", help="Frames per second.")] = 25.0,
    preset: Annotated[
        str | None,
        typer.Option(
            metavar="NAME",
            help="Write a presets file that has the blend as one more expression of this name, "
            "every muscle within its range, instead of a stream.",
            show_default=False,
        ),
    ] = None,
    presets: Presets = None,
    json: AsJson = False,
    quiet: Quiet = False,
    debug: Debug = False,
) -> None:
    """Blend emotions by intensity, over time or as one expression.

    The stream plays on every rig (`risorius play`); a preset becomes a shape of every rig that is
    made with the file (`risorius rig --presets OUT`).

    Example:  risorius blend joy=0.6,surprise=0.3 -o delight.csv --onset 0.2
    """
    with talking(json=json, quiet=quiet, debug=debug) as talk:
        from risorius.cli.blending import write_blend, write_preset
        from risorius.playback.emotion_timing import Timing

        intensities = as_weights(emotions)
        if preset is not None:
            write_preset(intensities, preset, presets, output, talk)
        else:
            write_blend(intensities, Timing(onset, apex, offset), rate, output, talk)
