"""Colours: codes, sRGB, and the scale for numbers."""

from __future__ import annotations

import re

import numpy as np
import numpy.typing as npt

from risorius._check import FloatArray, as_number
from risorius.errors import ParameterError, ShapeError

__all__ = ["RGB", "display_rgb", "encode_srgb", "heat_colours", "heat_ramp", "linear_rgb"]

RGB = tuple[float, float, float]


def linear_rgb(code: str) -> RGB:
    """Return the linear RGB in 0..1 of an sRGB code such as ``"#c89b86"``."""
    if not re.fullmatch(r"#[0-9a-fA-F]{6}", code):
        raise ParameterError(f"code: {code!r} is not of the form '#c89b86'")
    encoded = np.array([int(code[at : at + 2], 16) / 255.0 for at in (1, 3, 5)])
    linear = np.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)
    return (float(linear[0]), float(linear[1]), float(linear[2]))


def display_rgb(linear: npt.ArrayLike) -> npt.NDArray[np.uint8]:
    """Return linear RGB (..., 3) in 0..1 as 8-bit sRGB."""
    return np.rint(255.0 * encode_srgb(linear)).astype(np.uint8)


def encode_srgb(linear: npt.ArrayLike) -> FloatArray:
    """Return linear values (...,) as sRGB in 0..1; what lies outside 0..1 is cut off."""
    value = np.clip(np.asarray(linear, dtype=np.float64), 0.0, 1.0)
    return np.where(value <= 0.0031308, 12.92 * value, 1.055 * value ** (1 / 2.4) - 0.055)


# Clay to yellow, red and plum: zero looks like an unpainted head, shading shows everywhere.
_HEAT = np.array(
    [
        linear_rgb(code)
        for code in ("#c9c4be", "#ead9a4", "#f3c25e", "#ee9140", "#dc5a3b", "#b22a45", "#7d1554")
    ]
)


def heat_ramp(steps: int = 256) -> FloatArray:
    """Return the scale of `heat_colours` as linear RGB (n, 3), n = `steps`, for `Surface.ramp`."""
    steps = int(as_number("steps", steps, low=2, high=4096))
    return _along(_HEAT, np.linspace(0.0, 1.0, steps))


def heat_colours(values: npt.ArrayLike, low: float, high: float) -> FloatArray:
    """Return a colour for each value: clay at `low` through yellow and red to plum at `high`.

    Parameters
    ----------
    values : (n,) array_like
        Numbers; beyond the ends they take the end's colour, NaN is dark grey.
    low, high : float
        Ends of the scale, low < high.

    Returns
    -------
    (n, 3) float64
        Linear RGB in 0..1.
    """
    value = np.asarray(values, dtype=np.float64)
    if value.ndim != 1:
        raise ShapeError(f"values: expected shape (n,), got {value.shape}")
    low = as_number("low", low)
    high = as_number("high", high)
    if not low < high:
        raise ParameterError(f"high: {high:g} must be above low = {low:g}")
    place = np.clip((value - low) / (high - low), 0.0, 1.0)
    colours = _along(_HEAT, np.nan_to_num(place))
    colours[np.isnan(value)] = linear_rgb("#4a4a4e")
    return colours


def _along(keys: FloatArray, place: FloatArray) -> FloatArray:
    at = np.linspace(0.0, 1.0, len(keys))
    return np.stack([np.interp(place, at, keys[:, channel]) for channel in range(3)], axis=1)
