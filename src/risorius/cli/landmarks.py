"""`risorius landmarks`: the table of names."""

from __future__ import annotations

from typing import Annotated

import typer

from risorius.cli.options import AsJson, Debug, Quiet
from risorius.cli.talk import talking

__all__ = ["landmarks"]


def landmarks(
    needed: Annotated[
        bool, typer.Option("--needed", help="Only those without which no head is rigged.")
    ] = False,
    json: AsJson = False,
    quiet: Quiet = False,
    debug: Debug = False,
) -> None:
    """List the names of landmarks: MPEG-4 feature points, left and right being the character's.

    Needed are the eyes, the mouth, the chin and the nose; the others make the result better.

    Example:  risorius landmarks --needed
    """
    with talking(json=json, quiet=quiet, debug=debug) as talk:
        from risorius.cli.features import FEATURES, purpose_of
        from risorius.landmarks import feature_points

        required = {name for feature in FEATURES if feature.required for name in feature.names}
        points = [
            point for point in feature_points().values() if not needed or point.name in required
        ]
        talk.put(
            landmarks=[
                {
                    "name": point.name,
                    "side": point.side,
                    "mirror": point.mirror,
                    "part": point.part,
                    "description": point.description,
                    "needed": point.name in required,
                    "serves": list(purpose_of(point.name)),
                }
                for point in points
            ]
        )
        talk.table(
            ("name", "needed", "where", "serves"),
            [
                (
                    point.name,
                    "yes" if point.name in required else "",
                    point.description,
                    ", ".join(purpose_of(point.name)),
                )
                for point in points
            ],
        )
