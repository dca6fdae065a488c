"""`risorius wrinkles`: normal maps of the wrinkles that a rig's shapes make."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from risorius.cli.options import AsJson, Debug, LandmarkFile, Quiet
from risorius.cli.talk import talking

__all__ = ["wrinkles"]


def wrinkles(
    rig: Annotated[
        str,
        typer.Argument(
            metavar="RIG",
            help="Rig with texture coordinates: GLB or glTF (also from elsewhere), .npz, or a "
            "folder of OBJ files.",
            show_default=False,
        ),
    ],
    output: Annotated[
        Path,
        typer.Option(
            "--output", "-o", metavar="FOLDER", help="Where the maps go.", show_default=False
        ),
    ],
    only: Annotated[
        list[str] | None,
        typer.Option(
            "--map",
            metavar="NAME=A+B",
            help="A map of one's own, for shapes that wrinkle together; repeatable. Left and Right "
            "at the end of a name tell its side.  [default: eight maps for ARKit's shapes]",
            show_default=False,
        ),
    ] = None,
    size: Annotated[int, typer.Option(min=64, max=8192, help="Texels of a map.")] = 2048,
    depth: Annotated[
        float, typer.Option(min=0.0, max=5.0, help="Deeper above 1, for an older face.")
    ] = 1.0,
    spacing: Annotated[
        float, typer.Option(min=0.3, max=5.0, help="Wrinkles farther apart above 1.")
    ] = 1.0,
    sheet: Annotated[
        Path | None,
        typer.Option(
            metavar="PNG", help="Also draw the wrinkled face, map by map.", show_default=False
        ),
    ] = None,
    landmarks: LandmarkFile = None,
    json: AsJson = False,
    quiet: Quiet = False,
    debug: Debug = False,
) -> None:
    """Write normal maps of the wrinkles that the shapes of a rig press into its skin.

    Where a shape presses skin together, lines form across the direction of the pressure: on the
    forehead, between the brows, beside the eyes, around the mouth. Each map is driven by the
    weights of its shapes; wrinkles.json says which, side.png tells left from right.

    Example:  risorius wrinkles face.glb -o wrinkles --sheet wrinkled.png
    """
    with talking(json=json, quiet=quiet, debug=debug) as talk:
        from risorius.cli.outputs import make_folder, require_picture_output
        from risorius.cli.sources import load_rig
        from risorius.errors import ParameterError
        from risorius.render.png import write_png
        from risorius.render.wrinkle_files import write_wrinkles
        from risorius.render.wrinkled import wrinkle_sheet
        from risorius.wrinkles import DEFAULT_GROUPS, parse_group, wrinkle_maps

        groups = [parse_group(text) for text in only] if only else DEFAULT_GROUPS
        make_folder(output)
        picture = require_picture_output(sheet) if sheet is not None else None
        with talk.stage("read"):
            loaded = load_rig(rig, landmarks)
        for group in groups if only else ():
            for shape in group.shapes:
                loaded.target(shape)
        with talk.stage("wrinkles") as tick:
            made = wrinkle_maps(
                loaded, groups, size=size, depth=depth, spacing=spacing, progress=tick
            )
        if not made.maps:
            reasons = "; ".join(f"{name}: {reason}" for name, reason in made.left_out.items())
            raise ParameterError(f"{rig}: no shape wrinkles its skin ({reasons}); see --map")
        with talk.stage("write"):
            files = write_wrinkles(made, output)
        rows = [
            (each.group.name, f"{each.relief.deepest:.2f}", ", ".join(each.group.shapes))
            for each in made.maps
        ]
        talk.put(output=output, files=list(files), left_out=dict(made.left_out))
        talk.say(f"wrote {output}: {len(made.maps)} maps of {made.size} x {made.size} texels")
        talk.table(("map", "deepest [mm]", "driven by"), rows)
        for name, reason in made.left_out.items():
            talk.say(f"left out: {name}: {reason}")
        for each in made.maps:
            if each.overlap > 0.0:
                talk.note(
                    f"{each.group.name}: {100.0 * each.overlap:.0f} % of the wrinkled skin shares "
                    "texels with other skin (mirrored texture?); one place overwrites the other"
                )
        if made.tile != (0, 0):
            talk.note(f"the maps cover tile {made.tile} of the texture space")
        if picture is not None:
            with talk.stage("sheet") as tick:
                write_png(picture, wrinkle_sheet(made, progress=tick))
            talk.put(sheet=picture)
            talk.say(f"wrote {picture}: the wrinkled face")
        talk.say_seconds()
