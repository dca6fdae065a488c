"""The eyeball's surface, tabulated by direction from its centre."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from risorius._check import FloatArray
from risorius.anatomy.eyes import turn_back
from risorius.mesh.core import TriMesh
from risorius.spatial.raycast import Scene

__all__ = ["RadialSurface"]


@dataclass(frozen=True, eq=False)
class RadialSurface:
    """Distance of a star-shaped surface from a centre.

    Parameters
    ----------
    table : (rows, columns) float64
        Radius [mm] over pitch (rows, -90 to 90 degrees) and yaw (columns, -180 to 180 degrees,
        0 straight ahead): a turned eye shows the lids its side.
    """

    table: FloatArray

    @staticmethod
    def of_mesh(mesh: TriMesh, centre: FloatArray, *, cells: int = 90) -> RadialSurface:
        """Tabulate the outer surface of `mesh` about `centre` (3,), `cells` from pole to pole.

        What lies inside, such as an iris behind the cornea, does not count; where the mesh is
        open the nearest radius does.
        """
        pitch = np.linspace(-np.pi / 2, np.pi / 2, cells + 1)
        yaw = np.linspace(-np.pi, np.pi, 2 * cells + 1)
        rows, columns = np.meshgrid(pitch, yaw, indexing="ij")
        towards = np.stack(
            [np.cos(rows) * np.sin(columns), np.sin(rows), np.cos(rows) * np.cos(columns)], axis=-1
        ).reshape(-1, 3)
        far = 2.0 * float(np.linalg.norm(mesh.positions - centre, axis=1).max())
        hits = Scene([mesh]).cast(centre + far * towards, -towards, max_distance=far)
        radius = far - hits.distance
        missed = ~hits.hit
        if missed.all():
            nearest = np.linalg.norm(mesh.positions - centre, axis=1)
            radius[:] = float(np.median(nearest))
        elif missed.any():
            found = np.flatnonzero(hits.hit)
            radius[missed] = radius[found[cKDTree(towards[found]).query(towards[missed])[1]]]
        return RadialSurface(radius.reshape(rows.shape))

    def radius(self, arm: FloatArray, *, yaw: float = 0.0, pitch: float = 0.0) -> FloatArray:
        """Return the radius (q,) in the directions `arm` (q, 3) from the centre [mm].

        `yaw` and `pitch` [deg] are how far the eye has turned, as in `Eyeball.turn`.
        """
        if yaw or pitch:
            arm = turn_back(arm, yaw=yaw, pitch=pitch)
        across, up = _angles(arm)
        t = self.table
        last = np.array(t.shape) - 1
        row = np.clip((up / np.pi + 0.5) * last[0], 0.0, last[0] - 1e-9)
        column = np.clip((0.5 * across / np.pi + 0.5) * last[1], 0.0, last[1] - 1e-9)
        i, j = row.astype(int), column.astype(int)
        u, v = row - i, column - j
        top = t[i, j] * (1 - v) + t[i, j + 1] * v
        bottom = t[i + 1, j] * (1 - v) + t[i + 1, j + 1] * v
        return top * (1 - u) + bottom * u


def _angles(arm: FloatArray) -> tuple[FloatArray, FloatArray]:
    radius = np.maximum(np.linalg.norm(arm, axis=1), 1e-12)
    return np.arctan2(arm[:, 0], arm[:, 2]), np.arcsin(np.clip(arm[:, 1] / radius, -1.0, 1.0))
