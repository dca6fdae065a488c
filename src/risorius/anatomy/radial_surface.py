"""The eyeball's surface, tabulated by direction from its centre."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import griddata

from risorius._check import FloatArray
from risorius.mesh.core import TriMesh

__all__ = ["RadialSurface"]


@dataclass(frozen=True, eq=False)
class RadialSurface:
    """Distance of a star-shaped surface from a centre.

    Parameters
    ----------
    table : (rows, columns) float64
        Radius [mm] over pitch (rows) and yaw (columns), both -90 to 90 degrees seen from the
        front.
    """

    table: FloatArray

    @staticmethod
    def of_mesh(mesh: TriMesh, centre: FloatArray, *, cells: int = 61) -> RadialSurface:
        """Tabulate the front half of `mesh` about `centre` (3,), linear between its vertices."""
        arm = mesh.positions - centre
        radius = np.linalg.norm(arm, axis=1)
        front = arm[:, 2] > -0.35 * radius
        yaw, pitch = _angles(arm[front])
        grid = np.linspace(-np.pi / 2, np.pi / 2, cells)
        points = np.column_stack([pitch, yaw])
        wanted = np.stack(np.meshgrid(grid, grid, indexing="ij"), axis=-1)
        table = np.asarray(griddata(points, radius[front], wanted, method="linear"))
        nearest = np.asarray(griddata(points, radius[front], wanted, method="nearest"))
        return RadialSurface(np.where(np.isfinite(table), table, nearest))

    def radius(self, arm: FloatArray) -> FloatArray:
        """Return the radius (q,) in the directions `arm` (q, 3) from the centre [mm]."""
        yaw, pitch = _angles(arm)
        cells = len(self.table) - 1
        row = np.clip((pitch / np.pi + 0.5) * cells, 0.0, cells - 1e-9)
        column = np.clip((yaw / np.pi + 0.5) * cells, 0.0, cells - 1e-9)
        i, j = row.astype(int), column.astype(int)
        u, v = row - i, column - j
        t = self.table
        top = t[i, j] * (1 - v) + t[i, j + 1] * v
        bottom = t[i + 1, j] * (1 - v) + t[i + 1, j + 1] * v
        return top * (1 - u) + bottom * u


def _angles(arm: FloatArray) -> tuple[FloatArray, FloatArray]:
    radius = np.maximum(np.linalg.norm(arm, axis=1), 1e-12)
    return np.arctan2(arm[:, 0], arm[:, 2]), np.arcsin(np.clip(arm[:, 1] / radius, -1.0, 1.0))
