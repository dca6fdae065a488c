"""Linear muscle: pulls skin towards its origin inside a cone (Waters 1987, Bui et al. 2003)."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from risorius._check import FloatArray, IntArray, as_number
from risorius.anatomy.smooth_step import smooth_step
from risorius.errors import ParameterError, RisoriusWarning
from risorius.vectormuscle.kernels.pull import pull_towards
from risorius.vectormuscle.kinds.drag import drag_field
from risorius.vectormuscle.kinds.fields import read_regions
from risorius.vectormuscle.muscle import (
    MIRROR,
    FaceContext,
    Warp,
    mirrored_name,
    read_vector,
    register_kind,
)
from risorius.vectormuscle.profile import angular_factor, fold_limit, radial_factor
from risorius.vectormuscle.wrinkle import Wrinkles, WrinkleZone, read_wrinkles

__all__ = ["MOST_STRENGTH", "BoundLinear", "LinearMuscle"]

# Published k is not given; ours: this share of the shorter of the two radii.
_PULL = 0.4
MOST_STRENGTH = 0.98 * fold_limit(start_radius=1.0, finish_radius=2.0) / _PULL
"""Greatest strength of a linear muscle; more would reach the fold limit of the profile."""
# Skin that slides instead of sinking keeps its length up to this factor.
MOST_STRETCH = 1.6
# Skin goes back within this share of the muscle's length around its insertion.
_SINK_REACH = 0.6
# Wrinkles begin at this share of the start radius: at the bone there is no skin to fold.
_FIRST_WRINKLE = 0.2


@dataclass(frozen=True, eq=False)
class LinearMuscle:
    """Ten numbers and a region.

    Parameters
    ----------
    name : str
        Control name.
    origin, insertion : (3,) float64
        Bony end and skin end [mm].
    start_radius, finish_radius : float
        Where the fall-off starts and ends, from the origin [mm].
    half_angle : float
        Half opening of the zone [deg].
    strength : float
        Contraction scale g.
    regions : tuple of str
        Regions it may move; empty for all.
    out : float
        Outward push at full effect, in pulls: tissue that bunches up.
    corner : float
        How far the muscle holds the mouth corner and lets the body of the lips lag: 0 pulls the
        whole lip, 1 leaves its middle.
    wrinkles : Wrinkles, optional
        Across the muscle, between a fifth of the start radius and the start radius.
    drag : float
        Share of the pull with which skin around the insertion follows, cone or not; 0 is the
        published muscle.
    reach : float
        How far from the insertion skin follows [mm].
    bulge : float
        Outward push of the skin that follows, in its motion; negative sinks.
    sink : float
        Inward push around the insertion, in pulls: a mouth corner that is drawn aside goes back
        around the teeth; unpublished.
    """

    name: str
    origin: FloatArray
    insertion: FloatArray
    start_radius: float
    finish_radius: float
    half_angle: float
    strength: float = 1.0
    regions: tuple[str, ...] = ()
    out: float = 0.0
    corner: float = 0.0
    wrinkles: Wrinkles | None = None
    drag: float = 0.0
    reach: float = 60.0
    bulge: float = 0.0
    sink: float = 0.0

    def __post_init__(self) -> None:
        if float(np.linalg.norm(self.insertion - self.origin)) == 0.0:
            raise ParameterError(f"muscle {self.name}: origin and insertion are one point")
        as_number(f"muscle {self.name}: drag", self.drag, low=0.0, high=1.0)
        as_number(f"muscle {self.name}: reach", self.reach, low=1e-6)
        as_number(f"muscle {self.name}: sink", self.sink, low=-1.0, high=2.0)
        if self.strength > MOST_STRENGTH:
            _warn(
                f"muscle {self.name}: strength {self.strength:g} would fold the skin; taken as "
                f"{MOST_STRENGTH:.3g}"
            )
            object.__setattr__(self, "strength", MOST_STRENGTH)
        if not 0.0 < self.half_angle < 90.0:
            clamped = float(np.clip(self.half_angle, 1.0, 89.0))
            _warn(f"muscle {self.name}: half_angle {self.half_angle:g} clamped to {clamped:g}")
            object.__setattr__(self, "half_angle", clamped)
        if self.finish_radius <= 0.0:
            raise ParameterError(f"muscle {self.name}: finish_radius must be above 0")
        if not 0.0 < self.start_radius < self.finish_radius:
            clamped = 0.7 * self.finish_radius
            _warn(
                f"muscle {self.name}: start_radius {self.start_radius:g} must lie between 0 and "
                f"finish_radius {self.finish_radius:g}; taken as {clamped:g}"
            )
            object.__setattr__(self, "start_radius", clamped)

    @property
    def pull(self) -> float:
        """Displacement at contraction 1 where the effect is full [mm], below the fold limit."""
        return (
            self.strength * _PULL * min(self.start_radius, self.finish_radius - self.start_radius)
        )

    def mirrored(self) -> LinearMuscle:
        """Return the muscle of the other side."""
        return replace(
            self,
            name=mirrored_name(self.name),
            origin=self.origin * MIRROR,
            insertion=self.insertion * MIRROR,
        )

    def fitted(self, warp: Warp) -> LinearMuscle:
        """Return the muscle carried by `warp`; radii scale with the local stretch [O3]."""
        origin, insertion = warp(np.stack([self.origin, self.insertion]))
        before = float(np.linalg.norm(self.insertion - self.origin))
        scale = float(np.linalg.norm(insertion - origin)) / before
        return replace(
            self,
            origin=origin,
            insertion=insertion,
            start_radius=scale * self.start_radius,
            finish_radius=scale * self.finish_radius,
            reach=scale * self.reach,
        )

    def ends(self) -> FloatArray:
        """Return origin and insertion (2, 3) [mm]."""
        return np.stack([self.origin, self.insertion])

    def influence(self, points: FloatArray, *, smooth: bool = True) -> FloatArray:
        """Return the effect ``r a`` (n,) at `points` (n, 3), 0 outside the zone."""
        offset = points - self.origin
        distance = np.linalg.norm(offset, axis=1)
        along = (self.insertion - self.origin) / np.linalg.norm(self.insertion - self.origin)
        cosine = (offset @ along) / np.maximum(distance, 1e-300)
        angle = np.arccos(np.clip(cosine, -1.0, 1.0))
        radial = radial_factor(
            distance, start_radius=self.start_radius, finish_radius=self.finish_radius
        )
        angular = angular_factor(
            angle,
            half_angle=np.radians(self.half_angle),
            profile="smooth" if smooth else "published",
        )
        return np.where(distance > 0.0, radial * angular, 0.0)

    def _effect(self, context: FaceContext) -> FloatArray:
        """Return the effect (n,) on the skin of a face, where it is permitted."""
        effect = np.zeros(len(context.positions))
        near, _ = context.within(self.origin, self.finish_radius)
        here = self.influence(context.positions[near], smooth=context.angular == "smooth")
        if self.corner:
            here *= 1.0 - self.corner * context.lip_hold.body[near]
        effect[near] = here * context.regions.mobility[near]
        if self.corner:
            effect = np.where(effect > 0.0, context.lip_hold.calmed(effect), 0.0)
        return effect * context.regions.permission(self.regions) if self.regions else effect

    def wrinkle_zone(self, context: FaceContext) -> WrinkleZone:
        """Return where the skin is compressed: between the origin and the start radius."""
        near = _FIRST_WRINKLE * self.start_radius
        length = self.start_radius - near
        distance = np.linalg.norm(context.positions - self.origin, axis=1)
        return WrinkleZone((distance - near) / length, self._effect(context), length)

    def _dragged(self, effect: FloatArray, context: FaceContext) -> tuple[IntArray, FloatArray]:
        """Return vertices and field (k, 3) [mm] of what follows outside the cone."""
        free = context.regions.mobility * (1.0 - np.minimum(effect, 1.0))
        if self.regions:
            free = free * context.regions.permission(self.regions)
        if self.corner:
            free = free * (1.0 - self.corner * context.lip_hold.body)
        amount = self.drag * self.pull * free
        return drag_field(context, self.ends(), amount, reach=self.reach)

    def _sunk(self, context: FaceContext) -> tuple[IntArray, FloatArray]:
        """Return vertices and field (k, 3) [mm] of what goes back around the insertion."""
        radius = _SINK_REACH * float(np.linalg.norm(self.insertion - self.origin))
        rows, offset = context.within(self.insertion, radius)
        near = smooth_step(1.0 - np.linalg.norm(offset, axis=1) / radius)
        amount = self.sink * self.pull * near * context.regions.mobility[rows]
        if self.regions:
            amount *= context.regions.permission(self.regions)[rows]
        return rows, -amount[:, None] * context.outward[rows]

    def bind(self, context: FaceContext) -> BoundLinear:
        """Precompute the zone: permitted vertices with an effect."""
        effect = self._effect(context)
        pull, push = self.pull * effect, self.out * self.pull * effect
        acts, field = effect > 0.0, np.zeros((0, 3))
        if self.drag and context.drag:
            rows, dragged = self._dragged(effect, context)
            field = np.zeros_like(context.positions)
            field[rows] = dragged
            push[rows] += self.bulge * np.linalg.norm(dragged, axis=1)
            acts[rows] |= dragged.any(axis=1)
        if self.sink and context.drag:
            rows, sunk = self._sunk(context)
            field = field if len(field) else np.zeros_like(context.positions)
            field[rows] += sunk
            acts[rows] |= sunk.any(axis=1)
        vertices = np.flatnonzero(acts).astype(np.int32)
        if self.out or len(field):
            out = push[vertices, None] * context.normals[vertices]
            field = field[vertices] + out if len(field) else out
        return BoundLinear(
            vertices,
            pull[vertices],
            self.origin,
            field,
            context.outward[vertices],
            context.support,
        )

    def to_json(self) -> dict[str, Any]:
        """Return the recipe entry."""
        entry: dict[str, Any] = {
            "name": self.name,
            "kind": "linear",
            "origin": self.origin.round(3).tolist(),
            "insertion": self.insertion.round(3).tolist(),
            "start_radius": round(self.start_radius, 3),
            "finish_radius": round(self.finish_radius, 3),
            "half_angle": self.half_angle,
            "strength": self.strength,
        }
        if self.regions:
            entry["regions"] = list(self.regions)
        for key, value in (("out", self.out), ("corner", self.corner), ("sink", self.sink)):
            if value:
                entry[key] = value
        if self.drag:
            entry |= {"drag": self.drag, "reach": round(self.reach, 3), "bulge": self.bulge}
        if self.wrinkles:
            entry["wrinkles"] = self.wrinkles.to_json()
        return entry


@dataclass(frozen=True, eq=False)
class BoundLinear:
    """Zone of a linear muscle: `pull` (k,) [mm] at contraction 1 towards `origin` (3,).

    `support` of the motion against `outward` (k, 3) is taken away: skin slides over bone and
    teeth. `field` (k, 3) [mm] is the rest of the motion: what bulges, and what is dragged along; it
    has no rows where there is none.
    """

    vertices: IntArray
    pull: FloatArray
    origin: FloatArray
    field: FloatArray
    outward: FloatArray
    support: float

    def displace(self, points: FloatArray, contraction: float) -> FloatArray:
        """Return ``-k g c r a d/|d|`` (k, 3): towards the origin (erratum E2)."""
        result = np.empty_like(points)
        pull_towards(
            points, self.origin, self.pull, contraction,
            self.outward, self.support, MOST_STRETCH, self.field, result,
        )  # fmt: skip
        return result


def _warn(message: str) -> None:
    warnings.warn(message, RisoriusWarning, stacklevel=4)


def _read(entry: Mapping[str, Any], where: str) -> LinearMuscle:
    number = {
        key: as_number(f"{where}: {key}", entry.get(key, default))
        for key, default in (
            ("start_radius", None),
            ("finish_radius", None),
            ("half_angle", None),
            ("strength", 1.0),
            ("out", 0.0),
            ("corner", 0.0),
            ("drag", 0.0),
            ("reach", 60.0),
            ("bulge", 0.0),
            ("sink", 0.0),
        )
    }
    return LinearMuscle(
        str(entry["name"]),
        read_vector(entry, "origin", where),
        read_vector(entry, "insertion", where),
        number["start_radius"],
        number["finish_radius"],
        number["half_angle"],
        number["strength"],
        read_regions(entry, where),
        number["out"],
        number["corner"],
        read_wrinkles(entry, where),
        number["drag"],
        number["reach"],
        number["bulge"],
        number["sink"],
    )


register_kind("linear", _read)
