"""`risorius inspect`: how good every shape of a rig is."""

from __future__ import annotations

from typing import Annotated

import typer

from risorius.cli.exits import REFUSED
from risorius.cli.options import AsJson, Debug, LandmarkFile, Quiet
from risorius.cli.talk import talking

__all__ = ["inspect"]


def inspect(
    rig: Annotated[
        str,
        typer.Argument(
            metavar="RIG",
            help="Rig: GLB or glTF with morph targets (also from elsewhere), .npz, or a folder of "
            "OBJ files.",
            show_default=False,
        ),
    ],
    landmarks: LandmarkFile = None,
    together: Annotated[
        list[str] | None,
        typer.Option(
            "--sum",
            metavar="A+B",
            help="Also measure shapes added up, as engines do: A+B, A=0.5+B; repeatable. 'played' "
            "stands for sums that takes of real faces are full of, such as a blink while looking "
            "aside.",
            show_default=False,
        ),
    ] = None,
    sort: Annotated[
        str | None,
        typer.Option(
            metavar="COLUMN",
            help="Sort the shapes by a column, largest first, such as added.",
            show_default=False,
        ),
    ] = None,
    bar: Annotated[
        list[str] | None,
        typer.Option(
            metavar="COLUMN=LIMIT",
            help="Largest value that passes, such as added=1.5; repeatable.  "
            "[default: lost=0 invented=0 cracks=0]",
            show_default=False,
        ),
    ] = None,
    json: AsJson = False,
    quiet: Quiet = False,
    debug: Debug = False,
) -> None:
    """Measure every shape of a rig, also of a rig made elsewhere.

    moved: vertices that move; largest, mean: how far; percent: largest over the head's size.
    lost, invented: lip vertices that move with the wrong lip. gap: how far the lips part,
    opening: the same over the chin's travel. depth, added, into: how deep skin lies in teeth or
    eyeballs, how much of that the shape adds, and where. lid_l, lid_r: per cent of the eye still
    open. inverted, collapsed, stretched: triangles; inside: such triangles where nobody sees
    them. cracks: seams that open. drift: motion of what must rest. asymmetry: per cent between
    left and right.

    Ends with exit code 1 if a shape is beyond a limit of --bar.

    Example:  risorius inspect face.glb --sort added
    """
    with talking(json=json, quiet=quiet, debug=debug) as talk:
        from risorius.cli.quality_table import beyond, limits, show
        from risorius.cli.sources import load_rig
        from risorius.rig.quality import inspect_rig, played_sums, with_sums

        bars = limits(bar)
        with talk.stage("read"):
            loaded = load_rig(rig, landmarks)
        wanted = together or []
        sums = [text for text in wanted if text != "played"]
        if len(sums) < len(wanted):
            sums.extend(played_sums(loaded))
        loaded = with_sums(loaded, sums)
        with talk.stage("measure") as tick:
            report = inspect_rig(loaded, progress=tick)
        for note in report.notes:
            talk.note(note)
        talk.put(rig=rig, report=report.to_json())
        talk.say(f"{rig}: {len(report.shapes)} shapes, {report.vertex_count} vertices")
        show(report, talk, sort=sort)
        failed = beyond(report, bars)
        talk.put(bar=bars, beyond=failed)
        for text in failed:
            talk.say(f"beyond the bar: {text}")
        talk.say_seconds()
        if failed:
            raise typer.Exit(REFUSED)
