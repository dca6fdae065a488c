"""`risorius convert`: a stream of one standard becomes one of another."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from risorius.cli.options import AsJson, Debug, FlipLandmarks, LandmarkFile, Presets, Quiet
from risorius.cli.talk import talking

__all__ = ["convert"]


def convert(
    stream: Annotated[
        Path,
        typer.Argument(metavar="IN", help="Stream: .fap, .csv or .json.", show_default=False),
    ],
    output: Annotated[
        Path,
        typer.Argument(metavar="OUT", help="Stream: .fap, .csv or .json.", show_default=False),
    ],
    rig: Annotated[
        str,
        typer.Option(
            "--rig",
            metavar="RIG",
            help="Rig that has the shapes of both, head, project or 'builtin'.",
            show_default=False,
        ),
    ],
    to: Annotated[
        str | None,
        typer.Option(
            metavar="SET",
            help="Set of OUT: arkit, fap, facs, emotions, singles, visemes_oculus or "
            "visemes_mpeg4.  [default: fap for .fap, else arkit]",
            show_default=False,
        ),
    ] = None,
    rate: Annotated[
        float | None,
        typer.Option(metavar="FPS", help="Frames per second.  [default: the stream's own]"),
    ] = None,
    presets: Presets = None,
    landmarks: LandmarkFile = None,
    flip_landmarks: FlipLandmarks = False,
    json: AsJson = False,
    quiet: Quiet = False,
    debug: Debug = False,
) -> None:
    """Turn a stream into one of another standard, through a rig.

    The rig is posed as IN says, and the shapes of the wanted set that come nearest to that pose
    are written, with the distance that remains.

    Example:  risorius convert take.csv take.fap --rig head.glb
    """
    with talking(json=json, quiet=quiet, debug=debug) as talk:
        from risorius.cli.motion import open_player, say_error, say_unmatched
        from risorius.cli.sources import Given
        from risorius.errors import FormatError
        from risorius.io.motion import stream_endings, write_stream
        from risorius.playback.conversion import converted
        from risorius.playback.resampling import resampled

        ending = output.suffix.lower()
        if ending not in stream_endings():
            known = " ".join(stream_endings())
            raise FormatError(f"{output}: {ending!r} is no ending of a stream; known: {known}")
        given = Given(landmarks=landmarks, flip_landmarks=flip_landmarks, presets=presets)
        player = open_player(
            rig, stream, None, given, talk, sampling=lambda found: resampled(found, rate=rate)
        )
        wanted = to or ("fap" if ending == ".fap" else "arkit")
        with talk.stage("convert"):
            result, error = converted(player.stream, player.weights, to=wanted)
            count = write_stream(result, output)
        talk.put(output=output, frames=count, rate=result.rate, to=wanted)
        talk.say(f"wrote {output}: {count} frames of {wanted}")
        say_error(error, talk)
        say_unmatched(player, talk)
        talk.say_seconds()
