"""From places that a pointer gave to outlines in terms of the landmarks around them.

What was drawn on one head lies at the same place of the next.

References
----------
Kaehler, Haber and Seidel 2001, section 5.1 (the muscle editor).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import numpy.typing as npt

from risorius._check import FloatArray, require_muscle_name
from risorius.anatomy.template import SURE_LANDMARKS
from risorius.errors import LandmarkError, ParameterError
from risorius.landmarks.feature_points import mirror_name
from risorius.springmuscle.measure import FaceMeasure
from risorius.springmuscle.recipe import (
    MuscleOutline,
    OutlinePoint,
    OutlineRecipe,
    OutlineSettings,
    Ring,
)

__all__ = ["MIDLINE", "drawn_outline", "free_name", "mean_across", "outline_point"]

MIDLINE = 0.03
"""What lies nearer to the midline than this belongs to both sides [widths of the face]."""

_ANCHORS = 3
# Landmarks this near count alike; nearer ones would take all [widths of the face].
_BLUNT = 0.05
# An anchor that counts less than this is left out; weights and offsets are rounded as in files.
_FAINT, _WEIGHT_DIGITS, _OFFSET_DIGITS = 0.1, 3, 4
# What living muscles give up of their length (finding S3).
_SHORTENING = 0.4
# A new ring this near to one of the recipe contracts as that does [widths of the face].
_NEAR_RING = 0.28


def outline_point(place: npt.ArrayLike, measure: FaceMeasure) -> OutlinePoint:
    """Return a place on a face in terms that fit any head.

    Its anchors are the three nearest landmarks that are found alike on every head, weighted by
    inverse squared distance; numbers are rounded as recipe files round them (0.01 mm).

    Parameters
    ----------
    place : (3,) array_like
        On the skin, canonical frame [mm].
    measure : FaceMeasure
        Of the head.

    Raises
    ------
    ParameterError
        If `place` is not three finite numbers.
    LandmarkError
        If the head has none of the landmarks.
    """
    point = np.asarray(place, np.float64)
    if point.shape != (3,) or not np.isfinite(point).all():
        raise ParameterError("outline point: needs three finite numbers")
    names = [name for name in SURE_LANDMARKS if name in measure.landmarks]
    if not names:
        raise LandmarkError(
            f"landmarks: an outline point needs one of {', '.join(SURE_LANDMARKS)} to hang on"
        )
    away = {name: float(np.linalg.norm(measure.landmarks[name] - point)) for name in names}
    nearest = sorted(names, key=lambda name: away[name])[:_ANCHORS]
    if abs(point[0]) < MIDLINE * measure.width:
        both = (*nearest, *(mirror_name(name) for name in nearest))
        nearest = [name for name in dict.fromkeys(both) if name in away]
    least = _BLUNT * measure.width
    pull = {name: max(away[name], least) ** -2 for name in nearest}
    strongest = max(pull.values())
    weights = {name: round(value / strongest, _WEIGHT_DIGITS) for name, value in pull.items()}
    weights = {name: weight for name, weight in weights.items() if weight >= _FAINT}
    shares = tuple(weights.values()) if len(set(weights.values())) > 1 else ()
    bare = OutlinePoint(tuple(weights), weights=shares)
    x, y, z = (point - bare.place(measure)) / measure.unit
    offset = (round(x, _OFFSET_DIGITS), round(y, _OFFSET_DIGITS), round(z, _OFFSET_DIGITS))
    return replace(bare, offset=offset)


def drawn_outline(
    recipe: OutlineRecipe,
    name: str,
    rows: Sequence[npt.ArrayLike],
    measure: FaceMeasure,
    *,
    ring: bool = False,
    mirror: bool = True,
) -> MuscleOutline:
    """Return a new muscle of rows drawn on a head.

    What was drawn on the right is kept on the left and mirrored; a muscle on the midline is its
    own mirror image. A ring around the mouth or an eye contracts as that of the recipe does, any
    other one towards the middle of its inner points.

    Parameters
    ----------
    recipe : OutlineRecipe
        Where it will belong.
    name : str
        Without side; a number is added where it is taken.
    rows : sequence of (k, 3) array_like
        The fixed end first; of a ring around it, each from inside to outside [mm].
    measure : FaceMeasure
        Of the head.
    ring : bool
        Whether it is a sphincter.
    mirror : bool
        Whether it exists on the other side, too.

    Raises
    ------
    ParameterError
        If `name` is no name, or there are too few rows or points.
    """
    stem = free_name(recipe, name)
    points = tuple(tuple(outline_point(place, measure) for place in np.asarray(r)) for r in rows)
    least = 3 if ring else 2
    if len(points) < least:
        raise ParameterError(f"outline {stem}: has {len(points)} rows, {least} are needed")
    settings, around = OutlineSettings(max_contraction=_SHORTENING), None
    if ring:
        around, settings = _ring_of(recipe, points, measure)
    kind = "sphincter" if ring else "sheet" if max(map(len, points)) > 2 else "linear"
    across = mean_across(points, measure)
    if abs(across) < MIDLINE * measure.width and mirror:
        return MuscleOutline(stem, kind, points, mirror=False, ring=around, settings=settings)
    left = MuscleOutline(stem, kind, points, ring=around, settings=settings)
    if across < 0.0:
        left = replace(left.sided(-1), name=stem, control="", mirror=True)
    if mirror:
        return left
    return left.sided(1 if across >= 0.0 else -1)


def free_name(recipe: OutlineRecipe, stem: str) -> str:
    """Return `stem`, with the first number behind it that makes it a new name.

    Raises
    ------
    ParameterError
        If it is no name.
    """
    require_muscle_name(stem)
    taken = {each.name.removesuffix("_l").removesuffix("_r") for each in recipe.muscles}
    name, count = stem, 1
    while name in taken:
        count += 1
        name = f"{stem}_{count}"
    return name


def mean_across(rows: Sequence[Sequence[OutlinePoint]], measure: FaceMeasure) -> float:
    """Return how far left of the midline the points of an outline lie in the mean [mm]."""
    return float(np.mean([point.place(measure)[0] for row in rows for point in row]))


def _ring_of(
    recipe: OutlineRecipe, rows: Sequence[Sequence[OutlinePoint]], measure: FaceMeasure
) -> tuple[Ring, OutlineSettings]:
    """Return how a ring contracts: as the nearest one around the same opening, if there is one."""
    inner: FloatArray = np.array([row[0].place(measure) for row in rows])
    middle = inner.mean(axis=0)
    near = [
        (float(np.linalg.norm(each.ring.centre.place(measure) - middle)), each)
        for each in recipe.sided()
        if each.ring is not None and each.ring.closed and not each.ring.turn
    ]
    distance, twin = min(near, key=lambda pair: pair[0], default=(np.inf, None))
    if twin is None or twin.ring is None or distance > _NEAR_RING * measure.width:
        return Ring(outline_point(middle, measure)), OutlineSettings(max_contraction=_SHORTENING)
    settings = OutlineSettings(max_contraction=twin.settings.max_contraction)
    return replace(twin.ring, shares=()), settings
