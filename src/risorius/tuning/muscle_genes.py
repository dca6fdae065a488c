"""The genes of vector muscles: changes that mean the same on every head."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, fields, replace
from functools import cached_property
from types import MappingProxyType
from typing import Any, cast

import numpy as np

from risorius._check import FloatArray, one_of
from risorius.controls.control import Pose
from risorius.tuning.change import Change, Gene, Genes, parameters_of
from risorius.tuning.genome import Genome, Parameter
from risorius.vectormuscle.face import VectorFace
from risorius.vectormuscle.kinds.linear import MOST_STRENGTH
from risorius.vectormuscle.muscle import VectorMuscle

__all__ = ["Genes", "MuscleCandidates", "apply_genes", "muscle_parameters"]

# Spec vector-muscles 2.6: coordinates +-8 % of the head's width, radii +-30 %, angles +-10
# degrees, strength 0.5 to 1.5; all as changes, so that a style fits the next head as well.
_SHIFT = Change("shift", -0.08, 0.08)
_LENGTH = Change("factor", 0.7, 1.3)
_AMOUNT = Change("factor", 0.5, 1.5)
_PUBLISHED: Mapping[str, Change] = MappingProxyType(
    {
        "origin": _SHIFT, "insertion": _SHIFT, "centre": _SHIFT,
        "start_radius": _LENGTH, "finish_radius": _LENGTH, "radii": _LENGTH,
        "half_width": _LENGTH, "height": _LENGTH,
        "half_angle": Change("add", -10.0, 10.0, least=1.0, most=89.0),
        "strength": Change("factor", 0.5, 1.5, most=MOST_STRENGTH),
        "pull": _AMOUNT, "shrink": _AMOUNT, "forward": _AMOUNT,
        "part": _AMOUNT, "back": _AMOUNT, "over": _AMOUNT,
    }
)  # fmt: skip
# Ours: how skin follows and bulges, which the ten numbers cannot say. Shares change by addition
# and stay inside the limits.
_FURTHER: Mapping[str, Change] = MappingProxyType(
    {
        "drag": Change("share", 0.0, 0.95), "reach": Change("factor", 0.5, 3.0),
        "sink": Change("share", -0.3, 1.0),
        "out": Change("add", -0.7, 0.7), "bulge": Change("add", -0.7, 0.7),
        "corner": Change("share", 0.0, 0.95), "fixed": Change("share", 0.0, 0.6),
        "fade_origin": Change("factor", 0.4, 2.5), "fade_insertion": Change("factor", 0.4, 2.5),
    }
)  # fmt: skip
_RULES = MappingProxyType({**_PUBLISHED, **_FURTHER})
# The start of the fall-off stays below this share of its finish.
_LATEST_START = 0.9
_AXES = "xyz"


def muscle_parameters(
    muscles: Iterable[VectorMuscle], *, mirror: bool = True, genes: Genes = "published"
) -> tuple[Parameter, ...]:
    """Return the genes of muscles: ten for a linear one, or up to six more.

    Places shift by shares of the head's width, lengths and amounts are multiplied, angles are
    added to [deg], shares added to. With `mirror` one gene, named without side, drives both
    sides, and muscles on the midline stay there.

    Parameters
    ----------
    muscles : iterable of VectorMuscle
    mirror : bool
    genes : {"published", "all"}
        The ten numbers of Bui et al. 2003, or also how skin around the muscle follows, bulges
        and lags.
    """
    one_of("genes", genes, ("published", "all"))
    found: list[Gene] = []
    for muscle in muscles:
        name = muscle.name
        sided = name.endswith(("_l", "_r"))
        stem = name[:-2] if mirror and sided else name
        for gene, change, value in _numbers(muscle):
            # A muscle that does not spare the lips keeps that.
            if gene == "corner" and value == 0.0:
                continue
            if mirror and not sided and change.way == "shift" and gene.endswith("_x"):
                continue
            found.append(Gene(stem, gene, change, value))
    return parameters_of(found, _FURTHER, which=genes)


def apply_genes(muscle: VectorMuscle, values: Mapping[str, float], *, width: float) -> VectorMuscle:
    """Return a muscle changed by its genes; those of other muscles do not matter.

    Parameters
    ----------
    muscle : VectorMuscle
        As it was proposed.
    values : mapping of str to float
        Genes by name; one with the muscle's side goes before one without.
    width : float
        Width of the head [mm].
    """
    stem = muscle.name[:-2] if muscle.name.endswith(("_l", "_r")) else muscle.name
    changed: dict[str, Any] = {}
    for gene, rule, value in _numbers(muscle):
        full, shared = f"{muscle.name}.{gene}", f"{stem}.{gene}"
        if full in values:
            change = values[full]
        elif shared in values:
            mirrored = muscle.name.endswith("_r") and rule.way == "shift" and gene.endswith("_x")
            change = -values[shared] if mirrored else values[shared]
        else:
            continue
        changed[gene] = rule.applied(value, change, size=width)
    return _with_numbers(muscle, changed) if changed else muscle


def _numbers(muscle: VectorMuscle) -> list[tuple[str, Change, float]]:
    """Return (gene, rule, value) for each number of a muscle that may be tuned."""
    found: list[tuple[str, Change, float]] = []
    for entry in fields(cast(Any, muscle)):
        rule = _RULES.get(entry.name)
        if rule is None:
            continue
        value = getattr(muscle, entry.name)
        if isinstance(value, float | int):
            found.append((entry.name, rule, float(value)))
        else:
            row = np.asarray(value, dtype=np.float64)
            found.extend(
                (f"{entry.name}_{axis}", rule, float(number)) for axis, number in zip(_AXES, row)
            )
    return found


def _with_numbers(muscle: VectorMuscle, changed: Mapping[str, float]) -> VectorMuscle:
    new: dict[str, Any] = {}
    for entry in fields(cast(Any, muscle)):
        value = getattr(muscle, entry.name)
        if entry.name in changed:
            new[entry.name] = changed[entry.name]
        elif entry.name in _RULES and not isinstance(value, float | int):
            row = [
                changed.get(f"{entry.name}_{axis}", float(number))
                for axis, number in zip(_AXES, value)
            ]
            new[entry.name] = np.array(row) if isinstance(value, np.ndarray) else tuple(row)
    return replace(cast(Any, muscle), **_tamed(muscle, new))


def _tamed(muscle: VectorMuscle, new: dict[str, Any]) -> dict[str, Any]:
    """Return `new` numbers, the fall-off starting before it ends."""
    if "start_radius" in new or "finish_radius" in new:
        finish = new.get("finish_radius", getattr(muscle, "finish_radius", np.inf))
        start = new.get("start_radius", getattr(muscle, "start_radius", 0.0))
        new["start_radius"] = min(start, _LATEST_START * finish)
    return new


@dataclass(frozen=True, eq=False)
class MuscleCandidates:
    """Vector muscles of one face in one expression.

    Parameters
    ----------
    face : VectorFace
        With the muscles as proposed.
    names : tuple of str
        Muscles to tune.
    pose : mapping of str to float
        Expression that is looked at.
    width : float
        Width of the head [mm].
    mirror : bool
    genes : {"published", "all"}
        See `muscle_parameters`.
    """

    face: VectorFace
    names: Sequence[str]
    pose: Pose
    width: float
    mirror: bool = True
    genes: Genes = "published"

    @cached_property
    def proposed(self) -> tuple[VectorMuscle, ...]:
        """The muscles to tune, before tuning."""
        wanted = set(self.names)
        return tuple(each for each in self.face.vectors.muscles if each.name in wanted)

    @property
    def genome(self) -> Genome:
        """What may be tuned."""
        return self._genome

    @cached_property
    def _genome(self) -> Genome:
        return Genome(muscle_parameters(self.proposed, mirror=self.mirror, genes=self.genes))

    def muscles(self, values: Mapping[str, float]) -> tuple[VectorMuscle, ...]:
        """Return the tuned muscles."""
        return tuple(apply_genes(each, values, width=self.width) for each in self.proposed)

    def face_of(self, values: Mapping[str, float]) -> VectorFace:
        """Return the face with the tuned muscles bound anew, all others as they are."""
        return self.face.with_muscles(self.muscles(values))

    def positions(self, values: Mapping[str, float]) -> FloatArray:
        """Return the vertices (n, 3) of the candidate with these values [mm]."""
        return self.face_of(values).pose(self.pose)
