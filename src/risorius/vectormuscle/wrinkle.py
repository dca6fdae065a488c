"""Wrinkles across a muscle: a row of parabolas that rises with the contraction."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any, Protocol, cast, runtime_checkable

import numpy as np

from risorius._check import FloatArray, IntArray, as_number
from risorius.errors import ParameterError
from risorius.vectormuscle.muscle import FaceContext, VectorMuscle

__all__ = [
    "BoundWrinkles",
    "WrinkleZone",
    "Wrinkles",
    "bind_all_wrinkles",
    "bind_wrinkles",
    "raise_wrinkles",
    "read_wrinkles",
    "wrinkle_field",
]

# A parabola needs this many vertices; fewer make a zigzag.
_FEWEST = 4.0
# The mesh is measured where the effect exceeds this share of its maximum.
_CORE = 0.3


@dataclass(frozen=True)
class Wrinkles:
    """How a muscle wrinkles the skin.

    Parameters
    ----------
    count : int
        Wrinkles along the compressed part of the zone.
    height : float
        Height of a ridge at contraction 1 and full effect, as a share of its width.
    """

    count: int = 4
    height: float = 0.15

    def to_json(self) -> dict[str, Any]:
        """Return the recipe entry."""
        return {"count": self.count, "height": self.height}


@dataclass(frozen=True, eq=False)
class WrinkleZone:
    """Where a muscle wrinkles a skin of n vertices.

    Parameters
    ----------
    place : (n,) float64
        Place along the muscle, 0 to 1 over the part that wrinkles.
    effect : (n,) float64
        Effect of the muscle, 0 to 1.
    length : float
        Length of that part [mm].
    """

    place: FloatArray
    effect: FloatArray
    length: float


@runtime_checkable
class WrinklingMuscle(Protocol):
    """A muscle of a kind that can wrinkle the skin."""

    @property
    def name(self) -> str:
        """Control name."""
        ...

    @property
    def wrinkles(self) -> Wrinkles | None:
        """What the recipe asks for."""
        ...

    def wrinkle_zone(self, context: FaceContext) -> WrinkleZone:
        """Return where the skin is compressed."""
        ...


@dataclass(frozen=True, eq=False)
class BoundWrinkles:
    """Ridges on one face: `height` (k,) [mm] at contraction 1 along `normals` (k, 3)."""

    vertices: IntArray
    height: FloatArray
    normals: FloatArray


def wrinkle_field(zone: WrinkleZone, wrinkles: Wrinkles) -> FloatArray:
    """Return the height (n,) [mm] of the wrinkles at contraction 1.

    ``h = H (1 - q^2)`` with the phase q in [-1, 1] in each wrinkle and
    ``H = height * length / count * effect``; 0 at the borders of the zone (spec vector-muscles
    2.3; ours, the paper refers to another one).
    """
    inside = (zone.place > 0.0) & (zone.place < 1.0)
    phase = 2.0 * np.mod(zone.place * wrinkles.count, 1.0) - 1.0
    ridge = wrinkles.height * zone.length / wrinkles.count
    return np.where(inside, ridge * zone.effect * (1.0 - phase * phase), 0.0)


def bind_all_wrinkles(
    muscles: Iterable[VectorMuscle], context: FaceContext, *, faces: IntArray
) -> tuple[dict[str, BoundWrinkles], tuple[str, ...]]:
    """Return the ridges of all muscles that ask for any, and notes about those left out."""
    bound: dict[str, BoundWrinkles] = {}
    notes: list[str] = []
    for muscle in muscles:
        if not isinstance(muscle, WrinklingMuscle) or muscle.wrinkles is None:
            continue
        result = bind_wrinkles(muscle, muscle.wrinkles, context, faces=faces)
        if isinstance(result, str):
            notes.append(result)
        else:
            bound[muscle.name] = result
    return bound, tuple(notes)


def bind_wrinkles(
    muscle: WrinklingMuscle, wrinkles: Wrinkles, context: FaceContext, *, faces: IntArray
) -> BoundWrinkles | str:
    """Compute the ridges on a face, or the reason (one sentence) why it cannot show them.

    Parameters
    ----------
    muscle : WrinklingMuscle
        Fitted to the face.
    wrinkles : Wrinkles
    context : FaceContext
    faces : (m, 3) int32
        Triangles of the skin; they must be fine enough for a parabola.
    """
    zone = muscle.wrinkle_zone(context)
    each = _vertices_per_wrinkle(zone, wrinkles, context.positions, faces)
    if each < _FEWEST:
        return (
            f"{muscle.name}: wrinkles left out: the skin has {each:.2g} vertices across each, "
            f"{_FEWEST:g} are needed; refine it there or ask for fewer wrinkles"
        )
    height = wrinkle_field(zone, wrinkles)
    vertices = np.flatnonzero(height > 0.0).astype(np.int32)
    return BoundWrinkles(vertices, height[vertices], context.normals[vertices])


def _vertices_per_wrinkle(
    zone: WrinkleZone, wrinkles: Wrinkles, positions: FloatArray, faces: IntArray
) -> float:
    """Return the rows of vertices across one wrinkle, 0 where no edge runs along the muscle."""
    core = (zone.place > 0.0) & (zone.place < 1.0)
    core &= zone.effect > _CORE * zone.effect.max(initial=0.0)
    ends = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    ends = ends[core[ends].all(axis=1)]
    step = zone.length * np.abs(zone.place[ends[:, 0]] - zone.place[ends[:, 1]])
    length = np.linalg.norm(positions[ends[:, 0]] - positions[ends[:, 1]], axis=1)
    lengthwise = step > 0.5 * length
    if not lengthwise.any():
        return 0.0
    return zone.length / wrinkles.count / float(np.median(step[lengthwise]))


def raise_wrinkles(
    bound: Iterable[tuple[BoundWrinkles, float]], vertex_count: int
) -> FloatArray | None:
    """Return the displacement (n, 3) [mm] of wrinkles, each with its contraction.

    Where the wrinkles of two muscles meet the higher one counts, whatever their order. None if
    no muscle with wrinkles is contracted.
    """
    active = [(wrinkles, share) for wrinkles, share in bound if share > 0.0]
    if not active:
        return None
    height = np.zeros(vertex_count)
    normals = np.zeros((vertex_count, 3))
    for wrinkles, share in active:
        rows = wrinkles.vertices
        height[rows] = np.maximum(height[rows], share * wrinkles.height)
        normals[rows] = wrinkles.normals
    return height[:, None] * normals


def read_wrinkles(entry: Mapping[str, Any], where: str) -> Wrinkles | None:
    """Return the ``"wrinkles"`` of a recipe entry, None where it has none.

    Raises
    ------
    ParameterError
        If it is not an object, or a number is out of range.
    """
    value = entry.get("wrinkles")
    if value is None:
        return None
    if not isinstance(value, dict):
        raise ParameterError(f'{where}: wrinkles must be an object, {{"count": 4, "height": 0.15}}')
    given = cast(dict[str, Any], value)
    count = as_number(f"{where}: wrinkles count", given.get("count", 4), low=1.0, high=100.0)
    if count != int(count):
        raise ParameterError(f"{where}: wrinkles count: {count:g} is not a whole number")
    height = given.get("height", Wrinkles.height)
    return Wrinkles(int(count), as_number(f"{where}: wrinkles height", height, low=0.0, high=0.5))
