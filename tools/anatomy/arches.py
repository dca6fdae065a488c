"""The two dental arches: the curve of the crowns and the size of every tooth."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .fields import rotation, smooth_curve
from .table import BITE_Y

__all__ = ["ARCHES", "Arch", "Crown", "arch_curve", "crowns", "point_at"]

_ANTERIOR = 3  # incisors and canine have an edge, the others a chewing surface


@dataclass(frozen=True)
class Arch:
    """One dental arch of the left half.

    Parameters
    ----------
    line : (k, 2) tuple
        x, z through the middle of the crowns, front to back [mm].
    widths, heights, depths : (7,) tuple
        Size of the crowns from the central incisor to the second molar [mm].
    sign : float
        +1 if the crowns grow down from above the bite (upper), -1 otherwise.
    """

    line: tuple
    widths: tuple
    heights: tuple
    depths: tuple
    sign: float


ARCHES = {
    "upper": Arch(
        ((0, 85.0), (9, 83.3), (17, 77.0), (22, 68), (26, 57), (28.5, 45)),
        (8.4, 6.6, 7.6, 7.0, 6.8, 10.0, 9.6),
        (10.5, 9.2, 10.2, 8.6, 8.0, 7.4, 7.0),
        (6.8, 6.8, 7.8, 9, 9, 10.5, 10.5),
        1.0,
    ),
    "lower": Arch(
        ((0, 82.3), (7, 81.3), (15, 76.0), (21, 66.0), (25.5, 55), (28.5, 43)),
        (5.3, 5.8, 6.8, 7.0, 7.1, 10.8, 10.2),
        (8.8, 9.2, 10.2, 8.8, 8.2, 7.6, 7.2),
        (5.8, 6.2, 7.4, 7.8, 8.2, 10, 10),
        -1.0,
    ),
}


@dataclass(frozen=True)
class Crown:
    """One crown: middle (x, z), turn about y, size, and height of its free edge [mm]."""

    centre: np.ndarray
    turn: np.ndarray
    size: np.ndarray
    edge: float
    sign: float
    anterior: bool


def arch_curve(arch):
    """Return the half arch as a dense curve (n, 3) at y = 0 with its arc length (n,).

    It runs on straight behind the last molar.
    """
    line = np.asarray(arch.line, float)
    curve = smooth_curve(np.column_stack([line[:, 0], np.zeros(len(line)), line[:, 1]]), 400)
    onward = curve[-1] - curve[-2]
    curve = np.vstack([curve, curve[-1] + 10.0 * onward / np.linalg.norm(onward)])
    step = np.linalg.norm(np.diff(curve, axis=0), axis=1)
    return curve, np.concatenate([[0.0], np.cumsum(step)])


def point_at(curve, arc, where):
    """Return the point (..., 3) of a curve at arc length `where`."""
    return np.stack([np.interp(where, arc, curve[:, k]) for k in range(3)], axis=-1)


def _edge_height(arch, index):
    """Return the y of the free edge: the upper front teeth overlap the lower ones."""
    if arch.sign > 0:
        return BITE_Y - (1.4, 1.4, 0.8, 0.0, 0.0, 0.0, 0.0)[index]
    return BITE_Y - (0.3 if index < _ANTERIOR else 0.6)


def crowns(arch):
    """Return the crowns of the left half of `arch`, front to back."""
    curve, arc = arch_curve(arch)
    out, begin = [], 0.0
    for index, size in enumerate(zip(arch.widths, arch.heights, arch.depths)):
        middle = begin + 0.5 * size[0]
        begin += size[0]
        along = point_at(curve, arc, middle + 1.0) - point_at(curve, arc, middle - 1.0)
        out.append(
            Crown(
                centre=point_at(curve, arc, middle),
                turn=rotation(0, np.degrees(np.arctan2(-along[2], along[0])), 0),
                size=np.array(size),
                edge=_edge_height(arch, index),
                sign=arch.sign,
                anterior=index < _ANTERIOR,
            )
        )
    return out
