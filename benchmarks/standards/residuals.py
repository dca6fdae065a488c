"""The page of residuals of the MPEG-4 parameters."""

from __future__ import annotations

import sys
from pathlib import Path

from benchmarks.standards.faces import faces
from risorius.controls.fap import faps
from risorius.playback import FapShape, FapShapes, solve_fap_shapes

__all__ = ["residual_page"]

_HEADING = """# Residuals of the MPEG-4 parameters

How far the feature point of each low-level parameter goes, by head and method: the units that the
solved shape makes (*reach*), and what is missing of 100 units and of the sane bound as a share of
the distance asked. A shape plays any part of its reach exactly. `_neg` is the opposite direction.
Not in the tables: turns of the whole head (48-50), which players make exactly and no shape does;
pupils (29, 30) and the rolled tongue (47), which nothing makes. Made by
`python -m benchmarks.standards residuals --write docs/fap-residuals.md`; see
[standards.md](standards.md).

Parameters of the 66 that are made at all in one direction at least, that make 100 units within a
tenth, and that make the sane bound within a tenth:

"""


def residual_page(methods: tuple[str, ...], data: Path) -> str:
    """Return the whole page as Markdown."""
    found: dict[str, dict[str, FapShapes]] = {}
    for head, method, face in faces(methods, data):
        print(f"{head}, {method} ...", file=sys.stderr, flush=True)
        found.setdefault(head, {})[method] = solve_fap_shapes(face)
    rows = [
        f"| {head} | {method} | {s.made_count} | {s.full_count} | {s.bound_count} |"
        for head, solved in found.items()
        for method, s in solved.items()
    ]
    counts = _table(("head", "method", "made", "100 units", "sane bound"), rows)
    pages = [f"\n## {head}\n\n{_residuals(solved)}" for head, solved in found.items()]
    return _HEADING + counts + "".join(pages)


def _table(columns: tuple[str, ...], rows: list[str]) -> str:
    head = f"| {' | '.join(columns)} |\n|{'---|' * len(columns)}\n"
    return head + "\n".join(rows) + "\n"


def _residuals(solved: dict[str, FapShapes]) -> str:
    columns = ["shape", "name", "bound"]
    for method in solved:
        columns += [f"{method}: reach", "at 100", "at bound"]
    by_name = [{shape.name: shape for shape in each.shapes} for each in solved.values()]
    rows: list[str] = []
    for name, first in by_name[0].items():
        cells = [f"`{name}`", faps()[first.number].name, f"{first.bound:g}"]
        for shapes in by_name:
            cells += _cells(shapes[name])
        rows.append(f"| {' | '.join(cells)} |")
    return _table(tuple(columns), rows)


def _cells(shape: FapShape) -> list[str]:
    return [f"{shape.reach:.0f}", f"{shape.residual_at_100:.2f}", f"{shape.residual_at_bound:.2f}"]
