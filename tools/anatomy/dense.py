"""The dense half head: its marching cubes surface and its place in the unit disc."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .closest import closest_on_mesh
from .disc_map import disc_map
from .marching import half_surface
from .skin_field import skin_field
from .table import NECK_Y

__all__ = ["Dense", "dense_half"]

_STEP = 1.5
_LOW, _HIGH = (0, NECK_Y, -115), (105, 125, 128)


@dataclass(frozen=True)
class Dense:
    """Left half of the head.

    Parameters
    ----------
    positions : (n, 3) ndarray
        Vertices [mm].
    faces : (m, 3) int ndarray
    disc : (n, 2) ndarray
        Vertices in the unit disc.
    border : (b,) int ndarray
        Midline and neck.
    """

    positions: np.ndarray
    faces: np.ndarray
    disc: np.ndarray
    border: np.ndarray

    def on_disc(self, points):
        """Return where the surface points (q, 3) lie in the disc (q, 2)."""
        face, weights, _ = closest_on_mesh(self.positions, self.faces, points)
        return np.einsum("ij,ijk->ik", weights, self.disc[self.faces[face]])

    @property
    def keeps_orientation(self):
        """Whether the faces are counter-clockwise in the disc."""
        corner = self.disc[self.faces]
        u, v = corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]
        return np.median(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]) > 0


def dense_half():
    """Return the dense left half of the head."""
    positions, faces = half_surface(skin_field, _LOW, _HIGH, _STEP)
    disc, border = disc_map(positions, faces)
    return Dense(positions, faces, disc, border)
