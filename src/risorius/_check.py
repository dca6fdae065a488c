"""Validate arrays and numbers once, at the border of the package."""

from __future__ import annotations

import warnings
from collections.abc import Collection, Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from risorius.errors import ParameterError, RisoriusWarning, ShapeError

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int32]
BoolArray = npt.NDArray[np.bool_]


def as_points(name: str, value: npt.ArrayLike, *, dimension: int = 3) -> FloatArray:
    """Return `value` as a finite, C-contiguous (n, dimension) float64 array.

    Raises
    ------
    ShapeError
        If the shape is wrong or an entry is not finite (the first bad row is named).
    """
    points = np.ascontiguousarray(value, dtype=np.float64)
    if points.ndim != 2 or points.shape[1] != dimension:
        raise ShapeError(f"{name}: expected shape (n, {dimension}), got {points.shape}")
    bad = ~np.isfinite(points).all(axis=1)
    if bad.any():
        row = int(np.argmax(bad))
        raise ShapeError(
            f"{name}: row {row} is {points[row].tolist()}, every coordinate must be finite; "
            f"remove or repair the {int(bad.sum())} bad row(s)"
        )
    return points


def as_faces(name: str, value: npt.ArrayLike, *, vertex_count: int) -> IntArray:
    """Return `value` as a (m, 3) int32 array whose entries index `vertex_count` vertices."""
    faces = np.ascontiguousarray(value)
    if faces.size == 0:
        return np.zeros((0, 3), np.int32)
    if faces.ndim != 2 or faces.shape[1] != 3:
        raise ShapeError(f"{name}: expected shape (m, 3), got {faces.shape}")
    if not np.issubdtype(faces.dtype, np.integer):
        raise ShapeError(f"{name}: expected integers, got {faces.dtype}")
    bad = ((faces < 0) | (faces >= vertex_count)).any(axis=1)
    if bad.any():
        row = int(np.argmax(bad))
        raise ShapeError(
            f"{name}: row {row} is {faces[row].tolist()}, indices must lie in 0..{vertex_count - 1}"
        )
    return faces.astype(np.int32, copy=False)


def require_indices(name: str, values: IntArray, *, count: int, low: int = 0) -> None:
    """Raise `ShapeError` naming the first entry of `values` (k,) outside low..count - 1."""
    bad = (values < low) | (values >= count)
    if bad.any():
        entry = int(np.argmax(bad))
        raise ShapeError(
            f"{name}: entry {entry} is {values[entry]}, indices must lie in {low}..{count - 1}"
        )


def as_number(
    name: str, value: Any, *, low: float | None = None, high: float | None = None
) -> float:
    """Return `value` as a finite float inside [low, high]."""
    try:
        number = float(value)
    except (TypeError, ValueError):
        raise ParameterError(f"{name}: {value!r} is not a number") from None
    if not np.isfinite(number):
        raise ParameterError(f"{name}: {number} is not finite")
    if low is not None and number < low:
        raise ParameterError(f"{name}: {number:g} is below {low:g}")
    if high is not None and number > high:
        raise ParameterError(f"{name}: {number:g} is above {high:g}")
    return number


def one_of(name: str, value: str, choices: Mapping[str, Any] | tuple[str, ...]) -> str:
    """Return `value` if it is one of `choices`, else raise `ParameterError` listing them."""
    if value not in choices:
        raise ParameterError(f"{name}: {value!r} is not one of {', '.join(sorted(choices))}")
    return value


def require_muscle_name(name: str) -> None:
    """Refuse what cannot name a muscle that somebody draws: left and right come by mirroring."""
    plain = name.replace("_", "")
    if not (plain.isascii() and plain.isalnum() and name[:1].isalpha() and name == name.lower()):
        raise ParameterError(
            f"muscle name {name[:40]!r}: use small letters, digits and _, a letter first"
        )
    if name.endswith(("_l", "_r")):
        raise ParameterError(
            f"muscle name {name[:40]!r}: leave out the side; left and right are made by mirroring"
        )


def warn_of_strange_keys(
    where: str, found: Collection[str], known: Collection[str], *, kind: str
) -> None:
    """Warn once of keys that mean nothing in a file of this `kind`; a misspelt one is lost."""
    strange = sorted(set(found) - set(known))
    if strange:
        warnings.warn(
            f"{where}: {', '.join(strange)} means nothing in {kind} and is ignored; it may have "
            f"{', '.join(sorted(known))}",
            RisoriusWarning,
            stacklevel=3,
        )
