"""`risorius play`: a stream moves a rig."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any, cast

import typer

from risorius.cli.options import (
    AsJson,
    Debug,
    FlipLandmarks,
    LandmarkFile,
    MethodOption,
    Presets,
    ProfileOption,
    Quiet,
    as_size,
)
from risorius.cli.talk import talking

__all__ = ["play"]


def play(
    rig: Annotated[
        str,
        typer.Argument(
            metavar="RIG",
            help="Rig: GLB or glTF with morph targets (also from elsewhere), .npz, a folder of OBJ "
            "files; or a head, project or 'builtin', which gets its shapes on the way.",
            show_default=False,
        ),
    ],
    stream: Annotated[
        Path,
        typer.Argument(
            metavar="STREAM",
            help="Motion: MPEG-4 .fap, Live Link Face or other .csv, .json.",
            show_default=False,
        ),
    ],
    output: Annotated[
        str,
        typer.Option(
            "--output",
            "-o",
            metavar="OUT",
            help="What to make: .glb or .usd* (the rig with the motion as animation), .mp4 (needs "
            "ffmpeg), or a name without ending for a folder of PNG frames.",
            show_default=False,
        ),
    ],
    rate: Annotated[
        float | None,
        typer.Option(metavar="FPS", help="Frames per second.  [default: the stream's own]"),
    ] = None,
    speed: Annotated[float, typer.Option(metavar="TIMES", help="How many times faster.")] = 1.0,
    loops: Annotated[int, typer.Option(metavar="N", help="How often, one after the other.")] = 1,
    easing: Annotated[
        str, typer.Option(metavar="WORD", help="Between frames: linear, smooth or hold.")
    ] = "linear",
    live: Annotated[
        bool,
        typer.Option(
            "--live",
            help="Let the muscles of a head or project move in every frame, with the physics of "
            "its method, instead of a baked rig.",
        ),
    ] = False,
    view: Annotated[
        str, typer.Option(metavar="VIEW", help="View of pictures, such as three-quarter.")
    ] = "front",
    size: Annotated[str, typer.Option(metavar="WxH", help="Size of pictures in pixels.")] = (
        "640x640"
    ),
    metres: Annotated[
        bool, typer.Option("--metres", help="Turn a GLB to metres, +Y up and +Z forward.")
    ] = False,
    method: MethodOption = None,
    profile: ProfileOption = None,
    presets: Presets = None,
    landmarks: LandmarkFile = None,
    flip_landmarks: FlipLandmarks = False,
    json: AsJson = False,
    quiet: Quiet = False,
    debug: Debug = False,
) -> None:
    """Move a rig by a stream of MPEG-4 parameters, ARKit, FACS or viseme weights.

    Names that the rig has are weights of its shapes. MPEG-4 parameters are fitted at the feature
    points, so a rig needs no shapes for them, only landmarks. Shapes that the rig lacks are made of
    its muscles where the presets know how. Turns of the head (fap_48 to fap_50, head_pitch,
    head_yaw, head_roll) turn it as a whole.

    Example:  risorius play head.glb joy.fap -o joy.glb
    """
    with talking(json=json, quiet=quiet, debug=debug) as talk:
        from risorius.cli.motion import open_player, write_motion
        from risorius.cli.sources import Given
        from risorius.playback.pictures import Film
        from risorius.playback.resampling import resampled

        given = Given(
            landmarks=landmarks,
            flip_landmarks=flip_landmarks,
            presets=presets,
            method=method.value if method else None,
            profile=profile.value if profile else None,
        )
        pixels = as_size(size)
        player = open_player(
            rig,
            stream,
            Path(output),
            given,
            talk,
            sampling=lambda found: resampled(
                found, rate=rate, speed=speed, loops=loops, easing=cast(Any, easing)
            ),
            live=live,
        )
        film = Film(view, pixels, player.stream.rate)
        write_motion(player, Path(output), film, talk, metres=metres)
        talk.say_seconds()
