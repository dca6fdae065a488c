"""The genes of spring muscles: changes of an outline recipe, in units of the face."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from types import MappingProxyType
from typing import Any

from risorius._check import FloatArray, one_of
from risorius.controls.control import Pose
from risorius.springmuscle.face import SpringFace
from risorius.springmuscle.fit_parameters import FitParameters
from risorius.springmuscle.recipe import (
    MuscleOutline,
    OutlinePoint,
    OutlineRecipe,
    OutlineSettings,
    Ring,
)
from risorius.springmuscle.redrawing import redrawn
from risorius.tuning.change import Change, Gene, Genes, parameters_of
from risorius.tuning.genome import Genome, Parameter

__all__ = ["OutlineCandidates", "apply_outline_genes", "outline_muscles", "outline_parameters"]

_SHIFT = Change("shift", -0.08, 0.08)
_AMOUNT = Change("factor", 0.5, 1.5)
_SIZE = Change("factor", 0.7, 1.4)
# What the file of a recipe takes.
_LONGEST = 50.0
_NUMBERS: Mapping[str, Change] = MappingProxyType(
    {
        "max_contraction": Change("factor", 0.5, 1.5, most=1.0),
        "radius": Change("factor", 0.7, 1.4, most=_LONGEST),
        "stiffness": Change("factor", 0.4, 2.5),
        "fixed_point": Change("share", 0.0, 0.6),
        "bulge": Change("factor", 0.5, 1.5, most=20.0),
    }
)
_RING: Mapping[str, Change] = MappingProxyType(
    {
        "ahead": Change("factor", 0.5, 1.5, least=-_LONGEST, most=_LONGEST),
        "turn": Change("factor", 0.5, 1.5, least=-90.0, most=90.0),
    }
)
_FURTHER = frozenset(("fixed_point", "bulge"))


def outline_muscles(recipe: OutlineRecipe, pose: Pose) -> tuple[str, ...]:
    """Return the muscles (without side) that a pose contracts."""
    return tuple(
        outline.name
        for outline in recipe.muscles
        if any(pose.get(one.control) for one in OutlineRecipe((outline,)).sided())
    )


def outline_parameters(
    recipe: OutlineRecipe,
    names: Iterable[str],
    *,
    genes: Genes = "published",
    fit: FitParameters | None = None,
) -> tuple[Parameter, ...]:
    """Return the genes of some outlines of a recipe; both sides share them.

    Ends shift by shares of the face's width and height, and the rows between them follow; a ring
    shifts as a whole. Lengths, contraction and hold are multiplied, shares added to.

    Parameters
    ----------
    recipe : OutlineRecipe
    names : iterable of str
        Without side.
    genes : {"published", "all"}
        Outline, depth, thickness, contraction, radius and hold, or also what is ours: the place
        that stays, and how much the muscle bulges.
    fit : FitParameters, optional
        Numbers of what an outline leaves open; those of the improved profile if left out.

    Raises
    ------
    ParameterError
        If the recipe has no such muscle.
    """
    one_of("genes", genes, ("published", "all"))
    open_numbers = fit or FitParameters()
    outlines = {outline.name: outline for outline in recipe.muscles}
    wanted = list(names)
    for name in wanted:
        one_of("recipe: muscle", name, outlines)
    listed = (gene for name in wanted for gene in _genes(outlines[name], open_numbers))
    return parameters_of(listed, _FURTHER, which=genes)


def apply_outline_genes(
    recipe: OutlineRecipe, values: Mapping[str, float], *, fit: FitParameters | None = None
) -> OutlineRecipe:
    """Return the recipe with its outlines changed by genes; strange names do not matter.

    Outlines without a gene in `values` stay the same objects.

    Parameters
    ----------
    recipe : OutlineRecipe
    values : mapping of str to float
        By the names of `outline_parameters`.
    fit : FitParameters, optional
        As there.
    """
    open_numbers = fit or FitParameters()
    return OutlineRecipe(tuple(_changed(each, values, open_numbers) for each in recipe.muscles))


@dataclass(frozen=True, eq=False)
class OutlineCandidates:
    """Spring muscles of one face in one expression.

    Parameters
    ----------
    face : SpringFace
        Built on the recipe by `SpringFace.build`.
    recipe : OutlineRecipe
        Before tuning.
    names : tuple of str
        Muscles to tune, without side.
    pose : mapping of str to float
        Expression that is looked at.
    genes : {"published", "all"}
        See `outline_parameters`.
    """

    face: SpringFace
    recipe: OutlineRecipe
    names: Sequence[str]
    pose: Pose
    genes: Genes = "published"

    @property
    def genome(self) -> Genome:
        """What may be tuned."""
        return self._genome

    @cached_property
    def _genome(self) -> Genome:
        fit = self._fit
        return Genome(outline_parameters(self.recipe, self.names, genes=self.genes, fit=fit))

    @property
    def _fit(self) -> FitParameters:
        return FitParameters() if self.face.ground is None else self.face.ground.parameters

    def recipe_of(self, values: Mapping[str, float]) -> OutlineRecipe:
        """Return the tuned recipe."""
        return apply_outline_genes(self.recipe, values, fit=self._fit)

    def face_of(self, values: Mapping[str, float]) -> SpringFace:
        """Return the face with the tuned muscles fitted anew, all others as they are."""
        return redrawn(self.face, self.recipe, self.recipe_of(values))

    def positions(self, values: Mapping[str, float]) -> FloatArray:
        """Return the vertices (n, 3) of the candidate with these values [mm]."""
        return self.face_of(values).pose(self.pose)


def _genes(outline: MuscleOutline, fit: FitParameters) -> Iterator[Gene]:
    settings, ring = outline.settings, outline.ring
    for shift in _shifts(outline):
        yield Gene(outline.name, shift, _SHIFT, 0.0)
    yield Gene(outline.name, "skin", _SIZE, 1.0)
    yield Gene(outline.name, "thickness", _SIZE, 1.0)
    for name, change in _NUMBERS.items():
        value = settings.radius or fit.radius if name == "radius" else getattr(settings, name)
        yield Gene(outline.name, name, change, value)
    if ring is not None:
        for name, change in _RING.items():
            yield Gene(outline.name, name, change, getattr(ring, name))


def _shifts(outline: MuscleOutline) -> tuple[str, ...]:
    """Return the names of the shifts along the face; what lies across the midline stays on it."""
    sided = outline.mirror or outline.name.endswith(("_l", "_r"))
    axes = "xy" if sided else "y"
    ends = ("origin", "insertion") if outline.ring is None else ("centre",)
    return tuple(f"{end}_{axis}" for end in ends for axis in axes)


def _changed(
    outline: MuscleOutline, values: Mapping[str, float], fit: FitParameters
) -> MuscleOutline:
    new: dict[str, float] = {}
    for gene in _genes(outline, fit):
        change = values.get(f"{outline.name}.{gene.name}", gene.change.neutral)
        if change != gene.change.neutral:
            new[gene.name] = gene.change.applied(gene.value, change)
    if not new:
        return outline
    return replace(
        outline,
        rows=_moved_rows(outline, new),
        ring=None if outline.ring is None else _moved_ring(outline.ring, new),
        settings=_with_numbers(outline.settings, new, fit),
    )


def _with_numbers(
    settings: OutlineSettings, new: Mapping[str, float], fit: FitParameters
) -> OutlineSettings:
    changed: dict[str, Any] = {name: value for name, value in new.items() if name in _NUMBERS}
    if "thickness" in new:
        least, most = settings.thickness or (fit.least, fit.most)
        changed["thickness"] = (least * new["thickness"], min(most * new["thickness"], _LONGEST))
    if "skin" in new:
        skin = fit.skin if settings.skin is None else settings.skin
        if isinstance(skin, Mapping):
            changed["skin"] = {mark: depth * new["skin"] for mark, depth in skin.items()}
        else:
            changed["skin"] = skin * new["skin"]
    return replace(settings, **changed)


def _moved_rows(
    outline: MuscleOutline, new: Mapping[str, float]
) -> tuple[tuple[OutlinePoint, ...], ...]:
    last = len(outline.rows) - 1
    rows: list[tuple[OutlinePoint, ...]] = []
    for number, row in enumerate(outline.rows):
        along = number / last
        x, y = (
            (1.0 - along) * new.get(f"origin_{axis}", 0.0)
            + along * new.get(f"insertion_{axis}", 0.0)
            + new.get(f"centre_{axis}", 0.0)
            for axis in "xy"
        )
        rows.append(tuple(_moved(point, x, y) for point in row))
    return tuple(rows)


def _moved_ring(ring: Ring, new: Mapping[str, float]) -> Ring:
    x, y = new.get("centre_x", 0.0), new.get("centre_y", 0.0)
    return replace(
        ring,
        centre=_moved(ring.centre, x, y),
        line=tuple(_moved(point, x, y) for point in ring.line),
        ahead=new.get("ahead", ring.ahead),
        turn=new.get("turn", ring.turn),
    )


def _moved(point: OutlinePoint, x: float, y: float) -> OutlinePoint:
    if not (x or y):
        return point
    across, up, forward = point.offset
    return replace(point, offset=(across + x, up + y, forward))
