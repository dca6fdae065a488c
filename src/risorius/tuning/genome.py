"""What can be tuned: named parameters with bounds, and their binary code."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from risorius._check import FloatArray, as_number
from risorius.errors import ParameterError, ShapeError
from risorius.tuning.gray import BitArray, from_gray_bits, to_gray_bits

__all__ = ["Genome", "Parameter"]


@dataclass(frozen=True)
class Parameter:
    """One number that may be tuned.

    Parameters
    ----------
    name : str
    low, high : float
        Bounds.
    start : float
        Value before tuning.
    """

    name: str
    low: float
    high: float
    start: float

    def __post_init__(self) -> None:
        low = as_number(f"{self.name}: low", self.low)
        high = as_number(f"{self.name}: high", self.high)
        if not low < high:
            raise ParameterError(f"{self.name}: low {low:g} must be below high {high:g}")
        as_number(f"{self.name}: start", self.start, low=low, high=high)


@dataclass(frozen=True)
class Genome:
    """Parameters in a fixed order.

    Parameters
    ----------
    parameters : tuple of Parameter
        Names are unique; at least one.
    bits : int
        Bits per parameter of the binary code.
    """

    parameters: tuple[Parameter, ...]
    bits: int = 8

    def __post_init__(self) -> None:
        if not self.parameters:
            raise ParameterError("genome: nothing to tune; give at least one parameter")
        if not 1 <= self.bits <= 24:
            raise ParameterError(f"genome: bits: {self.bits} must lie in 1..24")
        twice = sorted({name for name in self.names if self.names.count(name) > 1})
        if twice:
            raise ParameterError(f"genome: {', '.join(twice)} is listed twice")

    def __len__(self) -> int:
        return len(self.parameters)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the parameters."""
        return tuple(parameter.name for parameter in self.parameters)

    @property
    def low(self) -> FloatArray:
        """Lower bounds (p,)."""
        return np.array([parameter.low for parameter in self.parameters])

    @property
    def high(self) -> FloatArray:
        """Upper bounds (p,)."""
        return np.array([parameter.high for parameter in self.parameters])

    @property
    def start(self) -> FloatArray:
        """Values (p,) before tuning."""
        return np.array([parameter.start for parameter in self.parameters])

    def named(self, values: npt.ArrayLike) -> dict[str, float]:
        """Return `values` (p,) by name."""
        row = self.as_values(values)
        return dict(zip(self.names, row.tolist(), strict=True))

    def values(self, named: Mapping[str, float]) -> FloatArray:
        """Return values (p,) from names; what is left out stays at its start.

        Raises
        ------
        ParameterError
            If a name is unknown or a value out of bounds.
        """
        result = self.start
        for row in self.rows(named):
            parameter = self.parameters[row]
            place = f"genome: {parameter.name}"
            number = as_number(place, named[parameter.name], low=parameter.low, high=parameter.high)
            result[row] = number
        return result

    def rows(self, names: Iterable[str]) -> list[int]:
        """Return the places of parameters.

        Raises
        ------
        ParameterError
            If a name is unknown.
        """
        known = {name: row for row, name in enumerate(self.names)}
        wanted = list(names)
        unknown = [name for name in wanted if name not in known]
        if unknown:
            raise ParameterError(
                f"genome: there is no {', '.join(unknown)}; it has {', '.join(self.names[:12])}"
                f"{' ...' if len(self) > 12 else ''}"
            )
        return [known[name] for name in wanted]

    def as_values(self, values: npt.ArrayLike) -> FloatArray:
        """Return `values` as a finite (p,) array.

        Raises
        ------
        ShapeError
            If there are more or fewer values than parameters, or one is not finite.
        """
        row = np.asarray(values, dtype=np.float64)
        if row.shape != (len(self),) or not np.isfinite(row).all():
            raise ShapeError(f"values: expected {len(self)} finite numbers, got {row.shape}")
        return row

    def encode(self, values: FloatArray, *, low: FloatArray, high: FloatArray) -> BitArray:
        """Return the chromosome (p, n) of values.

        ``code = floor(2^n (v - low) / (high - low))``, clamped to 2^n - 1 (erratum E6), in Gray
        code.

        Parameters
        ----------
        values : (p,) float64
        low, high : (p,) float64
            Range of the code, which shrinks while one tunes.
        """
        count = 1 << self.bits
        place = (values - low) / np.maximum(high - low, 1e-300)
        codes = np.clip(np.floor(count * np.clip(place, 0.0, 1.0)), 0, count - 1)
        return to_gray_bits(codes.astype(np.int32), self.bits)

    def decode(self, chromosome: BitArray, *, low: FloatArray, high: FloatArray) -> FloatArray:
        """Return the values (p,) of a chromosome (p, n): the middle of each quantum.

        Parameters
        ----------
        chromosome : (p, n) uint8
        low, high : (p,) float64
        """
        codes = from_gray_bits(chromosome)
        return low + (codes + 0.5) / (1 << self.bits) * (high - low)
