"""`risorius tune`: choose among nine faces until the muscles are right."""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from risorius.cli.options import (
    AsJson,
    Axes,
    BonesOption,
    Debug,
    FlipLandmarks,
    FromHead,
    FromLandmarks,
    HeadArgument,
    LandmarkFile,
    MandibleFile,
    Method,
    MuscleMapFile,
    Parts,
    Presets,
    ProfileOption,
    Quiet,
    RecipeFile,
    SkullFile,
    SkullLandmarks,
    SourcePoints,
    StyleFile,
    TargetPoints,
    Unit,
    Vectors,
    as_parts,
    as_weights,
)
from risorius.cli.talk import talking

__all__ = ["tune"]


class StrategyName(StrEnum):
    """How picks become the next nine faces."""

    preference = "preference"
    genetic = "genetic"
    cma = "cma"
    least_squares = "least-squares"


def method_of(given: Method | None, head: str) -> str | None:
    """Return the method to tune: the one given, a project's own, else vector muscles."""
    if given is not None:
        return given.value
    return None if head.lower().endswith(".json") else Method.vector.value


def tune(
    head: HeadArgument,
    output: Annotated[
        Path,
        typer.Option(
            "--output",
            "-o",
            metavar="OUT",
            help="What was tuned (.json): a vector set, muscle map or outline recipe, for "
            "--vectors, --muscle-map or --recipe of `risorius rig`; presets with "
            "--genes intensities.",
            show_default=False,
        ),
    ],
    method: Annotated[
        Method | None,
        typer.Option(
            "--method",
            "-m",
            help="Method whose muscles are tuned.  [default: vector, or that of a project]",
            show_default=False,
        ),
    ] = None,
    expression: Annotated[
        str,
        typer.Option(
            metavar="NAME,...",
            help="Expressions whose muscles are tuned, one after the other in the order joy, "
            "surprise, sadness, anger, fear, disgust, then others of the presets.",
        ),
    ] = "joy",
    picks: Annotated[
        str,
        typer.Option(
            metavar="HOW",
            help="contact-sheet: write nine faces to a picture and ask for numbers. Or the answers "
            "themselves, such as '1,4,7;2,3', generations separated by semicolons.",
        ),
    ] = "contact-sheet",
    target: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE",
            help="HEAD sculpted in the expression, same vertices: nobody is asked, the muscles are "
            "fitted to it. OBJ, PLY, GLB or NPZ, or a rig that has the shape.",
            show_default=False,
        ),
    ] = None,
    target_shape: Annotated[
        str | None,
        typer.Option(
            metavar="NAME=WEIGHT,...",
            help="Shape of the rig --target, or several that add up, such as "
            "mouthSmileLeft,mouthSmileRight.  [default: the expression]",
            show_default=False,
        ),
    ] = None,
    generations: Annotated[
        int, typer.Option(min=1, max=1000, help="Generations with --target, at most.")
    ] = 15,
    strategy: Annotated[
        StrategyName | None,
        typer.Option(
            help="preference learns from all picks; genetic is the published way; cma needs an "
            "extra; least-squares is for --target.  [default: preference, least-squares with "
            "--target]",
            show_default=False,
        ),
    ] = None,
    seed: Annotated[int, typer.Option(min=0, help="Another seed shows other faces.")] = 0,
    no_mirror: Annotated[
        bool, typer.Option("--no-mirror", help="Tune left and right by themselves.")
    ] = False,
    genes: Annotated[
        str,
        typer.Option(
            metavar="NAME,...",
            help="published: the numbers that a publication gives a muscle; all: also how skin "
            "around it follows and bulges, which reaches further and shows wilder faces; "
            "intensities, alone or behind a comma: how far the controls of the expression go.",
        ),
    ] = "published",
    presets_output: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE",
            help="Where tuned intensities go, for --presets of `risorius rig`; needed where OUT "
            "holds muscles.",
            show_default=False,
        ),
    ] = None,
    style: StyleFile = None,
    style_output: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE",
            help="Write what was tuned, for --style of the next head.",
            show_default=False,
        ),
    ] = None,
    sheet: Annotated[
        Path | None,
        typer.Option(
            metavar="PNG",
            help="The picture of nine faces.  [default: OUT with the ending .png]",
            show_default=False,
        ),
    ] = None,
    view: Annotated[str, typer.Option(metavar="VIEW", help="As in `risorius render`.")] = "face",
    from_head: FromHead = "builtin",
    from_landmarks: FromLandmarks = None,
    vectors: Vectors = None,
    muscle_map: MuscleMapFile = None,
    recipe: RecipeFile = None,
    bones: BonesOption = None,
    skull: SkullFile = None,
    mandible: MandibleFile = None,
    skull_landmarks: SkullLandmarks = None,
    landmarks: LandmarkFile = None,
    unit: Unit = None,
    axes: Axes = None,
    part: Parts = None,
    flip_landmarks: FlipLandmarks = False,
    profile: ProfileOption = None,
    presets: Presets = None,
    source_point: SourcePoints = None,
    target_point: TargetPoints = None,
    json: AsJson = False,
    quiet: Quiet = False,
    debug: Debug = False,
) -> None:
    """Tune the muscles of a head by choosing.

    Nine faces with the same expression are drawn; you type the numbers of those you like, one to
    three of them, and get the next nine. It works over ssh: look at the picture, type numbers.
    Vector muscles, the method unless --method names another, are carried to HEAD first.

    Example:  risorius tune head.obj -l head.landmarks.json -o head.vectors.json --expression joy
    """
    with talking(json=json, quiet=quiet, debug=debug) as talk:
        from risorius.cli.exporting import Way
        from risorius.cli.outputs import require_json_output, require_picture_output
        from risorius.cli.sources import Given, resolve
        from risorius.cli.tuning import TuningChoices, as_genes
        from risorius.cli.tuning_run import Target, TuningFiles, run_tuning

        goal = require_json_output(output)
        for other in (style_output, presets_output):
            if other is not None:
                require_json_output(other)
        muscles, intensities = as_genes(genes)
        given = Given(
            landmarks=landmarks, unit=unit, axes=axes, parts=as_parts(part),
            flip_landmarks=flip_landmarks, method=method_of(method, head),
            profile=profile.value if profile else None, presets=presets, vector_set=vectors,
            muscle_map=muscle_map, recipe=recipe, bones=bones.value if bones else None,
            skull=skull, mandible=mandible, skull_landmarks=skull_landmarks,
        )  # fmt: skip
        choices = TuningChoices(
            tuple(name.strip() for name in expression.split(",") if name.strip()),
            picks=picks,
            generations=generations,
            strategy=strategy.value if strategy else None,
            seed=seed,
            mirror=not no_mirror,
            genes=muscles,
            intensities=intensities,
            sheet=require_picture_output(sheet or goal.with_suffix(".png")),
            view=view,
        )
        files = TuningFiles(goal, presets_output, style_output, style)
        way = Way(from_head, from_landmarks, source_point, target_point)
        shapes = as_weights(target_shape, option="--target-shape")
        goal_shape = Target(target, shapes) if target is not None else None
        run_tuning(resolve(head, given), choices, files, talk, way=way, target=goal_shape)
        talk.say_seconds()
