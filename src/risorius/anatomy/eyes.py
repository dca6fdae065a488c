"""Gaze: true rotation of the eyeball, and the published texture shift."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from risorius._check import FloatArray
from risorius.anatomy.jaw import rotate
from risorius.head.part_geometry import fit_sphere
from risorius.mesh.core import TriMesh

__all__ = ["Eyeball", "fit_eyeball", "texture_shift", "turn_back"]

# An eye whose vertices miss the best sphere by more than this share of its radius is not round.
_ROUND = 0.12


@dataclass(frozen=True, eq=False)
class Eyeball:
    """One eye.

    Parameters
    ----------
    centre : (3,) float64
        Centre of rotation [mm].
    radius : float
        Radius of the fitted sphere [mm].
    is_round : bool
        Whether the mesh is a sphere within 12 %; a flat anime eye is not and should be moved by
        `texture_shift`.
    """

    centre: FloatArray
    radius: float
    is_round: bool

    def turn(self, points: npt.ArrayLike, *, yaw: float, pitch: float) -> FloatArray:
        """Turn points (n, 3) by yaw (to the character's left) and pitch (up) [deg]."""
        up = np.array([0.0, 1.0, 0.0])
        side = np.array([1.0, 0.0, 0.0])
        raised = rotate(points, about=self.centre, axis=side, angle=-np.radians(pitch))
        return rotate(raised, about=self.centre, axis=up, angle=np.radians(yaw))


def turn_back(arm: FloatArray, *, yaw: float, pitch: float) -> FloatArray:
    """Return the directions (n, 3) that a turn by `yaw` and `pitch` [deg] brought to `arm`.

    The inverse of `Eyeball.turn` about an eye at the origin: last turn first.
    """
    origin = np.zeros(3)
    level = rotate(arm, about=origin, axis=np.array([0.0, 1.0, 0.0]), angle=-np.radians(yaw))
    return rotate(level, about=origin, axis=np.array([1.0, 0.0, 0.0]), angle=np.radians(pitch))


def fit_eyeball(mesh: TriMesh) -> Eyeball:
    """Fit centre and radius to the mesh of one eye (canonical frame)."""
    centre, radius, residual = fit_sphere(mesh.positions)
    return Eyeball(centre, radius, residual <= _ROUND * radius)


def texture_shift(
    *, yaw: float, pitch: float, uv_width: float = 1.0, view_degrees: float = 180.0
) -> tuple[float, float]:
    """Return (du, dv), the published shift of the eye's texture for a gaze.

    ``du = -yaw / view * uv_width``, ``dv = pitch / view * uv_width`` (thesis 5.5.2); the shift is
    clamped to a quarter of the texture so that the iris stays on the eye.

    Parameters
    ----------
    yaw, pitch : float
        Gaze [deg].
    uv_width : float
        Width of the eye in texture coordinates.
    view_degrees : float
        Angle that this width covers on the eyeball [deg].
    """
    scale = uv_width / view_degrees
    limit = 0.25 * uv_width
    return (
        float(np.clip(-yaw * scale, -limit, limit)),
        float(np.clip(pitch * scale, -limit, limit)),
    )
