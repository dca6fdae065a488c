"""Changes of an outline recipe as a person makes them: every function returns something new.

References
----------
Kaehler, Haber and Seidel 2001, section 5.1 (the muscle editor).
"""

from __future__ import annotations

from dataclasses import replace

from risorius.errors import ParameterError
from risorius.springmuscle.drawing import MIDLINE, free_name, mean_across
from risorius.springmuscle.measure import FaceMeasure
from risorius.springmuscle.recipe import MuscleOutline, OutlinePoint, OutlineRecipe

__all__ = [
    "moved_point",
    "on_one_side",
    "on_two_sides",
    "renamed",
    "with_outline",
    "with_point",
    "without_outline",
    "without_point",
]

Row = tuple[OutlinePoint, ...]

_FEWEST, _FEWEST_OF_RING = 2, 3


def moved_point(
    outline: MuscleOutline, row: int, column: int, point: OutlinePoint
) -> MuscleOutline:
    """Return the outline with one point of a row elsewhere.

    Raises
    ------
    ParameterError
        If there is no such point.
    """
    old = _row(outline, row, column)
    return _with_row(outline, row, (*old[:column], point, *old[column + 1 :]))


def with_point(outline: MuscleOutline, row: int, column: int, point: OutlinePoint) -> MuscleOutline:
    """Return the outline with a new point behind point `column` of a row.

    Raises
    ------
    ParameterError
        If there is no such point.
    """
    old = _row(outline, row, column)
    return _with_row(outline, row, (*old[: column + 1], point, *old[column + 1 :]))


def without_point(outline: MuscleOutline, row: int, column: int) -> MuscleOutline:
    """Return the outline without a point; a row that would keep a single one goes as a whole.

    Raises
    ------
    ParameterError
        If there is no such point, or too few rows would be left.
    """
    old = _row(outline, row, column)
    if len(old) > _FEWEST:
        return _with_row(outline, row, (*old[:column], *old[column + 1 :]))
    least = _FEWEST if outline.ring is None else _FEWEST_OF_RING
    if len(outline.rows) <= least:
        raise ParameterError(
            f"outline {outline.name}: needs {least} rows of two points; delete the muscle instead"
        )
    rows = (*outline.rows[:row], *outline.rows[row + 1 :])
    ring = outline.ring
    if ring is not None and ring.shares:
        ring = replace(ring, shares=(*ring.shares[:row], *ring.shares[row + 1 :]))
    return replace(outline, rows=rows, ring=ring)


def with_outline(recipe: OutlineRecipe, outline: MuscleOutline) -> OutlineRecipe:
    """Return the recipe with a muscle added, or put in the place of the one of its name.

    Raises
    ------
    ParameterError
        If one of its sides has the name of another muscle.
    """
    if any(each.name == outline.name for each in recipe.muscles):
        return recipe.replaced(outline)
    return OutlineRecipe((*recipe.muscles, outline))


def without_outline(recipe: OutlineRecipe, name: str) -> OutlineRecipe:
    """Return the recipe without a muscle.

    Raises
    ------
    ParameterError
        If there is no such muscle, or it is the last one.
    """
    _outline(recipe, name)
    kept = tuple(each for each in recipe.muscles if each.name != name)
    if not kept:
        raise ParameterError(f"recipe: {name} is the last muscle; draw another one first")
    return OutlineRecipe(kept)


def renamed(recipe: OutlineRecipe, name: str, new: str) -> OutlineRecipe:
    """Return the recipe with a muscle renamed; a control that it shares keeps its name.

    Parameters
    ----------
    recipe : OutlineRecipe
    name : str
        As in the recipe: with a side only where the muscle exists on one side alone.
    new : str
        Without side.

    Raises
    ------
    ParameterError
        If there is no such muscle, the new name is taken, or it is no name.
    """
    outline = _outline(recipe, name)
    stem, side = _parts(name)
    if new == stem:
        return recipe
    if free_name(recipe, new) != new:
        raise ParameterError(f"muscle {name}: the name {new!r} is taken; choose another")
    # A muscle of one side has its own name written down as its control.
    control = "" if side and outline.control == name else outline.control
    changed = replace(outline, name=new + side, control=control)
    return OutlineRecipe(tuple(changed if each is outline else each for each in recipe.muscles))


def on_two_sides(outline: MuscleOutline, measure: FaceMeasure) -> MuscleOutline:
    """Return a muscle of one side as a paired one; what was drawn right is kept left.

    Raises
    ------
    ParameterError
        If it lies on the midline, where it is its own mirror image.
    """
    if outline.mirror:
        return outline
    stem, side = _parts(outline.name)
    across = mean_across(outline.rows, measure)
    if not side and abs(across) < MIDLINE * measure.width:
        raise ParameterError(f"muscle {stem}: lies on the midline and has no mirror image")
    control = outline.control
    control = "" if control in (outline.name, "") else control.removesuffix("_l").removesuffix("_r")
    paired = replace(outline, name=stem, control=control, mirror=True)
    if across >= 0.0:
        return paired
    flipped = paired.sided(-1)
    return replace(flipped, name=stem, control=control, mirror=True)


def on_one_side(outline: MuscleOutline) -> MuscleOutline:
    """Return a paired muscle on the left only; its name then ends in ``_l``."""
    return outline.sided(1) if outline.mirror else outline


def _row(outline: MuscleOutline, row: int, column: int) -> Row:
    if not (0 <= row < len(outline.rows) and 0 <= column < len(outline.rows[row])):
        raise ParameterError(f"outline {outline.name}: no point {column} in row {row}")
    return outline.rows[row]


def _with_row(outline: MuscleOutline, row: int, points: Row) -> MuscleOutline:
    return replace(outline, rows=(*outline.rows[:row], points, *outline.rows[row + 1 :]))


def _outline(recipe: OutlineRecipe, name: str) -> MuscleOutline:
    for each in recipe.muscles:
        if each.name == name:
            return each
    raise ParameterError(
        f"recipe: there is no {name!r}; it has {', '.join(each.name for each in recipe.muscles)}"
    )


def _parts(name: str) -> tuple[str, str]:
    """Return a name without its side, and the side."""
    return (name[:-2], name[-2:]) if name.endswith(("_l", "_r")) else (name, "")
