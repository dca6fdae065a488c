"""Carry vector muscles to another head, one group of expressions after the other."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Literal

import numpy as np

from risorius._check import FloatArray, as_number, one_of
from risorius.anatomy.template import SURE_LANDMARKS
from risorius.controls.presets import PresetBook, default_presets
from risorius.errors import ParameterError
from risorius.head.head import Head
from risorius.vectormuscle.export_pairs import Pairs
from risorius.vectormuscle.export_points import FeatureSet, find_features
from risorius.vectormuscle.muscle import VectorMuscle
from risorius.vectormuscle.vector_set import VectorSet, default_vector_set
from risorius.warp.network import NetworkWarp

__all__ = [
    "EXPORT_ORDER",
    "Correspondences",
    "Export",
    "ExportParameters",
    "MuscleGroup",
    "export_muscles",
    "export_order",
    "muscle_groups",
]

EXPORT_ORDER = ("joy", "surprise", "sadness", "anger", "fear", "disgust")
"""From the expression that is easiest to judge to the hardest (erratum E5)."""

Correspondences = Literal["landmarks", "features"]


@dataclass(frozen=True)
class ExportParameters:
    """Every choice of an export.

    Parameters
    ----------
    correspondences : {"landmarks", "features"}
        The ten feature points and the landmarks that both heads have, or the ten alone as
        published: then the mouth is reached by extrapolation.
    regularisation : float
        See `NetworkWarp.fit`.
    near : float
        Points closer than this share of the head's width are one.
    """

    correspondences: Correspondences = "landmarks"
    regularisation: float = 1e-3
    near: float = 0.005

    def __post_init__(self) -> None:
        one_of("correspondences", self.correspondences, ("landmarks", "features"))
        as_number("regularisation", self.regularisation, low=0.0)
        as_number("near", self.near, low=0.0, high=0.1)

    @staticmethod
    def of_profile(profile: Literal["improved", "faithful"]) -> ExportParameters:
        """Return the parameters of a named profile."""
        one_of("profile", profile, ("improved", "faithful"))
        return ExportParameters("features" if profile == "faithful" else "landmarks")


@dataclass(frozen=True)
class MuscleGroup:
    """Muscles that are judged together by one expression; none is in two groups."""

    expression: str
    muscles: tuple[str, ...]


@dataclass(frozen=True, eq=False)
class Export:
    """An export under way; make one with `Export.begin`.

    Parameters
    ----------
    source, target : Head
    vectors : VectorSet
        Fitted to the source.
    parameters : ExportParameters
    features : (FeatureSet, FeatureSet)
        Of source and target.
    groups : tuple of MuscleGroup
        In the order in which they are tuned.
    pairs : Pairs
        Feature points, then ends of fixed muscles.
    fixed : mapping of str to VectorMuscle
        Muscles that are done, on the target.
    """

    source: Head
    target: Head
    vectors: VectorSet
    parameters: ExportParameters
    features: tuple[FeatureSet, FeatureSet]
    groups: tuple[MuscleGroup, ...]
    pairs: Pairs
    fixed: Mapping[str, VectorMuscle] = field(default_factory=dict[str, VectorMuscle])

    @staticmethod
    def begin(
        source: Head,
        target: Head,
        vectors: VectorSet | None = None,
        *,
        parameters: ExportParameters | None = None,
        features: tuple[FeatureSet, FeatureSet] | None = None,
        presets: PresetBook | None = None,
        first: Iterable[str] = (),
    ) -> Export:
        """Return the export before the first group.

        Parameters
        ----------
        source : Head
            Where the muscles are right.
        target : Head
            Where they shall go.
        vectors : VectorSet, optional
            Fitted to the source here; the default set if left out.
        parameters : ExportParameters, optional
        features : (FeatureSet, FeatureSet), optional
            Of source and target, if a person has edited them.
        presets : PresetBook, optional
            Their emotions say which muscles are judged by which expression.
        first : iterable of str
            Expressions that are judged before all others; see `muscle_groups`.

        Raises
        ------
        LandmarkError
            If feature points cannot be found.
        """
        chosen = parameters or ExportParameters()
        fitted = (vectors or default_vector_set()).fitted(source)
        both = features or (find_features(source), find_features(target))
        pairs = Pairs.empty()
        near = chosen.near * both[0].width
        for name, place in both[0].points.items():
            pairs = pairs.with_pair(name, place, both[1].points[name], near=near)
        if chosen.correspondences == "landmarks":
            for name in SURE_LANDMARKS:
                if name in source.landmarks and name in target.landmarks:
                    place = source.landmarks.position(name)
                    there = target.landmarks.position(name)
                    pairs = pairs.with_pair(name, place, there, near=near)
        groups = muscle_groups(fitted, presets or default_presets(), first=first)
        return Export(source, target, fitted, chosen, both, groups, pairs)

    @cached_property
    def warp(self) -> NetworkWarp:
        """The network trained on all correspondences so far; fixed muscles are met exactly."""
        return NetworkWarp.fit(
            self.pairs.source,
            self.pairs.target,
            regularisation=self.parameters.regularisation,
            exact=self.pairs.exact,
        )

    @property
    def group(self) -> MuscleGroup | None:
        """The group to tune next; None when all are done."""
        for group in self.groups:
            if not all(name in self.fixed for name in group.muscles):
                return group
        return None

    def proposal(self, names: Iterable[str] | None = None) -> tuple[VectorMuscle, ...]:
        """Return muscles on the target: fixed ones as tuned, the others through the warp.

        Radii scale with the local stretch, other numbers are copied (spec vector-muscles O3).

        Parameters
        ----------
        names : iterable of str, optional
            Default: all muscles in the order of the set.
        """
        wanted = None if names is None else set(names)
        return tuple(
            self.fixed[muscle.name] if muscle.name in self.fixed else muscle.fitted(self.warp)
            for muscle in self.vectors.muscles
            if wanted is None or muscle.name in wanted
        )

    def accept(self, tuned: Iterable[VectorMuscle] = ()) -> Export:
        """Return the export with the current group fixed.

        Parameters
        ----------
        tuned : iterable of VectorMuscle
            Muscles of the group as a person wants them; those left out stay as proposed.

        Raises
        ------
        ParameterError
            If all groups are done, or a muscle is not of the current one.
        """
        group = self.group
        if group is None:
            raise ParameterError("export: every group is fixed already; take its vector set")
        changed = {muscle.name: muscle for muscle in tuned}
        strangers = sorted(set(changed) - set(group.muscles))
        if strangers:
            raise ParameterError(
                f"export: {', '.join(strangers)} is not in the group of {group.expression}, which "
                f"has {', '.join(group.muscles)}"
            )
        pairs, fixed = self.pairs, dict(self.fixed)
        before = {muscle.name: muscle for muscle in self.vectors.muscles}
        near = self.parameters.near * self.features[0].width
        for muscle in self.proposal(group.muscles):
            final = changed.get(muscle.name, muscle)
            fixed[muscle.name] = final
            ends = zip(("head", "tail"), before[muscle.name].ends(), final.ends(), strict=True)
            for end, here, there in ends:
                name = f"{muscle.name}.{end}"
                pairs = pairs.with_pair(name, here, there, near=near, exact=True)
        return replace(self, pairs=pairs, fixed=fixed)

    def vector_set(self) -> VectorSet:
        """Return the set on the target, which `risorius rig` and `VectorFace.build` take."""
        marks: dict[str, FloatArray] = {
            name: self.target.landmarks.position(name) for name in self.target.landmarks
        }
        return VectorSet(self.proposal(), marks)

    def condition(self) -> float:
        """Return the condition number of the network's matrix."""
        warp = self.warp
        offset = warp.centres[:, None] - warp.centres[None]
        squared = np.einsum("ijk,ijk->ij", offset, offset)
        return float(np.linalg.cond(np.sqrt(squared + warp.radii**2)))


def export_order(presets: PresetBook) -> tuple[str, ...]:
    """Return the expressions of a book: the six in the order of the paper, then all others."""
    others = (name for name in presets.emotions if name not in EXPORT_ORDER)
    return (*(name for name in EXPORT_ORDER if name in presets.emotions), *others)


def muscle_groups(
    vectors: VectorSet, presets: PresetBook, *, first: Iterable[str] = ()
) -> tuple[MuscleGroup, ...]:
    """Return the muscles of a set by the first expression that contracts them.

    Muscles that no emotion contracts belong to no group: they go through the last warp.

    Parameters
    ----------
    vectors : VectorSet
    presets : PresetBook
    first : iterable of str
        Expressions that go before all others, and so have all their muscles: those that a person
        will look at. Both kinds keep the order of `export_order`.
    """
    names = [muscle.name for muscle in vectors.muscles]
    ahead = set(first)
    taken: set[str] = set()
    groups: list[MuscleGroup] = []
    for expression in sorted(export_order(presets), key=lambda name: name not in ahead):
        pose = presets.emotions.get(expression, {})
        new = tuple(name for name in names if pose.get(name, 0.0) and name not in taken)
        taken.update(new)
        if new:
            groups.append(MuscleGroup(expression, new))
    return tuple(groups)


def export_muscles(
    export: Export,
    *,
    tune: Callable[[Export], Iterable[VectorMuscle]] | None = None,
    finish: Callable[[tuple[VectorMuscle, ...]], Iterable[VectorMuscle]] | None = None,
) -> VectorSet:
    """Go through all groups and return the set on the target.

    Parameters
    ----------
    export : Export
        Fresh from `Export.begin`, or under way.
    tune : callable, optional
        Called for each group; returns its muscles as a person wants them. Without it the
        muscles go through the first warp untouched.
    finish : callable, optional
        Called once with the muscles that are in no group, on the target; returns them changed.

    References
    ----------
    Bui, Heylen, Poel, Nijholt 2003, section 4 (the incremental procedure).
    """
    while tune is not None and export.group is not None:
        export = export.accept(tune(export))
    vectors = export.vector_set()
    if finish is None:
        return vectors
    grouped = {name for group in export.groups for name in group.muscles}
    rest = tuple(muscle for muscle in vectors.muscles if muscle.name not in grouped)
    return vectors.replaced(finish(rest))
