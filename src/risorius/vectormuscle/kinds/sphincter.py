"""Circular muscle: draws skin towards a centre inside an ellipse, and forwards."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from risorius._check import FloatArray, IntArray, as_number
from risorius.anatomy.smooth_step import smooth_step
from risorius.errors import ParameterError
from risorius.vectormuscle.muscle import (
    MIRROR,
    FaceContext,
    Warp,
    mirrored_name,
    read_vector,
    register_kind,
)

__all__ = ["BoundField", "SphincterMuscle"]


@dataclass(frozen=True, eq=False)
class SphincterMuscle:
    """Ellipse rule of the thesis (4.16-4.18, corrected: errata E15-E17) for skin.

    With ``rho = sqrt((x/a)^2 + (y/b)^2)`` in the plane of the muscle, skin moves by
    ``-c w(rho) (sx x, sy y)`` in the plane and ``c w(rho) f`` forwards, where w is 1 up to
    `inner` and falls smoothly to 0 at rho = 1.

    Parameters
    ----------
    name : str
    centre : (3,) float64
        [mm]
    radii : (float, float)
        Half axes a (sideways) and b (upwards) [mm].
    shrink : (float, float)
        sx and sy, shares of the distance to the centre.
    forward : float
        f [mm]; positive purses.
    part : float
        Upper and lower lip move apart by this much each [mm]; negative presses them.
    inner : float
        rho up to which the effect is full.
    lower_only : float
        0 moves all round, 1 only below the centre (the cheek raiser round the eye).
    """

    name: str
    centre: FloatArray
    radii: tuple[float, float]
    shrink: tuple[float, float]
    forward: float = 0.0
    part: float = 0.0
    inner: float = 0.3
    lower_only: float = 0.0

    def __post_init__(self) -> None:
        if min(self.radii) <= 0.0:
            raise ParameterError(f"muscle {self.name}: radii must be above 0")

    def mirrored(self) -> SphincterMuscle:
        """Return the muscle of the other side."""
        return replace(self, name=mirrored_name(self.name), centre=self.centre * MIRROR)

    def fitted(self, warp: Warp) -> SphincterMuscle:
        """Return the muscle carried by `warp`; half axes follow their end points."""
        side = np.array([self.radii[0], 0.0, 0.0])
        up = np.array([0.0, self.radii[1], 0.0])
        c = self.centre
        ends = warp(np.stack([c, c - side, c + side, c - up, c + up]))
        a = 0.5 * float(np.linalg.norm(ends[2] - ends[1]))
        b = 0.5 * float(np.linalg.norm(ends[4] - ends[3]))
        scale = a / self.radii[0]
        return replace(
            self,
            centre=ends[0],
            radii=(a, b),
            forward=scale * self.forward,
            part=scale * self.part,
        )

    def ends(self) -> FloatArray:
        """Return the right and left end (2, 3) of its width [mm]."""
        side = np.array([self.radii[0], 0.0, 0.0])
        return np.stack([self.centre - side, self.centre + side])

    def bind(self, context: FaceContext) -> BoundField:
        """Precompute the field at contraction 1."""
        offset = context.positions - self.centre
        x, y = offset[:, 0], offset[:, 1]
        rho = np.sqrt((x / self.radii[0]) ** 2 + (y / self.radii[1]) ** 2)
        weight = smooth_step((1.0 - rho) / (1.0 - self.inner))
        depth = 2.0 * max(self.radii)
        weight = weight * smooth_step((depth - np.abs(offset[:, 2])) / (0.4 * depth))
        if self.lower_only:
            above = smooth_step(0.5 + y / (0.5 * self.radii[1]))
            weight = weight * (1.0 - self.lower_only * above)
        weight = weight * context.regions.mobility
        field = np.stack(
            [-self.shrink[0] * x, -self.shrink[1] * y, np.full(len(x), self.forward)], axis=1
        )
        if self.part:
            share = context.mechanics.lips.share()
            side = 1.0 - 2.0 * smooth_step(0.5 + 2.0 * (share - 0.5))
            fade = 1.0 - smooth_step(np.abs(x) / self.radii[0])
            field[:, 1] += self.part * side * fade
        field *= weight[:, None]
        vertices = np.flatnonzero(weight > 0.0).astype(np.int32)
        return BoundField(vertices, field[vertices])

    def to_json(self) -> dict[str, Any]:
        """Return the recipe entry."""
        entry: dict[str, Any] = {
            "name": self.name,
            "kind": "sphincter",
            "centre": self.centre.round(3).tolist(),
            "radii": [round(r, 3) for r in self.radii],
            "shrink": list(self.shrink),
            "forward": round(self.forward, 3),
            "part": round(self.part, 3),
            "inner": self.inner,
        }
        if self.lower_only:
            entry["lower_only"] = self.lower_only
        return entry


@dataclass(frozen=True, eq=False)
class BoundField:
    """Zone of a muscle whose effect is a fixed field (k, 3) [mm] at contraction 1."""

    vertices: IntArray
    field: FloatArray

    def displace(self, points: FloatArray, contraction: float) -> FloatArray:
        """Return the field (k, 3) times contraction; `points` do not matter."""
        return contraction * self.field


def _read(entry: Mapping[str, Any], where: str) -> SphincterMuscle:
    def pair(key: str) -> tuple[float, float]:
        values = entry.get(key)
        if not isinstance(values, list) or len(values) != 2:
            raise ParameterError(f"{where}: {key} must be two numbers")
        return as_number(f"{where}: {key}", values[0]), as_number(f"{where}: {key}", values[1])

    return SphincterMuscle(
        str(entry["name"]),
        read_vector(entry, "centre", where),
        pair("radii"),
        pair("shrink"),
        as_number(f"{where}: forward", entry.get("forward", 0.0)),
        as_number(f"{where}: part", entry.get("part", 0.0)),
        as_number(f"{where}: inner", entry.get("inner", 0.3), low=0.0, high=0.95),
        as_number(f"{where}: lower_only", entry.get("lower_only", 0.0), low=0.0, high=1.0),
    )


register_kind("sphincter", _read)
