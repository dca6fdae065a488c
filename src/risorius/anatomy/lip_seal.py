"""Lips that stay together while the jaw opens (ARKit's mouthClose)."""

from __future__ import annotations

import numpy as np

from risorius._check import FloatArray
from risorius.mesh.core import TriMesh
from risorius.mesh.laplacian import SmoothField
from risorius.mesh.lips import LipSides
from risorius.mesh.slit import line_lengths

__all__ = ["lip_seal"]

# Share of the gap that the lower lip closes; the upper lip comes down by the rest.
_LOWER_SHARE = 0.6


def lip_seal(mesh: TriMesh, lips: LipSides, opened: FloatArray) -> FloatArray:
    """Return the displacement (n, 3) [mm] that closes the lips of an opened mouth.

    To be added to `opened`: it carries each point of the two contact lines to where they meet,
    and fades over the lips, smoothly, to nothing at chin, nose and cheeks.

    Parameters
    ----------
    mesh : TriMesh
        Skin at rest, canonical frame.
    lips : LipSides
    opened : (n, 3) float64
        Skin with the jaw opened.
    """
    rest = mesh.positions
    upper, lower = lips.slit.upper, lips.slit.lower
    place = {"upper": line_lengths(rest, upper), "lower": line_lengths(rest, lower)}
    target = np.zeros((len(rest), 3))
    hold = np.where(lips.distance > 0.75 * lips.width, 1.0, 0.0)
    for line, other, name, share in (
        (lower, upper, "lower", _LOWER_SHARE),
        (upper, lower, "upper", 1.0 - _LOWER_SHARE),
    ):
        opposite = "upper" if name == "lower" else "lower"
        moved = opened[other] - rest[other]
        across = np.stack(
            [np.interp(place[name], place[opposite], moved[:, axis]) for axis in range(3)], axis=1
        )
        target[line] = share * (across - (opened[line] - rest[line]))
        hold[line] = 6.0
    field = SmoothField(mesh, 200.0 * hold, length=0.5 * lips.width, bend=0.1 * lips.width)
    return np.asarray(field.solve(target))
