"""`risorius check`: whether a head is fit, and what is missing."""

from __future__ import annotations

import typer

from risorius.cli.exits import REFUSED
from risorius.cli.options import (
    AsJson,
    Axes,
    Debug,
    FlipLandmarks,
    HeadArgument,
    LandmarkFile,
    Parts,
    Quiet,
    Unit,
    as_parts,
)
from risorius.cli.talk import talking

__all__ = ["check"]


def check(
    head: HeadArgument,
    landmarks: LandmarkFile = None,
    unit: Unit = None,
    axes: Axes = None,
    part: Parts = None,
    flip_landmarks: FlipLandmarks = False,
    json: AsJson = False,
    quiet: Quiet = False,
    debug: Debug = False,
) -> None:
    """Tell whether a head can be rigged, and what is missing.

    Shows what the mesh is made of, the frame and unit found, the parts found, which landmarks
    are there and what the missing ones would serve, and which shapes will be left out and why.
    Ends with exit code 1 if the head cannot be rigged.

    Example:  risorius check head.obj --landmarks head.landmarks.json
    """
    with talking(json=json, quiet=quiet, debug=debug) as talk:
        from risorius.cli.examination import examine
        from risorius.cli.sources import Given, resolve

        given = Given(
            landmarks=landmarks,
            unit=unit,
            axes=axes,
            parts=as_parts(part),
            flip_landmarks=flip_landmarks,
        )
        problem = examine(resolve(head, given), talk)
        talk.put(fit=problem is None)
        if problem is None:
            talk.say("fit: this head can be rigged")
            return
        talk.put(problem=problem)
        talk.say("not fit:")
        talk.say(f"  {problem}")
        if quiet and not json:
            typer.echo(f"risorius: {problem}", err=True)
        raise typer.Exit(REFUSED)
