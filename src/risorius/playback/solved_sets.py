"""Sets of shapes that are solved on the head, put beside those that presets list."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

from risorius.controls.shape_sets import SOLVED_SETS, ShapeList
from risorius.errors import LandmarkError
from risorius.playback.fap_shapes import solve_fap_shapes
from risorius.rig.face import Face

__all__ = ["with_solved_sets"]

Progress = Callable[[int, int, str], None]


def with_solved_sets(
    shapes: ShapeList, face: Face, sets: Sequence[str], *, progress: Progress | None = None
) -> ShapeList:
    """Return `shapes` and those of `sets` that depend on the head.

    Parameters
    ----------
    shapes : ShapeList
        From the presets.
    face : Face
    sets : sequence of str
        Names of all sets that were asked for.
    progress : callable, optional
        Called with (done, all, name).
    """
    if not set(sets) & set(SOLVED_SETS):
        return shapes
    try:
        solved = solve_fap_shapes(face, progress=progress)
    except LandmarkError as error:
        return replace(shapes, left_out={**shapes.left_out, "fap_*": str(error)})
    thesis = "fap" not in sets
    wanted = solved.poses(thesis=thesis)
    left_out = {
        name: reason
        for name, reason in solved.left_out.items()
        if not (thesis and name.removesuffix(" (in part)").endswith("_neg"))
    }
    poses = {**shapes.poses, **wanted}
    return replace(shapes, poses=poses, left_out={**shapes.left_out, **left_out})
