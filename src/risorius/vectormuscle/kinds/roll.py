"""Marginal part of orbicularis oris: rolls one lip in over the teeth."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, Literal, cast

import numpy as np

from risorius._check import FloatArray, as_number, one_of
from risorius.anatomy.smooth_step import smooth_step
from risorius.vectormuscle.kinds.sphincter import BoundField
from risorius.vectormuscle.muscle import (
    FaceContext,
    Warp,
    mirrored_name,
    read_vector,
    register_kind,
)

__all__ = ["RollMuscle"]


@dataclass(frozen=True, eq=False)
class RollMuscle:
    """Rolls the red of one lip inwards.

    Skin within `height` of the contact line turns about a line along the lip: the margin goes
    back and towards the other lip, the outer border follows.

    Parameters
    ----------
    name : str
    lip : {"upper", "lower"}
    centre : (3,) float64
        Middle of the mouth; carries the muscle to other heads [mm].
    half_width : float
        Half the width of the part that rolls [mm].
    height : float
        Reach from the contact line [mm].
    back, over : float
        Displacement of the margin backwards and towards the other lip [mm].
    """

    name: str
    lip: Literal["upper", "lower"]
    centre: FloatArray
    half_width: float
    height: float
    back: float
    over: float

    def mirrored(self) -> RollMuscle:
        """Return the same muscle: it lies on the midline."""
        return replace(self, name=mirrored_name(self.name))

    def fitted(self, warp: Warp) -> RollMuscle:
        """Return the muscle carried by `warp`; lengths scale with the width of the mouth."""
        side = np.array([self.half_width, 0.0, 0.0])
        ends = warp(np.stack([self.centre, self.centre - side, self.centre + side]))
        half = 0.5 * float(np.linalg.norm(ends[2] - ends[1]))
        scale = half / self.half_width
        return replace(
            self,
            centre=ends[0],
            half_width=half,
            height=scale * self.height,
            back=scale * self.back,
            over=scale * self.over,
        )

    def ends(self) -> FloatArray:
        """Return the right and left end (2, 3) of its width [mm]."""
        side = np.array([self.half_width, 0.0, 0.0])
        return np.stack([self.centre - side, self.centre + side])

    def bind(self, context: FaceContext) -> BoundField:
        """Precompute the field at contraction 1."""
        lips = context.mechanics.lips
        own = lips.to_upper if self.lip == "upper" else lips.to_lower
        other = lips.to_lower if self.lip == "upper" else lips.to_upper
        mine = own < other
        near = smooth_step(1.0 - own / self.height)
        # Behind the contact line the lip is folded already and goes along as a whole.
        reach = np.where(lips.inside, smooth_step(1.0 - own / (0.8 * self.height)), near)
        beside = np.abs(context.positions[:, 0] - self.centre[0]) / self.half_width
        across = smooth_step((1.0 - beside) / 0.6)
        weight = reach * across * mine * context.regions.mobility
        sign = -1.0 if self.lip == "upper" else 1.0
        field = np.zeros((len(weight), 3))
        field[:, 1] = sign * self.over * weight
        field[:, 2] = -self.back * weight
        vertices = np.flatnonzero(weight > 0.0).astype(np.int32)
        return BoundField(vertices, field[vertices])

    def to_json(self) -> dict[str, Any]:
        """Return the recipe entry."""
        return {
            "name": self.name,
            "kind": "roll",
            "lip": self.lip,
            "centre": self.centre.round(3).tolist(),
            "half_width": round(self.half_width, 3),
            "height": round(self.height, 3),
            "back": round(self.back, 3),
            "over": round(self.over, 3),
        }


def _read(entry: Mapping[str, Any], where: str) -> RollMuscle:
    lip = one_of(f"{where}: lip", str(entry.get("lip")), ("upper", "lower"))
    return RollMuscle(
        str(entry["name"]),
        cast(Literal["upper", "lower"], lip),
        read_vector(entry, "centre", where),
        as_number(f"{where}: half_width", entry.get("half_width"), low=1e-6),
        as_number(f"{where}: height", entry.get("height"), low=1e-6),
        as_number(f"{where}: back", entry.get("back")),
        as_number(f"{where}: over", entry.get("over")),
    )


register_kind("roll", _read)
