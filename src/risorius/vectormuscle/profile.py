"""The corrected muscle profile of Waters as Bui et al. print it, errata fixed."""

from __future__ import annotations

from typing import Literal

import numpy as np
import numpy.typing as npt

from risorius._check import FloatArray

__all__ = ["AngularProfile", "angular_factor", "fold_limit", "radial_factor"]

AngularProfile = Literal["smooth", "published"]


def radial_factor(
    distance: npt.ArrayLike, *, start_radius: float, finish_radius: float
) -> FloatArray:
    """Return the fall-off along the muscle: 0 at the origin, 1 at the start, 0 at the finish.

    ``cos((1 - D/Rs) pi/2)`` for D <= Rs, ``cos((D - Rs)/(Rf - Rs) pi/2)`` up to Rf, 0 beyond
    (Bui et al. 2003 eq. 1 lacks the pi/2: erratum E1).

    Parameters
    ----------
    distance : (n,) array_like
        Distance from the origin [mm].
    start_radius, finish_radius : float
        Rs and Rf [mm].
    """
    d = np.asarray(distance, dtype=np.float64)
    rising = np.cos((1.0 - d / start_radius) * np.pi / 2.0)
    falling = np.cos((d - start_radius) / (finish_radius - start_radius) * np.pi / 2.0)
    return np.where(d <= start_radius, rising, np.where(d < finish_radius, falling, 0.0))


def angular_factor(
    angle: npt.ArrayLike, *, half_angle: float, profile: AngularProfile = "smooth"
) -> FloatArray:
    """Return the fall-off across the muscle.

    Smooth: ``cos(angle / half_angle pi/2)``, zero at the rim as in Waters' own program.
    Published: ``cos(angle)``, which jumps to zero at the rim (erratum E3).

    Parameters
    ----------
    angle : (n,) array_like
        Angle between the muscle and the vertex, seen from the origin [rad].
    half_angle : float
        Half opening of the zone [rad].
    profile : {"smooth", "published"}
    """
    a = np.asarray(angle, dtype=np.float64)
    inside = np.abs(a) < half_angle
    value = np.cos(a / half_angle * np.pi / 2.0) if profile == "smooth" else np.cos(a)
    return np.where(inside, value, 0.0)


def fold_limit(*, start_radius: float, finish_radius: float) -> float:
    """Return the largest pull [mm] that keeps the order of points along the muscle.

    ``2 min(Rs, Rf - Rs) / pi``: the map D -> D - k r(D) is monotone below it.
    """
    return 2.0 * min(start_radius, finish_radius - start_radius) / np.pi
