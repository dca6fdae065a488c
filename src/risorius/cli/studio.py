"""`risorius studio`: the browser application."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import replace
from importlib.util import find_spec
from pathlib import Path
from typing import Annotated

import typer

from risorius.cli.options import AsJson, Debug, LandmarkFile, Quiet
from risorius.cli.talk import talking

__all__ = ["studio"]


def studio(
    project: Annotated[
        Path,
        typer.Argument(
            metavar="[PROJECT]",
            help="Project (.json) that holds the work; need not exist yet.",
        ),
    ] = Path("studio.json"),
    head: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE",
            help="Mesh that a new project starts from.  [default: the built-in head]",
            show_default=False,
        ),
    ] = None,
    landmarks: LandmarkFile = None,
    port: Annotated[
        int | None,
        typer.Option(
            min=1, max=65535, metavar="N", help="Port to listen on.  [default: from 8420]"
        ),
    ] = None,
    no_browser: Annotated[
        bool, typer.Option("--no-browser", help="Do not open a browser window.")
    ] = False,
    json: AsJson = False,
    quiet: Quiet = False,
    debug: Debug = False,
) -> None:
    """Design muscles, move the face, tune, play and export in the browser.

    Everything you make is kept in PROJECT at once. The page is served to this machine only and
    needs no network.

    Example:  risorius studio myhead.json --head head.obj
    """
    with talking(json=json, quiet=quiet, debug=debug) as talk:
        if find_spec("nicegui") is None:
            raise ImportError("the studio needs an extra; pip install risorius[studio]")
        from risorius.errors import ParameterError
        from risorius.project import Project
        from risorius.studio.app import Address, free_port, serve

        if head is not None and project.is_file():
            raise ParameterError(
                f"head: {project} exists already and has its head; give another project, or drop "
                "the new head onto the open studio"
            )
        start = replace(Project(), head=head, landmarks=landmarks)
        address = free_port("127.0.0.1", port)

        def ready(where: Address) -> None:
            talk.say(f"studio of {project}: {where.link}")
            talk.say("Ctrl-C ends it; the work is kept")

        with suppress(KeyboardInterrupt):  # the usual way to end it
            serve(project, start, address=address, browser=not no_browser, ready=ready)
        talk.put(project=project, link=address.link)
