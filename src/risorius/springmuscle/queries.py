"""What an editor of muscles asks: a muscle refitted while it is dragged, and arrays to draw."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from risorius._check import FloatArray, IntArray
from risorius.errors import ParameterError
from risorius.springmuscle.binding import bind_muscle
from risorius.springmuscle.contraction import Contracted
from risorius.springmuscle.ellipsoid import Ellipsoids
from risorius.springmuscle.fit import Ground, fit_muscle, mirrored
from risorius.springmuscle.merging import merge_muscles
from risorius.springmuscle.muscle import JAW, FitReport
from risorius.springmuscle.muscle_set import MuscleSet
from risorius.springmuscle.recipe import MuscleOutline

__all__ = ["MuscleView", "refit", "view_muscle"]


@dataclass(frozen=True, eq=False)
class MuscleView:
    """One muscle as an editor draws it (Kaehler et al. 2001, figures 11 and 14).

    Parameters
    ----------
    outline : (a, b, 3) float64
        The grid as drawn, on the skin [mm].
    grid : (r, c, 3) float64
        The refined grid, in the middle of the muscle [mm].
    grid_lines : (k, 2, 3) float64
        Its edges [mm].
    ellipsoids : (s, 4, 4) float64
        Take the unit sphere to each ellipsoid, as instanced drawing wants it [mm].
    influenced : (v,) int32
        Skin vertices that the muscle moves.
    jaw_points : (j, 3) float64
        Control points that hang on the jaw [mm].
    merged : (l, 2, 3) float64
        Lines between segments that are merged, from middle to middle [mm].
    partners : tuple of str
        Muscles that it is merged with.
    cells : (q, 4, 3) float64
        Corners of the grid's cells, around each [mm].
    near, far, thickness : (q,) float64
        Errors and thickness of the cells [mm].
    report : FitReport
    """

    outline: FloatArray
    grid: FloatArray
    grid_lines: FloatArray
    ellipsoids: FloatArray
    influenced: IntArray
    jaw_points: FloatArray
    merged: FloatArray
    partners: tuple[str, ...]
    cells: FloatArray
    near: FloatArray
    far: FloatArray
    thickness: FloatArray
    report: FitReport


def refit(muscles: MuscleSet, outline: MuscleOutline, ground: Ground) -> MuscleSet:
    """Fit one changed outline and merge anew; all other muscles stay as they are.

    Parameters
    ----------
    muscles : MuscleSet
    outline : MuscleOutline
        Named with its side, as `OutlineRecipe.sided` returns it; or a paired outline of a recipe,
        which refits both sides. The drawn outline is never changed by a fit.
    ground : Ground
        That the muscles were fitted to.

    Raises
    ------
    LandmarkError, ParameterError
        If there is no such muscle, or the outline cannot be laid on this head.
    """
    outlines = (outline.sided(1), outline.sided(-1)) if outline.mirror else (outline,)
    places = {muscle.name: number for number, muscle in enumerate(muscles.muscles)}
    changed = list(muscles.muscles)
    left = None
    for one in outlines:
        if one.name not in places:
            raise ParameterError(
                f"muscles: no {one.name!r} to refit; there are {', '.join(sorted(places))}"
            )
        twin = left is not None and ground.symmetric
        fitted = mirrored(left, one) if twin and left is not None else fit_muscle(one, ground)
        left = fitted if len(outlines) == 2 else None
        changed[places[one.name]] = fitted
    if not ground.parameters.merge:
        return MuscleSet(tuple(changed))
    return merge_muscles(tuple(changed), yielding=ground.parameters.yielding)


def view_muscle(
    muscles: MuscleSet, name: str, ground: Ground, *, contracted: Contracted | None = None
) -> MuscleView:
    """Return what is drawn of muscle `name`, relaxed or as `contracted`.

    Raises
    ------
    ParameterError
        If there is no such muscle.
    """
    names = [muscle.name for muscle in muscles.muscles]
    if name not in names:
        raise ParameterError(f"muscles: no {name!r}; there are {', '.join(names)}")
    number = names.index(name)
    muscle = muscles.muscles[number]
    own = muscles.segment_muscle == number
    solids = Ellipsoids.of(muscles, contracted)
    points = muscles.points if contracted is None else contracted.points
    lines, partners = _merged(muscles, number, solids.centres)
    surface, report = ground.surface, muscle.report
    binding = bind_muscle(
        muscles, number, positions=surface.mesh.positions, normals=surface.normals,
        lips=surface.lips,
    )  # fmt: skip
    on_jaw = (muscles.point_muscle == number) & (muscles.bones == JAW)
    return MuscleView(
        outline=muscle.outline,
        grid=muscle.grid,
        grid_lines=_grid_lines(muscle.grid),
        ellipsoids=_transforms(solids, np.flatnonzero(own).astype(np.int32)),
        influenced=binding.vertices,
        jaw_points=points[on_jaw],
        merged=lines,
        partners=tuple(muscles.muscles[k].name for k in partners),
        cells=_cells(muscle.grid),
        near=report.near.ravel(),
        far=report.far.ravel(),
        thickness=report.thickness.ravel(),
        report=report,
    )


def _grid_lines(grid: FloatArray) -> FloatArray:
    along = np.stack([grid[:-1], grid[1:]], axis=2).reshape(-1, 2, 3)
    across = np.stack([grid[:, :-1], grid[:, 1:]], axis=2).reshape(-1, 2, 3)
    return np.concatenate([along, across])


def _cells(grid: FloatArray) -> FloatArray:
    corners = [grid[:-1, :-1], grid[1:, :-1], grid[1:, 1:], grid[:-1, 1:]]
    return np.stack(corners, axis=2).reshape(-1, 4, 3)


def _transforms(solids: Ellipsoids, rows: IntArray) -> FloatArray:
    matrices = np.zeros((len(rows), 4, 4))
    matrices[:, :3, :3] = solids.frames[rows] * solids.half_axes[rows][:, None, :]
    matrices[:, :3, 3] = solids.centres[rows]
    matrices[:, 3, 3] = 1.0
    return matrices


def _merged(
    muscles: MuscleSet, number: int, centres: FloatArray
) -> tuple[FloatArray, tuple[int, ...]]:
    links = muscles.links
    ends = links.ends[:, 1] - links.ends[:, 0] - 1
    hosts = links.hosts[:, 1]
    first, second = muscles.segment_muscle[ends], muscles.segment_muscle[hosts]
    mine = (first == number) | (second == number)
    lines = np.stack([centres[ends[mine]], centres[hosts[mine]]], axis=1)
    others = np.where(first == number, second, first)[mine]
    return lines.reshape(-1, 2, 3), tuple(int(k) for k in np.unique(others))
