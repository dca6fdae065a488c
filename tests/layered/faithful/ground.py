"""Muscles on flat ground, for tests of the published muscles."""

from __future__ import annotations

import numpy as np

from risorius.layered.faithful.anatomy import Anatomy, LaidMuscle, lay_muscle
from risorius.layered.faithful.parameters import FaithfulParameters, SheetStiffness
from risorius.layered.muscle import Muscle, Ring, Sheet
from risorius.solvers.parameters import Parameters

# Published constants throughout, also where our own are stiffer; the reference run of the
# specification has no internal lines.
PUBLISHED = FaithfulParameters(
    sheet=SheetStiffness(origin=0.2),
    wide=1e9,
    muscle_solver=Parameters(tolerance=1e-7, iteration_limit=600),
)


def grid(columns: int, rows: int, size: float) -> tuple[np.ndarray, np.ndarray]:
    """Return a flat grid around the origin, facing +z."""
    x, y = np.meshgrid(np.linspace(-size, size, columns), np.linspace(-size, size, rows))
    positions = np.stack([x.ravel(), y.ravel(), np.zeros(x.size)], axis=1)
    corner = (np.arange(rows - 1)[:, None] * columns + np.arange(columns - 1)).ravel()
    first = np.stack([corner, corner + 1, corner + columns + 1], axis=1)
    second = np.stack([corner, corner + columns + 1, corner + columns], axis=1)
    return positions, np.concatenate([first, second]).astype(np.int32)


def flat_ground(size: float = 100.0) -> Anatomy:
    """Return an anatomy whose cranium is a plane."""
    anatomy = Anatomy()
    anatomy.add("cranium", *grid(9, 9, size))
    return anatomy


def sheet(
    name: str,
    line: list[tuple[float, float]],
    *,
    on: tuple[str, ...] = ("cranium",),
    layer: int = 1,
    half_width: float = 10.0,
    thickness: float = 3.0,
    sections: tuple[int, int] = (3, 5),
) -> Muscle:
    """Return a sheet drawn on the plane from above."""
    points = np.array([(x, y, 0.0) for x, y in line])
    shape = Sheet(points, np.full(len(points), half_width), np.array([0.0, 0.0, 1.0]))
    return Muscle(name, layer, shape, None, on, thickness, sections)


def ring(name: str = "ring", *, columns: int = 20) -> Muscle:
    """Return an elliptical sphincter around the origin."""
    shape = Ring(np.zeros(3), np.array([12.0, 6.0]), np.array([24.0, 12.0]))
    return Muscle(name, 1, shape, None, ("cranium",), 3.0, (columns, 2))


def lay(anatomy: Anatomy, muscle: Muscle, parameters: FaithfulParameters = PUBLISHED) -> LaidMuscle:
    """Lay a muscle that contracts under its own name."""
    return lay_muscle(anatomy, muscle, "", control=muscle.name, parameters=parameters)
