"""`risorius rig`: a head becomes a rig."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from risorius.cli.options import (
    AsJson,
    Axes,
    BonesOption,
    Debug,
    FlipLandmarks,
    HeadArgument,
    LandmarkFile,
    MandibleFile,
    MethodOption,
    MuscleMapFile,
    Parts,
    Presets,
    ProfileOption,
    Quiet,
    RecipeFile,
    Shapes,
    SkullFile,
    SkullLandmarks,
    StyleFile,
    Unit,
    Vectors,
    as_parts,
)
from risorius.cli.talk import talking

__all__ = ["rig"]


def rig(
    head: HeadArgument,
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
    landmarks: LandmarkFile = None,
    unit: Unit = None,
    axes: Axes = None,
    part: Parts = None,
    flip_landmarks: FlipLandmarks = False,
    method: MethodOption = None,
    profile: ProfileOption = None,
    shapes: Shapes = None,
    presets: Presets = None,
    vectors: Vectors = None,
    muscle_map: MuscleMapFile = None,
    recipe: RecipeFile = None,
    bones: BonesOption = None,
    skull: SkullFile = None,
    mandible: MandibleFile = None,
    skull_landmarks: SkullLandmarks = None,
    style: StyleFile = None,
    sheet: Annotated[
        Path | None,
        typer.Option(metavar="PNG", help="Also draw all shapes on one page.", show_default=False),
    ] = None,
    correctives: Annotated[
        int,
        typer.Option(
            "--correctives",
            metavar="N",
            min=0,
            max=1000,
            help="Add up to N targets pair_A__B, for the pairs of shapes that add up worst; their "
            "weight is the product of those of A and B.",
        ),
    ] = 0,
    animation: Annotated[
        bool,
        typer.Option("--animation", help="Add an animation that shows every shape (GLB, USD)."),
    ] = False,
    metres: Annotated[
        bool,
        typer.Option(
            "--metres",
            help="Let the GLB appear in metres, +Y up, as glTF prescribes; the vertices keep the "
            "numbers of HEAD.",
        ),
    ] = False,
    json: AsJson = False,
    quiet: Quiet = False,
    debug: Debug = False,
) -> None:
    """Turn a head into a blendshape rig.

    The rig has the vertex order, polygons, texture coordinates, unit and axes of HEAD, and as
    morph targets the six emotions, the ARKit shapes and every muscle and joint by itself.

    Example:  risorius rig head.obj --landmarks head.landmarks.json -o face.glb --sheet face.png
    """
    with talking(json=json, quiet=quiet, debug=debug) as talk:
        from risorius.cli.outputs import require_picture_output, require_rig_output
        from risorius.cli.sources import Given, bake_head, resolve
        from risorius.cli.written import say_pairs, write_and_say, write_sheet

        target = require_rig_output(output)
        if sheet is not None:
            require_picture_output(sheet)
        given = Given(
            landmarks=landmarks,
            unit=unit,
            axes=axes,
            parts=as_parts(part),
            flip_landmarks=flip_landmarks,
            method=method.value if method else None,
            profile=profile.value if profile else None,
            shapes=shapes,
            presets=presets,
            vector_set=vectors,
            muscle_map=muscle_map,
            recipe=recipe,
            bones=bones.value if bones else None,
            skull=skull,
            mandible=mandible,
            skull_landmarks=skull_landmarks,
        )
        baked = bake_head(resolve(head, given), talk, correctives=correctives, style=style)
        write_and_say(baked.rig, target, talk, animation=animation, metres=metres)
        if correctives:
            say_pairs(baked.pairs, talk)
        if sheet is not None:
            write_sheet(baked.rig, sheet, talk)
        talk.say_seconds()
