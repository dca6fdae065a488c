"""What a person sees of a spring muscle while drawing it: grid, influence, jaw, merges, errors.

References
----------
Kaehler, Haber and Seidel 2001, figures 11 and 14.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt

from risorius._check import FloatArray
from risorius.controls.control import Pose
from risorius.springmuscle.binding import bind_muscle
from risorius.springmuscle.face import SpringFace
from risorius.springmuscle.fit import Ground
from risorius.springmuscle.queries import MuscleView, view_muscle
from risorius.studio.drawing.spring_bodies import contracted

__all__ = ["SWITCHES", "Feedback", "feedback_of", "findings", "influence_colours"]

SWITCHES = {
    "grid": ("grid", "the grid as drawn (yellow) and as it was divided (green)"),
    "influenced": ("skin", "the skin that it moves, in green"),
    "jaw": ("jaw", "its points that hang on the jaw, white"),
    "merged": ("merged ends", "where it merges with other muscles"),
    "errors": ("errors", "cells too near to the skin (red) or too deep (blue)"),
}
"""What can be shown: what it is called, and what is seen then."""

_DRAWN, _DIVIDED, _JAW, _MERGED = "#ffd166", "#57d38c", "#ffffff", "#57d38c"
_SHALLOW, _DEEP = "#ff4d4d", "#4d9dff"
_INFLUENCED, _TINT = np.array([70.0, 190.0, 105.0]), 0.7
_ABOVE = 0.6
# Errors below this are none [mm at the reference width]; so few vertices move nothing smoothly.
_VISIBLE, _FEWEST, _FACING = 0.3, 12, 0.5


@dataclass(frozen=True, eq=False)
class Feedback:
    """What the viewport and the panel show of one muscle.

    Parameters
    ----------
    lines, segments, dots : list of dict
        As `Viewport.overlay` wants them.
    facts : str
        Its numbers in one line.
    findings : list of str
        What is wrong, one sentence each.
    """

    lines: list[dict[str, Any]] = field(default_factory=list[dict[str, Any]])
    segments: list[dict[str, Any]] = field(default_factory=list[dict[str, Any]])
    dots: list[dict[str, Any]] = field(default_factory=list[dict[str, Any]])
    facts: str = ""
    findings: list[str] = field(default_factory=list[str])


def feedback_of(face: SpringFace, name: str, pose: Pose, switches: Collection[str]) -> Feedback:
    """Return what is shown of muscle `name` in a pose.

    Parameters
    ----------
    face : SpringFace
    name : str
        With its side; an unknown one gives nothing.
    pose : mapping of str to float
    switches : collection of str
        Those of `SWITCHES` that are on.
    """
    ground = face.ground
    if ground is None or all(each.name != name for each in face.muscles.muscles):
        return Feedback()
    view = view_muscle(face.muscles, name, ground, contracted=contracted(face, pose))
    lines: list[dict[str, Any]] = []
    segments: list[dict[str, Any]] = []
    dots: list[dict[str, Any]] = []
    if "grid" in switches:
        lines += _drawn_lines(view, ground)
        segments.append(_segments(view.grid_lines, _DIVIDED))
    if "merged" in switches:
        lines += [_line(ends, _MERGED) for ends in view.merged]
    if "errors" in switches:
        least = _VISIBLE * ground.surface.scale
        segments.append(_segments(_edges(view.cells[view.near > least]), _SHALLOW))
        segments.append(_segments(_edges(view.cells[view.far > least]), _DEEP))
    if "jaw" in switches:
        dots += [{"at": point.tolist(), "colour": _JAW} for point in view.jaw_points]
    segments = [each for each in segments if each["points"]]
    wrong = findings(view, face, name) if "errors" in switches else []
    return Feedback(lines, segments, dots, _facts(view), wrong)


def findings(view: MuscleView, face: SpringFace, name: str) -> list[str]:
    """Return what is wrong with a fitted muscle and what to do, one sentence each."""
    ground, report = face.ground, view.report
    if ground is None:
        return []
    least, found = _VISIBLE * ground.surface.scale, list[str]()
    for error, what, way in (
        (view.near, "too near to the skin", "move its points over smoother skin"),
        (view.far, "too deep", "add a row, or move its points off the fold"),
    ):
        count = int((error > least).sum())
        if count:
            found.append(f"{_cells(count)} {what}, by {error.max():.1f} mm at worst: {way}.")
    if report.missed:
        points = "1 point finds" if report.missed == 1 else f"{report.missed} points find"
        found.append(
            f"{points} no skin above or too far away, and stays where it was drawn: move the "
            "outline away from folds and edges."
        )
    if report.covered < 0.9:
        found.append(
            f"{1.0 - report.covered:.0%} of it lies below folds or beside the skin: move its "
            "points onto open skin."
        )
    if report.stopped == "limit":
        found.append("It would need more rows than there may be: draw two muscles instead.")
    through = _poking(face, name, ground)
    if through > least:
        found.append(f"It pokes {through:.1f} mm through the skin: make it thinner or lie deeper.")
    if len(view.influenced) < _FEWEST:
        found.append(
            f"It moves {len(view.influenced)} vertices only: make it wider or its radius larger."
        )
    return found


def influence_colours(
    face: SpringFace, name: str, colour: npt.NDArray[np.uint8]
) -> npt.NDArray[np.uint8] | None:
    """Return the skin's colours (n, 3) with the vertices that a muscle moves in green.

    Parameters
    ----------
    face : SpringFace
    name : str
        With its side; None is returned where there is no such muscle.
    colour : (n, 3) uint8
        Without.
    """
    numbers = [k for k, each in enumerate(face.muscles.muscles) if each.name == name]
    if not numbers or face.ground is None:
        return None
    surface = face.ground.surface
    bound = bind_muscle(
        face.muscles, numbers[0], positions=surface.mesh.positions, normals=surface.normals,
        lips=surface.lips,
    )  # fmt: skip
    result = colour.copy()
    mixed = (1.0 - _TINT) * result[bound.vertices] + _TINT * _INFLUENCED
    result[bound.vertices] = mixed.astype(np.uint8)
    return result


def _facts(view: MuscleView) -> str:
    rows, columns = view.grid.shape[:2]
    parts = [
        f"grid {rows} x {columns}", f"{len(view.ellipsoids)} segments",
        f"moves {len(view.influenced)} vertices",
    ]  # fmt: skip
    if len(view.jaw_points):
        parts.append(f"{len(view.jaw_points)} points on the jaw")
    if view.partners:
        names = dict.fromkeys(each.removesuffix("_l").removesuffix("_r") for each in view.partners)
        parts.append(f"merges with {', '.join(name.replace('_', ' ') for name in names)}")
    return ", ".join(parts)


def _cells(count: int) -> str:
    return "1 cell lies" if count == 1 else f"{count} cells lie"


def _poking(face: SpringFace, name: str, ground: Ground) -> float:
    """Return how far the tops of the ellipsoids come out of the skin at most [mm]."""
    muscles, surface = face.muscles, ground.surface
    owner = np.array([each.name == name for each in muscles.muscles])
    own = owner[muscles.segment_muscle]
    normals = muscles.frames[own][:, :, 2]
    tops = muscles.centres[own] + normals * muscles.half_axes[own][:, 2:]
    hits = surface.scene.cast(tops, normals, both_directions=True)
    # Skin that looks elsewhere is a rim or the wall of a fold, not what lies above.
    facing = np.einsum("sk,sk->s", surface.face_normals[np.maximum(hits.face, 0)], normals)
    above = hits.hit & (facing > _FACING)
    return float(np.where(above, -np.nan_to_num(hits.distance), 0.0).max(initial=0.0))


def _drawn_lines(view: MuscleView, ground: Ground) -> list[dict[str, Any]]:
    outline = view.outline + _ABOVE * ground.surface.outwards(view.outline.reshape(-1, 3)).reshape(
        view.outline.shape
    )
    across = [_line(row, _DRAWN) for row in outline]
    return across + [_line(outline[:, column], _DRAWN) for column in range(outline.shape[1])]


def _edges(cells: FloatArray) -> FloatArray:
    """Return the edges (4 q, 2, 3) of cells (q, 4, 3)."""
    return np.stack([cells, np.roll(cells, -1, axis=1)], axis=2).reshape(-1, 2, 3)


def _line(points: FloatArray, colour: str) -> dict[str, Any]:
    return {"points": np.round(points, 3).tolist(), "colour": colour, "width": 0.35}


def _segments(ends: FloatArray, colour: str) -> dict[str, Any]:
    return {"points": np.round(ends, 3).reshape(-1).tolist(), "colour": colour}
