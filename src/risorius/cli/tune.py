"""`risorius tune`: choose among nine faces until the muscles are right."""

from __future__ import annotations

from enum import StrEnum
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

__all__ = ["tune"]


class StrategyName(StrEnum):
    """How picks become the next nine faces."""

    preference = "preference"
    genetic = "genetic"
    cma = "cma"


class GenesName(StrEnum):
    """Which numbers of a muscle are tuned."""

    published = "published"
    all = "all"


def tune(
    head: HeadArgument,
    output: VectorsOutput,
    expression: Annotated[
        str,
        typer.Option(
            metavar="NAME,...",
            help="Expressions whose muscles are tuned, one after the other in the order joy, "
            "surprise, sadness, anger, fear, disgust.",
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
            "fitted to it.",
            show_default=False,
        ),
    ] = None,
    generations: Annotated[
        int, typer.Option(min=1, max=1000, help="Generations with --target.")
    ] = 15,
    strategy: Annotated[
        StrategyName,
        typer.Option(
            help="preference learns from all picks; genetic is the published way; cma needs an "
            "extra."
        ),
    ] = StrategyName.preference,
    seed: Annotated[int, typer.Option(min=0, help="Another seed shows other faces.")] = 0,
    no_mirror: Annotated[
        bool, typer.Option("--no-mirror", help="Tune left and right by themselves.")
    ] = False,
    genes: Annotated[
        GenesName,
        typer.Option(
            help="published: the ten numbers of each muscle; all: also how skin around it "
            "follows and bulges, which reaches further and shows wilder faces."
        ),
    ] = GenesName.published,
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
    """Carry vector muscles to a head and tune them by choosing.

    Nine faces with the same expression are drawn; you type the numbers of those you like, one to
    three of them, and get the next nine. It works over ssh: look at the picture, type numbers.

    Example:  risorius tune head.obj -l head.landmarks.json -o head.vectors.json --expression joy
    """
    with talking(json=json, quiet=quiet, debug=debug) as talk:
        from risorius.cli.exporting import Way, as_feature, begin_export, write_vectors
        from risorius.cli.outputs import require_json_output, require_picture_output
        from risorius.cli.sources import Given
        from risorius.cli.tuning import TuningChoices, tune_export
        from risorius.tuning.style import Style, read_style, write_style

        goal = require_json_output(output)
        picture = require_picture_output(sheet or goal.with_suffix(".png"))
        if style_output is not None:
            require_json_output(style_output)
        worn = read_style(style) if style is not None else Style()
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
        choices = TuningChoices(
            tuple(name.strip() for name in expression.split(",") if name.strip()),
            picks=picks,
            target=target,
            generations=generations,
            strategy=strategy.value,
            seed=seed,
            mirror=not no_mirror,
            genes=genes.value,
            sheet=picture,
            view=view,
        )
        export, book = begin_export(head, way, talk)
        carried, tuned = tune_export(export, book, worn, choices, talk)
        write_vectors(carried, goal, talk)
        talk.put(style=dict(tuned.parameters), strategy=strategy.value, seed=seed)
        if style_output is not None:
            write_style(tuned, style_output)
            talk.say(f"wrote {style_output}: {len(tuned.parameters)} tuned parameters")
        talk.say_seconds()
