"""`risorius compare`: how much two rigs of one head differ."""

from __future__ import annotations

from typing import Annotated

import typer

from risorius.cli.options import AsJson, Debug, LandmarkFile, Quiet
from risorius.cli.talk import talking

__all__ = ["compare"]

_RIG = "GLB or glTF with morph targets, .npz, or a folder of OBJ files."


def compare(
    first: Annotated[
        str, typer.Argument(metavar="A", help=f"The true rig: {_RIG}", show_default=False)
    ],
    second: Annotated[
        str, typer.Argument(metavar="B", help=f"The rig to judge: {_RIG}", show_default=False)
    ],
    landmarks: LandmarkFile = None,
    json: AsJson = False,
    quiet: Quiet = False,
    debug: Debug = False,
) -> None:
    """Compare the shapes of two rigs of the same head, by name.

    motion: per cent of the true motion that differs. absolute: equation 6.1 of the thesis about
    the neutral's centroid, per cent. cosine: mean direction, 1 is equal. amplitude: motion of B
    over that of A. rough: unevenness of B over that of A. lost, invented: lip vertices of B that
    move with the wrong lip. gap: how far the lips part [mm]; lids: per cent of the eye still
    open; of B, and of A in the columns with _first.

    Example:  risorius compare truth.glb clone.glb
    """
    with talking(json=json, quiet=quiet, debug=debug) as talk:
        from risorius.cli.clone_words import comparison_rows
        from risorius.cli.sources import load_rig
        from risorius.cloning import compare_rigs

        with talk.stage("read"):
            rigs = [load_rig(path, landmarks) for path in (first, second)]
        with talk.stage("measure"):
            found = compare_rigs(rigs[0], rigs[1])
        talk.put(first=first, second=second, comparison=found.to_json())
        rows = comparison_rows(found)
        talk.table(list(rows[0]), [[_text(value) for value in row.values()] for row in rows])
        mean = sum(shape.motion for shape in found.shapes) / len(found.shapes)
        absolute = sum(shape.absolute for shape in found.shapes) / len(found.shapes)
        talk.put(mean={"motion": mean, "absolute": absolute})
        talk.say(f"mean of {len(rows)} shapes: motion {mean:.3g} %, absolute {absolute:.3g} %")
        for name, missing in (("A", found.only_first), ("B", found.only_second)):
            if missing:
                talk.note(f"only {name} has: {', '.join(missing)}")
        talk.say_seconds()


def _text(value: str | float | None) -> str:
    if value is None:
        return ""
    return f"{value:.3g}" if isinstance(value, float) else str(value)
