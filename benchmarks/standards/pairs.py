"""What corrective pairs of ARKit shapes bring."""

from __future__ import annotations

import sys
import time
from pathlib import Path

from benchmarks.standards.faces import faces
from risorius.controls import default_presets, list_shapes
from risorius.playback.pairs import find_pairs

__all__ = ["pair_tables"]

_BUDGET = 20


def pair_tables(methods: tuple[str, ...], data: Path) -> str:
    """Return a table of the best pairs for each head and method."""
    pages: list[str] = []
    for head, method, face in faces(methods, data):
        print(f"{head}, {method} ...", file=sys.stderr, flush=True)
        shapes = list_shapes(face.controls, default_presets(), sets=("arkit",))
        begun = time.process_time()
        found = find_pairs(face, shapes.poses, budget=_BUDGET, upon=shapes.upon)
        seconds = time.process_time() - begun
        rows = [
            f"| {pair.first}, {pair.second} | {pair.before:.2f} | {pair.after:.2f} | "
            f"{pair.largest:.1f} |"
            for pair in found
        ]
        pages.append(
            f"{head}, {method} ({seconds:.1f} s of one core):\n\n"
            "| pair | sum [mm] | with the corrective [mm] | largest [mm] |\n|---|---|---|---|\n"
            + "\n".join(rows)
        )
    return "\n\n".join(pages) + "\n"
