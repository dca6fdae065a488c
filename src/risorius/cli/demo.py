"""`risorius demo`: the built-in head becomes a rig, with pictures."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from risorius.cli.options import AsJson, Debug, Quiet
from risorius.cli.talk import talking

__all__ = ["demo"]

_POSES = ("", "joy", "surprise", "jawOpen", "eyeBlinkLeft")
_VIEWS = ("front", "three-quarter", "profile", "mouth", "eyes")


def demo(
    output: Annotated[
        Path,
        typer.Option(
            "--output", "-o", metavar="FOLDER", help="Folder for the results; made if missing."
        ),
    ] = Path("risorius-demo"),
    json: AsJson = False,
    quiet: Quiet = False,
    debug: Debug = False,
) -> None:
    """Turn the head that ships with risorius into a rig, with pictures of all its shapes.

    Writes demo.glb (the rig, with an animation), sheet.png (every shape) and views.png (some
    expressions from all sides).

    Example:  risorius demo -o out
    """
    with talking(json=json, quiet=quiet, debug=debug) as talk:
        from risorius.cli.outputs import (
            make_folder,
            require_picture_output,
            require_rig_output,
        )
        from risorius.cli.sources import bake_head
        from risorius.cli.written import size_of, write_and_say, write_sheet
        from risorius.project import Project
        from risorius.render.png import write_png
        from risorius.render.rig_sheet import view_sheet

        make_folder(output)
        target = require_rig_output(str(output / "demo.glb"))
        sheet = require_picture_output(output / "sheet.png")
        views = require_picture_output(output / "views.png")
        baked = bake_head(Project(), talk)
        write_and_say(baked.rig, target, talk, animation=True, metres=True)
        write_sheet(baked.rig, sheet, talk)
        known = baked.rig.by_name
        poses = {
            name or "neutral": {name: 1.0} if name else {}
            for name in _POSES
            if not name or name in known
        }
        with talk.stage("views") as tick:
            write_png(views, view_sheet(baked.rig, poses, _VIEWS, cell=260, progress=tick))
        talk.put(views=views)
        talk.say(f"wrote {views}: expressions from all sides, {size_of(views)}")
        talk.say_seconds()
        talk.say()
        talk.say(f"Look at {sheet} first. {target} opens in Blender (File > Import > glTF, then")
        talk.say("Object Data > Shape Keys), in any three.js or glTF viewer, Unity and Unreal.")
        talk.say(f"Next: risorius inspect {target}")
