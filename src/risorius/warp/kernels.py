"""Radial kernels and their derivatives, signed so that each is conditionally positive definite.

With that sign a positive number on the diagonal of the kernel matrix always smooths.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Literal

import numpy as np

from risorius._check import FloatArray

__all__ = ["KERNELS", "Kernel", "KernelName", "blocks", "squared_distances"]

# At most this many point-centre pairs are evaluated at once.
_PAIRS_AT_ONCE = 1 << 20

KernelName = Literal["multiquadric", "biharmonic", "thin_plate", "triharmonic"]


@dataclass(frozen=True)
class Kernel:
    """A radial function phi(d2, c) of the squared distance d2 and the centre's radius c.

    Parameters
    ----------
    value : callable
        phi.
    slope : callable
        2 d phi / d d2, so that the gradient at x is ``slope * (x - centre)``; 0 where phi has a
        kink.
    order : int
        Degree of polynomials, plus 1, that the kernel needs beside it.
    uses_radii : bool
        Whether c matters.
    """

    value: Callable[[FloatArray, FloatArray], FloatArray]
    slope: Callable[[FloatArray, FloatArray], FloatArray]
    order: int
    uses_radii: bool = False


def _multiquadric(squared: FloatArray, radii: FloatArray) -> FloatArray:
    return -np.sqrt(squared + radii * radii)


def _multiquadric_slope(squared: FloatArray, radii: FloatArray) -> FloatArray:
    root = np.sqrt(squared + radii * radii)
    return -1.0 / np.where(root > 0.0, root, np.inf)


def _biharmonic(squared: FloatArray, radii: FloatArray) -> FloatArray:
    return -np.sqrt(squared)


def _biharmonic_slope(squared: FloatArray, radii: FloatArray) -> FloatArray:
    return -1.0 / np.sqrt(np.where(squared > 0.0, squared, np.inf))


def _thin_plate(squared: FloatArray, radii: FloatArray) -> FloatArray:
    return 0.5 * squared * np.log(np.where(squared > 0.0, squared, 1.0))


def _thin_plate_slope(squared: FloatArray, radii: FloatArray) -> FloatArray:
    return np.where(squared > 0.0, np.log(np.where(squared > 0.0, squared, 1.0)) + 1.0, 0.0)


def _triharmonic(squared: FloatArray, radii: FloatArray) -> FloatArray:
    return squared * np.sqrt(squared)


def _triharmonic_slope(squared: FloatArray, radii: FloatArray) -> FloatArray:
    return 3.0 * np.sqrt(squared)


KERNELS: dict[str, Kernel] = {
    "multiquadric": Kernel(_multiquadric, _multiquadric_slope, 1, uses_radii=True),
    "biharmonic": Kernel(_biharmonic, _biharmonic_slope, 1),
    "thin_plate": Kernel(_thin_plate, _thin_plate_slope, 2),
    "triharmonic": Kernel(_triharmonic, _triharmonic_slope, 2),
}
"""``sqrt(d^2 + c^2)``, ``d``, ``d^2 log d`` and ``d^3``, up to sign."""


def squared_distances(points: FloatArray, centres: FloatArray) -> FloatArray:
    """Return the squared distances (q, n) between `points` (q, 3) and `centres` (n, 3)."""
    result = np.zeros((len(points), len(centres)))
    for axis in range(3):
        gap = points[:, axis, None] - centres[:, axis]
        result += gap * gap
    return result


def blocks(point_count: int, centre_count: int) -> Iterator[slice]:
    """Yield the rows of points to evaluate together, so that memory stays bounded."""
    size = max(_PAIRS_AT_ONCE // max(centre_count, 1), 1)
    for start in range(0, point_count, size):
        yield slice(start, start + size)
