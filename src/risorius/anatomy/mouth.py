"""The mouth in its own measures: along the lips, away from their line, inside the lips."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from risorius._check import FloatArray
from risorius.anatomy.outwards import unit
from risorius.anatomy.smooth_step import smooth_step
from risorius.head.head import Head
from risorius.mesh.lips import LipSides

__all__ = ["Mouth", "lip_body", "measure_mouth"]

# Skin within this distance of the lip line is lip rather than face [mm].
_LIP = 45.0
# Nearer to both lips than this a vertex belongs to the corner [mm].
_EVEN = 1.5
# Depth of the axis about which a lip turns, behind its red border [mm].
_AXIS_DEPTH = 5.0


@dataclass(frozen=True, eq=False)
class Mouth:
    """Coordinates of a skin of n vertices about its mouth.

    Parameters
    ----------
    half_width : float
        Half the distance of the mouth corners [mm].
    scale : float
        Size of the head over that of the built-in one.
    place : (n,) float64
        Sideways in half widths: 1 at the left corner, -1 at the right one.
    line : (n, 3) float64
        Point of the lip line at each vertex's place [mm].
    distance : (n,) float64
        Distance to it, in millimetres of the built-in head.
    side : (n,) float64
        1 on the upper lip and above, -1 on the lower, 0 at the corners and far away.
    depth : float
        How far the corners lie behind the middle of the lips [mm].
    axes : mapping of float to ((2,) float64)
        Height and depth of the middle of each lip's own axis [mm], by side.
    """

    half_width: float
    scale: float
    place: FloatArray
    line: FloatArray
    distance: FloatArray
    side: FloatArray
    depth: float
    axes: dict[float, FloatArray]

    def share(self, side: float) -> FloatArray:
        """Return how far (n,) a vertex belongs to the lip of `side`, half at the corners."""
        return 0.5 + 0.5 * side * self.side

    def arch_drop(self, place: FloatArray) -> FloatArray:
        """Return how far (n,) the dental arch has gone back at `place` (n,) [mm]."""
        far = np.abs(place)
        return -self.depth * np.where(far < 1.3, far * far, 2.6 * far - 1.69)

    def turn(self, points: FloatArray, side: float, degrees: float) -> FloatArray:
        """Return the displacement (n, 3) [mm] of a turn about the axis inside a lip.

        Positive rolls the lip in; the turn fades towards the corners.
        """
        a = self.half_width
        x = np.clip(self.place, -1.0, 1.0)
        height, depth = self.axes[side]
        axis_y = height + (self._corner_height - height) * x * x
        axis_z = depth - self.depth * x * x
        along = unit(
            np.stack(
                [np.full_like(x, a), 2 * (self._corner_height - height) * x, -2 * self.depth * x],
                axis=1,
            )
        )
        angle = np.radians(degrees) * side * (1.0 - 0.6 * x * x)
        arm = points - np.stack([np.clip(points[:, 0], -a, a), axis_y, axis_z], axis=1)
        cos, sin = np.cos(angle)[:, None], np.sin(angle)[:, None]
        parallel = np.einsum("nd,nd->n", along, arm)[:, None] * along
        return sin * np.cross(along, arm) - (1.0 - cos) * (arm - parallel)

    @property
    def _corner_height(self) -> float:
        return float(self.axes[0.0][0])


def measure_mouth(head: Head, lips: LipSides, scale: float) -> Mouth:
    """Measure the mouth of `head`.

    Parameters
    ----------
    head : Head
    lips : LipSides
        On the head's skin.
    scale : float
        Size of the head over that of the built-in one.
    """
    marks, points = head.landmarks, head.skin.mesh.positions
    corners = marks.positions(("2.4", "2.5"))
    inner = marks.positions(("2.2", "2.3"))
    half_width = 0.5 * float(np.linalg.norm(corners[0] - corners[1]))
    middle_z, corner_z = float(inner[:, 2].mean()), float(corners[:, 2].mean())
    middle_y, corner_y = float(inner[:, 1].mean()), float(corners[:, 1].mean())
    depth = middle_z - corner_z
    place = points[:, 0] / half_width
    x = np.clip(place, -1.0, 1.0)
    line = np.stack(
        [x * half_width, middle_y + (corner_y - middle_y) * x * x, middle_z - depth * x * x],
        axis=1,
    )
    distance = np.linalg.norm(points - line, axis=1) / scale
    apart = np.nan_to_num(lips.to_lower - lips.to_upper, nan=0.0, posinf=0.0, neginf=0.0)
    near = lips.distance < _LIP * scale
    side = np.where(near & (np.abs(apart) > _EVEN * scale), np.sign(apart), 0.0)
    axes = {0.0: np.array([corner_y, corner_z])}
    for sign, names in ((1.0, ("8.1", "2.2")), (-1.0, ("8.2", "2.3"))):
        places = marks.positions(names)
        axes[sign] = np.array([places[:, 1].mean(), places[:, 2].max() - _AXIS_DEPTH * scale])
    return Mouth(half_width, scale, place, line, distance, side, depth, axes)


def lip_body(mouth: Mouth) -> FloatArray:
    """Return 1 on the body of the lips and 0 from their corners outwards (n,)."""
    far = np.abs(mouth.place)
    return (1.0 - smooth_step((far - 0.5) / 0.45)) * (mouth.side != 0.0)
