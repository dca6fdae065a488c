"""Constraints between particles, one table per kind.

Every table holds plain arrays: which particles, the rest value, and the stiffness k in [0, 1], the
share of its error that one projection removes (thesis section 3.2.3).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from risorius._check import FloatArray, IntArray, as_number
from risorius.errors import ParameterError, ShapeError

__all__ = ["Areas", "Bends", "Constraints", "Contacts", "Distances", "Holds", "Volume"]


def _particles(name: str, value: npt.ArrayLike, columns: int) -> IntArray:
    table = np.asarray(value)
    if table.size == 0:
        return np.zeros((0, columns) if columns > 1 else (0,), np.int32)
    shaped = table.ndim == 2 and table.shape[1] == columns if columns > 1 else table.ndim == 1
    if not shaped or not np.issubdtype(table.dtype, np.integer):
        rule = f"(k, {columns})" if columns > 1 else "(k,)"
        raise ShapeError(f"{name}: expected integers of shape {rule}, got {table.shape}")
    if columns > 1:
        ordered = np.sort(table, axis=1)
        twice = (ordered[:, 1:] == ordered[:, :-1]).any(axis=1)
        if twice.any():
            row = int(np.argmax(twice))
            raise ShapeError(f"{name}: row {row} is {table[row].tolist()}, it names one twice")
    return np.ascontiguousarray(table, np.int32)


def _numbers(name: str, value: npt.ArrayLike, count: int) -> FloatArray:
    numbers = np.array(np.broadcast_to(np.asarray(value, np.float64), (count,)))
    bad = ~np.isfinite(numbers)
    if bad.any():
        row = int(np.argmax(bad))
        raise ShapeError(f"{name}: entry {row} is {numbers[row]}, every entry must be finite")
    return numbers


def _stiffness(name: str, value: npt.ArrayLike, count: int) -> FloatArray:
    numbers = _numbers(name, value, count)
    bad = (numbers < 0.0) | (numbers > 1.0)
    if bad.any():
        row = int(np.argmax(bad))
        raise ParameterError(f"{name}: entry {row} is {numbers[row]:g}, must lie in 0..1")
    return numbers


def _settle_fields(table: Distances | Bends | Areas | Holds, name: str, columns: int) -> None:
    """Check and store the fields that all tables share: the particles and the stiffness."""
    particles = _particles(f"{name}.particles", table.particles, columns)
    object.__setattr__(table, "particles", particles)
    stiffness = _stiffness(f"{name}.stiffness", table.stiffness, len(particles))
    object.__setattr__(table, "stiffness", stiffness)


@dataclass(frozen=True, eq=False)
class Distances:
    """Keep two particles apart: C = |p1 - p2| - d.

    Parameters
    ----------
    particles : (k, 2) int32
    rest : (k,) float64
        Distance d [mm].
    stiffness : (k,) float64
        Or one number for all.
    """

    particles: IntArray = field(default_factory=lambda: np.zeros((0, 2), np.int32))
    rest: FloatArray = field(default_factory=lambda: np.zeros(0))
    stiffness: FloatArray = field(default_factory=lambda: np.zeros(0))

    def __post_init__(self) -> None:
        _settle_fields(self, "distances", 2)
        rest = _numbers("distances.rest", self.rest, len(self.particles))
        if (rest < 0.0).any():
            row = int(np.argmax(rest < 0.0))
            raise ParameterError(f"distances.rest: entry {row} is {rest[row]:g}, below 0")
        object.__setattr__(self, "rest", rest)

    @staticmethod
    def joined(tables: Sequence[Distances]) -> Distances:
        """Return one table with the rows of all, in order."""
        if not tables:
            return Distances()
        return Distances(
            np.concatenate([table.particles for table in tables]),
            np.concatenate([table.rest for table in tables]),
            np.concatenate([table.stiffness for table in tables]),
        )


@dataclass(frozen=True, eq=False)
class Bends:
    """Keep the angle between two triangles that share an edge: C = theta - theta0.

    Particles p1, p2 end the edge, p3 and p4 are the far corners. With e = p2 - p1,
    n1 = e x (p3 - p1), n2 = (p4 - p1) x e: theta = atan2((n1 x n2) . e / |e|, n1 . n2), signed,
    0 where flat (erratum E3: the published acos confuses a bump with a dent and has no gradient
    where flat).

    Parameters
    ----------
    particles : (k, 4) int32
    rest : (k,) float64
        Angle theta0 [rad].
    stiffness : (k,) float64
        Or one number for all.
    """

    particles: IntArray = field(default_factory=lambda: np.zeros((0, 4), np.int32))
    rest: FloatArray = field(default_factory=lambda: np.zeros(0))
    stiffness: FloatArray = field(default_factory=lambda: np.zeros(0))

    def __post_init__(self) -> None:
        _settle_fields(self, "bends", 4)
        rest = _numbers("bends.rest", self.rest, len(self.particles))
        object.__setattr__(self, "rest", rest)


@dataclass(frozen=True, eq=False)
class Areas:
    """Keep the area of a triangle: C = |(p2 - p1) x (p3 - p1)| / 2 - A0.

    Parameters
    ----------
    particles : (k, 3) int32
    rest : (k,) float64
        Area A0 [mm^2].
    stiffness : (k,) float64
        Or one number for all.
    """

    particles: IntArray = field(default_factory=lambda: np.zeros((0, 3), np.int32))
    rest: FloatArray = field(default_factory=lambda: np.zeros(0))
    stiffness: FloatArray = field(default_factory=lambda: np.zeros(0))

    def __post_init__(self) -> None:
        _settle_fields(self, "areas", 3)
        rest = _numbers("areas.rest", self.rest, len(self.particles))
        if (rest <= 0.0).any():
            row = int(np.argmax(rest <= 0.0))
            raise ParameterError(f"areas.rest: entry {row} is {rest[row]:g}, must be above 0")
        object.__setattr__(self, "rest", rest)


@dataclass(frozen=True, eq=False)
class Volume:
    """Keep the volume inside a surface: C = 1/6 sum (p_a x p_b) . p_c - V0.

    The sum runs over `faces` and over a fan that joins each hole's rim to its centroid, without
    which it would depend on the origin (erratum E5).

    Parameters
    ----------
    faces : (m, 3) int32
    rest : float
        Volume V0 [mm^3], of the same sign as the sum.
    stiffness : float
    holes : tuple of (k,) int32
        Rims, each running along the sides of its faces.
    """

    faces: IntArray
    rest: float
    stiffness: float = 1.0
    holes: tuple[IntArray, ...] = ()

    def __post_init__(self) -> None:
        object.__setattr__(self, "faces", _particles("volume.faces", self.faces, 3))
        rims = tuple(_particles("volume.holes", rim, 1) for rim in self.holes)
        object.__setattr__(self, "holes", rims)
        object.__setattr__(self, "rest", as_number("volume.rest", self.rest))
        stiffness = as_number("volume.stiffness", self.stiffness, low=0.0, high=1.0)
        object.__setattr__(self, "stiffness", stiffness)


@dataclass(frozen=True, eq=False)
class Holds:
    """Draw single particles to targets that the control gives: p += k (q - p).

    Parameters
    ----------
    particles : (k,) int32
    stiffness : (k,) float64
        Or one number for all.
    """

    particles: IntArray = field(default_factory=lambda: np.zeros(0, np.int32))
    stiffness: FloatArray = field(default_factory=lambda: np.zeros(0))

    def __post_init__(self) -> None:
        _settle_fields(self, "holds", 1)


@dataclass(frozen=True, eq=False)
class Contacts:
    """Keep particles on the outer side of planes: (p - q) . n >= 0, for one step.

    Parameters
    ----------
    particles : (k,) int32
    points : (k, 3) float64
        Point q of each plane [mm]; (s, k, 3) for s poses at once.
    normals : (k, 3) float64
        Unit normals towards the free side; (s, k, 3) for s poses at once. A normal of zero
        switches a contact off.
    stiffness : float
    """

    particles: IntArray
    points: FloatArray
    normals: FloatArray
    stiffness: float = 1.0

    def __post_init__(self) -> None:
        particles = _particles("contacts.particles", self.particles, 1)
        object.__setattr__(self, "particles", particles)
        for name in ("points", "normals"):
            value = np.ascontiguousarray(getattr(self, name), np.float64)
            if value.ndim not in (2, 3) or value.shape[-2:] != (len(particles), 3):
                raise ShapeError(
                    f"contacts.{name}: expected shape ({len(particles)}, 3) or "
                    f"(s, {len(particles)}, 3), got {value.shape}"
                )
            if not np.isfinite(value).all():
                raise ShapeError(f"contacts.{name}: every entry must be finite")
            object.__setattr__(self, name, value)
        if self.points.shape != self.normals.shape:
            raise ShapeError(
                f"contacts: points {self.points.shape} and normals {self.normals.shape} differ"
            )
        stiffness = as_number("contacts.stiffness", self.stiffness, low=0.0, high=1.0)
        object.__setattr__(self, "stiffness", stiffness)


@dataclass(frozen=True, eq=False)
class Constraints:
    """Everything that holds between the particles of one model.

    Projected in this order (open point O3): holds, distances, areas, bends, volumes, and last the
    contacts that the control brings.
    """

    distances: Distances = field(default_factory=Distances)
    areas: Areas = field(default_factory=Areas)
    bends: Bends = field(default_factory=Bends)
    volumes: tuple[Volume, ...] = ()
    holds: Holds = field(default_factory=Holds)

    @property
    def count(self) -> int:
        """Number of constraints."""
        tables = (self.distances, self.areas, self.bends, self.holds)
        return sum(len(table.particles) for table in tables) + len(self.volumes)
