"""Sheet muscle: parallel fibres that shorten about a fixed line (after Waters 1987)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from risorius._check import FloatArray, IntArray, as_number
from risorius.anatomy.smooth_step import smooth_step
from risorius.errors import ParameterError
from risorius.vectormuscle.kinds.drag import drag_field
from risorius.vectormuscle.kinds.fields import read_regions
from risorius.vectormuscle.kinds.sphincter import BoundField
from risorius.vectormuscle.muscle import (
    MIRROR,
    FaceContext,
    Warp,
    mirrored_name,
    read_vector,
    register_kind,
)
from risorius.vectormuscle.wrinkle import Wrinkles, WrinkleZone, read_wrinkles

__all__ = ["SheetMuscle"]


# Share of the half width over which a sheet pulls with full strength.
_PLATEAU = 0.45


@dataclass(frozen=True, eq=False)
class SheetMuscle:
    """Fibres side by side, all parallel to the line from origin to insertion.

    Along the fibre, from the origin at 0 to the insertion at L, skin moves towards the fixed
    line at ``fixed L``: fully at the insertion, in proportion between, the other way above it.
    Beyond both ends the motion fades. Frontalis works so: the brow rises and the upper forehead
    comes down (spec anatomy-pbd T1).

    Parameters
    ----------
    name : str
    origin, insertion : (3,) float64
        Middle of the two ends [mm].
    half_width : float
        Where the effect ends sideways [mm].
    pull : float
        Motion of the insertion at contraction 1 [mm].
    fixed : float
        Place of the fixed line, share of L.
    fade_origin, fade_insertion : float
        Reach of the fade beyond the ends, shares of L.
    regions : tuple of str
        Regions it may move; empty for all.
    wrinkles : Wrinkles, optional
        Across the fibres, between origin and insertion.
    out : float
        Outward push at full effect, in pulls: tissue that bunches up.
    drag : float
        Share of the pull with which skin around the insertion follows; 0 for none.
    reach : float
        How far from the insertion skin follows [mm].
    """

    name: str
    origin: FloatArray
    insertion: FloatArray
    half_width: float
    pull: float
    fixed: float = 0.0
    fade_origin: float = 0.3
    fade_insertion: float = 0.4
    regions: tuple[str, ...] = ()
    wrinkles: Wrinkles | None = None
    out: float = 0.0
    drag: float = 0.0
    reach: float = 60.0

    def __post_init__(self) -> None:
        if float(np.linalg.norm(self.insertion - self.origin)) == 0.0:
            raise ParameterError(f"muscle {self.name}: origin and insertion are one point")
        as_number(f"muscle {self.name}: drag", self.drag, low=0.0, high=1.0)
        as_number(f"muscle {self.name}: reach", self.reach, low=1e-6)

    def mirrored(self) -> SheetMuscle:
        """Return the muscle of the other side."""
        return replace(
            self,
            name=mirrored_name(self.name),
            origin=self.origin * MIRROR,
            insertion=self.insertion * MIRROR,
        )

    def fitted(self, warp: Warp) -> SheetMuscle:
        """Return the muscle carried by `warp`; width and pull scale with the local stretch."""
        origin, insertion = warp(np.stack([self.origin, self.insertion]))
        before = float(np.linalg.norm(self.insertion - self.origin))
        scale = float(np.linalg.norm(insertion - origin)) / before
        return replace(
            self,
            origin=origin,
            insertion=insertion,
            half_width=scale * self.half_width,
            pull=scale * self.pull,
            reach=scale * self.reach,
        )

    def ends(self) -> FloatArray:
        """Return origin and insertion (2, 3) [mm]."""
        return np.stack([self.origin, self.insertion])

    def profile(self, place: FloatArray) -> FloatArray:
        """Return the motion (n,) along the fibre at `place` (n,), 0 origin to 1 insertion."""
        inner = (place - self.fixed) / (1.0 - self.fixed)
        at_origin = -self.fixed / (1.0 - self.fixed)
        above = at_origin * smooth_step(1.0 + place / self.fade_origin)
        below = smooth_step(1.0 - (place - 1.0) / self.fade_insertion)
        return np.where(place < 0.0, above, np.where(place > 1.0, below, inner))

    @property
    def length(self) -> float:
        """Length of the fibres [mm]."""
        return float(np.linalg.norm(self.insertion - self.origin))

    @property
    def axis(self) -> FloatArray:
        """Direction (3,) of the fibres, from origin to insertion."""
        return (self.insertion - self.origin) / self.length

    def wrinkle_zone(self, context: FaceContext) -> WrinkleZone:
        """Return where the skin is compressed: between origin and insertion."""
        offset = context.positions - self.origin
        # The skull is round: distance sideways is measured along the face, not in depth.
        across = np.cross(self.axis, np.array([0.0, 0.0, 1.0]))
        across /= np.linalg.norm(across)
        aside = np.abs(offset @ across) / self.half_width
        # Full over the inner part, so that neighbouring sheets join without a dip.
        effect = smooth_step((1.0 - aside) / (1.0 - _PLATEAU))
        if self.regions:
            effect = effect * context.regions.permission(self.regions)
        effect = effect * context.regions.mobility
        return WrinkleZone(offset @ self.axis / self.length, effect, self.length)

    def bind(self, context: FaceContext) -> BoundField:
        """Precompute the field at contraction 1."""
        zone, axis = self.wrinkle_zone(context), self.axis
        effect = self.profile(zone.place) * zone.effect
        # Each point moves along its own support, so that the forehead keeps its curve.
        along = axis - (context.outward @ axis)[:, None] * context.outward
        along /= np.maximum(np.linalg.norm(along, axis=1, keepdims=True), 1e-12)
        field = -self.pull * effect[:, None] * along
        if self.drag and context.drag:
            rows, dragged = self._dragged(effect, context)
            field[rows] += dragged
        if self.out:
            push = self.out * np.linalg.norm(field, axis=1, keepdims=True)
            field = field + push * context.normals
        vertices = np.flatnonzero(field.any(axis=1)).astype(np.int32)
        return BoundField(vertices, field[vertices])

    def _dragged(self, effect: FloatArray, context: FaceContext) -> tuple[IntArray, FloatArray]:
        """Return vertices and field (k, 3) [mm] of what follows beside and below the sheet."""
        free = context.regions.mobility * (1.0 - np.clip(np.abs(effect), 0.0, 1.0))
        if self.regions:
            free = free * context.regions.permission(self.regions)
        amount = self.drag * self.pull * free
        return drag_field(context, self.ends(), amount, reach=self.reach)

    def to_json(self) -> dict[str, Any]:
        """Return the recipe entry."""
        entry: dict[str, Any] = {
            "name": self.name,
            "kind": "sheet",
            "origin": self.origin.round(3).tolist(),
            "insertion": self.insertion.round(3).tolist(),
            "half_width": round(self.half_width, 3),
            "pull": round(self.pull, 3),
            "fixed": self.fixed,
            "fade_origin": self.fade_origin,
            "fade_insertion": self.fade_insertion,
        }
        if self.regions:
            entry["regions"] = list(self.regions)
        if self.out:
            entry["out"] = self.out
        if self.drag:
            entry |= {"drag": self.drag, "reach": round(self.reach, 3)}
        if self.wrinkles:
            entry["wrinkles"] = self.wrinkles.to_json()
        return entry


def _read(entry: Mapping[str, Any], where: str) -> SheetMuscle:
    return SheetMuscle(
        str(entry["name"]),
        read_vector(entry, "origin", where),
        read_vector(entry, "insertion", where),
        as_number(f"{where}: half_width", entry.get("half_width"), low=1e-6),
        as_number(f"{where}: pull", entry.get("pull")),
        as_number(f"{where}: fixed", entry.get("fixed", 0.0), low=0.0, high=0.9),
        as_number(f"{where}: fade_origin", entry.get("fade_origin", 0.3), low=1e-6),
        as_number(f"{where}: fade_insertion", entry.get("fade_insertion", 0.4), low=1e-6),
        read_regions(entry, where),
        read_wrinkles(entry, where),
        as_number(f"{where}: out", entry.get("out", 0.0)),
        as_number(f"{where}: drag", entry.get("drag", 0.0), low=0.0, high=1.0),
        as_number(f"{where}: reach", entry.get("reach", 60.0), low=1e-6),
    )


register_kind("sheet", _read)
