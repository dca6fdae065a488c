"""`risorius bench`: how fast the solver is on this machine."""

from __future__ import annotations

from typing import Annotated, Any

import typer

from risorius.cli.options import AsJson, Debug, Quiet
from risorius.cli.talk import talking

__all__ = ["bench"]

# Vertices of the head whose poses are brought to rest: the thesis's largest.
_SETTLED = 4904


def bench(
    sizes: Annotated[
        str,
        typer.Option(
            "--sizes", help="Vertex counts, with commas; default: the thesis's heads and two more."
        ),
    ] = "",
    rounds: Annotated[int, typer.Option("--rounds", min=1, help="Rounds; the fastest counts.")] = 9,
    json: AsJson = False,
    quiet: Quiet = False,
    debug: Debug = False,
) -> None:
    """Measure the position-based solver against its scalar reference, and pypbd if installed.

    Times are milliseconds of one processor for one iteration and pose, all ways in turns in one
    run; the ratios hold also on a busy machine.

    Example:  risorius bench --sizes 1466,4904
    """
    with talking(json=json, quiet=quiet, debug=debug) as talk:
        from risorius.errors import ParameterError
        from risorius.solvers.bench import SIZES, run, settle_all

        try:
            counts = [int(word) for word in sizes.split(",")] if sizes else list(SIZES)
        except ValueError:
            raise ParameterError(
                f"sizes: {sizes!r} must be whole numbers with commas, for example 1466,4904"
            ) from None
        measured: dict[str, Any] = {}
        with talk.stage("measure") as tick:
            for done, count in enumerate(counts):
                tick(done, len(counts), f"{count} vertices")
                measured |= run([count], rounds=rounds)
        with talk.stage("settle"):
            settled = settle_all(min(max(counts), _SETTLED))
        talk.put(sizes=measured, settled=settled)
        talk.table(
            ("vertices", "constraints", "way", "ms", "ns/constraint", "times faster", "MB"),
            [
                (
                    str(size["vertex_count"]),
                    str(size["constraint_count"]),
                    name,
                    f"{way['milliseconds']:.4f}",
                    f"{way['nanoseconds_per_constraint']:.2f}",
                    f"{way['times_faster_than_scalar']:.1f}",
                    f"{size['megabytes'][name]:.1f}" if name in size["megabytes"] else "",
                )
                for size in measured.values()
                for name, way in size["ways"].items()
            ],
        )
        talk.say(
            f"{settled['pose_count']} poses of {settled['vertex_count']} vertices settle in "
            f"{settled['seconds']:.2f} s ({settled['sweeps']} sweeps)"
        )
