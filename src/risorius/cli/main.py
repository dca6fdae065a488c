"""The program `risorius` and its verbs."""

from __future__ import annotations

from typing import Annotated

import typer

from risorius import __version__
from risorius.cli import (
    bench,
    blend,
    check,
    clone,
    compare,
    compress,
    convert,
    demo,
    inspect,
    landmarks,
    play,
    project,
    render,
    rig,
    studio,
    transfer,
    tune,
    wrinkles,
)

__all__ = ["app"]

_HELP = """Turn a static 3D head into a blendshape rig that moves by muscles.

To see what it does:  risorius demo

With a head of your own:  risorius check head.obj -l head.landmarks.json,
then  risorius rig head.obj -l head.landmarks.json -o face.glb

Exit codes: 0 done, 1 the input is refused or not fit, 2 the command was written wrongly,
130 interrupted.
"""

app = typer.Typer(
    help=_HELP,
    no_args_is_help=True,
    add_completion=True,
    pretty_exceptions_enable=False,
    rich_markup_mode="markdown",
    context_settings={"help_option_names": ["-h", "--help"]},
)


def _show_version(wanted: bool) -> None:
    if wanted:
        typer.echo(f"risorius {__version__}")
        raise typer.Exit


@app.callback()
def _program(
    version: Annotated[
        bool,
        typer.Option("--version", callback=_show_version, is_eager=True, help="Print the version."),
    ] = False,
) -> None:
    """Hold the options of the program itself."""


app.command("demo")(demo.demo)
app.command("check")(check.check)
app.command("rig")(rig.rig)
app.command("inspect")(inspect.inspect)
app.command("clone")(clone.clone)
app.command("compare")(compare.compare)
app.command("render")(render.render)
app.command("transfer")(transfer.transfer)
app.command("tune")(tune.tune)
app.command("play")(play.play)
app.command("convert")(convert.convert)
app.command("blend")(blend.blend)
app.command("compress")(compress.compress)
app.command("wrinkles")(wrinkles.wrinkles)
app.command("studio")(studio.studio)
app.command("landmarks")(landmarks.landmarks)
app.command("bench")(bench.bench)
app.add_typer(project.app, name="project")
