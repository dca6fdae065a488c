"""Refuse numbers that no head can have."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from risorius._check import FloatArray
from risorius.errors import FormatError

__all__ = ["LARGEST", "as_doubles", "first_bad_row", "require_finite"]

LARGEST = 3e38
"""Largest number taken from a file: what float32 can hold, so that squares stay finite."""


def as_doubles(values: npt.NDArray[Any]) -> FloatArray:
    """Return `values` (...) as float64 (...); a signalling NaN of a file becomes a quiet one."""
    with np.errstate(invalid="ignore"):
        return values.astype(np.float64)


def first_bad_row(values: npt.NDArray[np.floating]) -> int | None:
    """Return the first row of `values` (n, k) that is not finite or beyond `LARGEST`, if any."""
    # A comparison with NaN is false.
    good = (np.abs(values) <= LARGEST).all(axis=1)
    return None if good.all() else int(np.argmin(good))


def require_finite(values: npt.NDArray[np.floating], where: str, *, row_name: str = "row") -> None:
    """Raise `FormatError` naming the first bad row of `values` (n, k)."""
    row = first_bad_row(values)
    if row is not None:
        raise FormatError(
            f"{where}: {row_name} {row} is {values[row].tolist()}, every number must be finite "
            f"and below {LARGEST:g}"
        )
