"""Muscles that are laid by hand, for tests of the skin and the face."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from risorius._check import FloatArray
from risorius.springmuscle.muscle import Fibre, FitReport, FittedMuscle, MuscleAction

NO_GRID = np.zeros((2, 2, 3))
REPORT = FitReport(
    np.zeros((1, 1)), np.zeros((1, 1)), np.ones((1, 1)), np.zeros((1, 1), bool), 1.0, 1, 0, "fits"
)


def fibre(
    points: FloatArray, upwards: Sequence[float], *, width: float = 4.0, height: float = 1.0
) -> Fibre:
    """Return a fibre along `points` (p, 3) whose ellipsoids lie flat across `upwards` (3,)."""
    along = np.diff(points, axis=0)
    length = np.linalg.norm(along, axis=1, keepdims=True)
    along = along / length
    out = np.asarray(upwards) - (along @ np.asarray(upwards))[:, None] * along
    out /= np.linalg.norm(out, axis=1, keepdims=True)
    frames = np.stack([along, np.cross(out, along), out], axis=2)
    half = np.column_stack(
        [0.55 * length, np.full(len(length), width), np.full(len(length), height)]
    )
    count = len(points)
    return Fibre(points, np.ones(count, np.int8), half, frames, np.zeros(count - 1, np.int8))


def muscle(
    name: str,
    fibres: Sequence[Fibre],
    *,
    max_contraction: float = 0.5,
    radius: float = 8.0,
    stiffness: float = 1.0,
) -> FittedMuscle:
    """Return a linear muscle of the control `name`."""
    action = MuscleAction(name, max_contraction=max_contraction, radius=radius, stiffness=stiffness)
    return FittedMuscle(
        name, "linear", action, tuple(fibres), False, None, NO_GRID, NO_GRID, NO_GRID, REPORT
    )
