"""Fit the muscles of a recipe to a head."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from risorius._check import FloatArray
from risorius.anatomy.mechanics import Mechanics
from risorius.anatomy.skin import mirror_partners
from risorius.errors import RisoriusWarning
from risorius.springmuscle.bones import Bones, SkinBones
from risorius.springmuscle.fibres import make_fibres
from risorius.springmuscle.fit_parameters import FitParameters
from risorius.springmuscle.grid import Layer, find_patch, lay_out
from risorius.springmuscle.merging import merge_muscles
from risorius.springmuscle.muscle import Fibre, FittedMuscle, MuscleAction
from risorius.springmuscle.muscle_set import MuscleSet
from risorius.springmuscle.recipe import MuscleOutline, OutlineRecipe
from risorius.springmuscle.refine import refine
from risorius.springmuscle.row_bones import GrownBones, grow_bones, row_bones
from risorius.springmuscle.surface import SkinSurface

__all__ = ["Ground", "fit_muscle", "fit_muscles"]

# A muscle that lies beside the skin with more of its points than this is told of.
_BESIDE = 0.2
_MIRROR = np.array([-1.0, 1.0, 1.0])
# Axes of a mirrored ellipsoid: the one along the skin turns round, so that frames stay right.
_TURNED = np.array([1.0, -1.0, 1.0])


@dataclass(frozen=True, eq=False)
class Ground:
    """What muscles of one head are fitted to; built once, used for every fit.

    Parameters
    ----------
    surface : SkinSurface
    bones : Bones
    pivots : mapping of int to (3,) float64
        Centres of the left (1) and right (-1) eyeball, those that there are [mm].
    symmetric : bool
        Whether the skin is its own mirror image; then right muscles are those of the left.
    parameters : FitParameters
    """

    surface: SkinSurface
    bones: Bones
    pivots: dict[int, FloatArray]
    symmetric: bool
    parameters: FitParameters

    @staticmethod
    def build(
        mechanics: Mechanics, bones: Bones, parameters: FitParameters | None = None
    ) -> Ground:
        """Measure a head for muscles."""
        sides = {"l": 1, "r": -1}
        return Ground(
            SkinSurface.build(mechanics),
            bones,
            {sides[side]: eye.centre for side, eye in mechanics.eyes.items()},
            mirror_partners(mechanics.head.skin.mesh) is not None,
            parameters or FitParameters(),
        )

    @cached_property
    def skin_bones(self) -> SkinBones:
        """What every skin vertex lies on."""
        return self.bones.under(self.surface, max_depth=self.parameters.bone_depth)

    @cached_property
    def grown_bones(self) -> GrownBones:
        """The same, grown over skin without bone."""
        return grow_bones(self.surface, self.skin_bones)


def fit_muscles(
    recipe: OutlineRecipe, ground: Ground, *, known: Mapping[str, FittedMuscle] | None = None
) -> MuscleSet:
    """Fit all muscles of a recipe and link their ends.

    Parameters
    ----------
    recipe : OutlineRecipe
    ground : Ground
    known : mapping of str to FittedMuscle, optional
        Muscles of these outlines that have been fitted to this ground already, by name.

    Raises
    ------
    LandmarkError, ParameterError
        If an outline cannot be laid on this head; the message names the muscle.
    """
    outlines = {outline.name: outline for outline in recipe.sided()}
    fitted: dict[str, FittedMuscle] = {}
    for outline in outlines.values():
        if known and outline.name in known:
            fitted[outline.name] = known[outline.name]
            continue
        twin = outline.name[:-2] + "_l"
        right = ground.symmetric and outline.name.endswith("_r") and twin in fitted
        if right and outline.mirrors(outlines[twin]):
            fitted[outline.name] = mirrored(fitted[twin], outline)
        else:
            fitted[outline.name] = fit_muscle(outline, ground)
    muscles = tuple(fitted.values())
    if not ground.parameters.merge:
        return MuscleSet(muscles)
    return merge_muscles(muscles, yielding=ground.parameters.yielding)


def fit_muscle(outline: MuscleOutline, ground: Ground) -> FittedMuscle:
    """Fit one muscle; its outline is named with its side, see `OutlineRecipe.sided`.

    Raises
    ------
    LandmarkError, ParameterError
        If the outline cannot be laid on this head.
    """
    surface, parameters = ground.surface, ground.parameters
    layout = lay_out(outline, surface)
    beside = 1.0 - float(layout.found.mean())
    if beside > _BESIDE:
        warnings.warn(
            f"outline {outline.name}: {beside:.0%} of its points lie beside the skin and keep the "
            "place they were drawn at; move them, or leave the muscle out",
            RisoriusWarning,
            stacklevel=2,
        )
    patch = find_patch(layout, surface, parameters)
    layer = Layer(outline, surface, parameters)
    mirror = ground.symmetric and not outline.name.endswith(("_l", "_r"))
    refined = refine(layout, layer, patch, mirror=mirror)
    bones = row_bones(
        refined.points, refined.normals, patch, surface, ground.grown_bones,
        closed=layout.closed, mirror=mirror,
    )  # fmt: skip
    fibres = make_fibres(refined, bones, layer, closed=layout.closed)
    pivot = None
    if outline.ring is not None and outline.ring.around_eye and parameters.lines:
        pivot = ground.pivots.get(-1 if outline.name.endswith("_r") else 1)
    return FittedMuscle(
        outline.name, outline.kind, _action(outline, ground, patch.edge), fibres, layout.closed,
        pivot, refined.points, refined.normals, layout.points, refined.report,
    )  # fmt: skip


def _action(outline: MuscleOutline, ground: Ground, edge: float) -> MuscleAction:
    settings, scale = outline.settings, ground.surface.scale
    own = settings.radius
    radius = own * scale if own else max(ground.parameters.radius * scale, 2.0 * edge)
    return MuscleAction(
        control=outline.control or outline.name,
        max_contraction=settings.max_contraction,
        stiffness=settings.stiffness,
        bulge=settings.bulge,
        seal=settings.seal,
        host=settings.host,
        radius=radius,
        fixed_point=settings.fixed_point if ground.parameters.loose_origins else 0.0,
    )


def mirrored(muscle: FittedMuscle, outline: MuscleOutline) -> FittedMuscle:
    """Return the mirror image of a left muscle, named as `outline`."""
    return replace(
        muscle,
        name=outline.name,
        action=replace(muscle.action, control=outline.control),
        fibres=tuple(_mirrored_fibre(fibre) for fibre in muscle.fibres),
        pivot=None if muscle.pivot is None else muscle.pivot * _MIRROR,
        grid=muscle.grid * _MIRROR,
        grid_normals=muscle.grid_normals * _MIRROR,
        outline=muscle.outline * _MIRROR,
    )


def _mirrored_fibre(fibre: Fibre) -> Fibre:
    return replace(
        fibre,
        points=fibre.points * _MIRROR,
        frames=fibre.frames * _MIRROR[:, None] * _TURNED,
        aims=None if fibre.aims is None else fibre.aims * _MIRROR,
    )
