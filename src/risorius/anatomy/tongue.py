"""The tongue: out, up and sideways, rooted behind."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from risorius._check import BoolArray, FloatArray, IntArray
from risorius.anatomy.smooth_step import smooth_step
from risorius.head.head import Head
from risorius.mesh.laplacian import smooth
from risorius.mesh.topology import components

__all__ = ["Tongue", "build_tongue", "tongue_in_gums"]

# Share of the tongue's length at the back that stays with the jaw.
_ROOT = 0.25


@dataclass(frozen=True, eq=False)
class Tongue:
    """A tongue of n vertices.

    Parameters
    ----------
    along : (n,) float64
        0 at the root, 1 at the tip.
    reach : float
        How far the tip comes out [mm].
    length : float
        Length of the tongue [mm].
    """

    along: FloatArray
    reach: float
    length: float

    def displace(self, *, out: float, up: float, side: float) -> FloatArray:
        """Return the displacement (n, 3) [mm] for controls out in [0, 1], up and side in [-1, 1].

        The body stretches forwards and rises over the lower teeth on its way out; the tip bends.
        """
        stretch = self.along * self.along
        over = smooth_step(self.along) * (1.0 - 0.45 * self.along)
        result = np.zeros((len(self.along), 3))
        result[:, 2] = out * self.reach * stretch
        result[:, 1] = 0.16 * self.length * (out * over + up * 1.6 * stretch)
        result[:, 0] = 0.25 * self.length * side * stretch
        # A bent tongue keeps its length: what goes up or aside comes back a little.
        result[:, 2] -= 0.06 * self.length * (abs(up) + abs(side)) * stretch * (1.0 - out)
        return result


def build_tongue(positions: FloatArray, lip_front: float) -> Tongue:
    """Measure a tongue in the canonical frame.

    Parameters
    ----------
    positions : (n, 3) float64
        Its vertices [mm].
    lip_front : float
        Foremost z of the lips [mm]; the tip comes a third of the tongue beyond it.
    """
    back, tip = float(positions[:, 2].min()), float(positions[:, 2].max())
    length = max(tip - back, 1e-6)
    along = np.clip(((positions[:, 2] - back) / length - _ROOT) / (1.0 - _ROOT), 0.0, 1.0)
    return Tongue(along, max(lip_front - tip, 0.0) + 0.4 * length, length)


def tongue_in_gums(head: Head, mouth_width: float, lip_front: float) -> Tongue | None:
    """Find the tongue in a part that holds gums and tongue in one piece.

    The tongue is what lies away from all teeth, inside the lower arch and near the midline.
    Returns None if there are no lower teeth or nothing looks like a tongue.
    """
    if "teeth_lower" not in head.parts:
        return None
    teeth = head.parts["teeth_lower"].mesh.positions
    points = head.parts["gums"].mesh.positions
    upper = head.parts.get("teeth_upper")
    both = np.concatenate([teeth, upper.mesh.positions]) if upper else teeth
    away = np.asarray(cKDTree(both).query(points)[0])
    top = float(teeth[:, 1].max())
    front = float(teeth[:, 2].max())
    half = 0.5 * float(np.ptp(teeth[:, 0])) - 0.1 * mouth_width
    inside = (
        (away > 0.04 * mouth_width)
        & (np.abs(points[:, 0] - teeth[:, 0].mean()) < half)
        & (points[:, 2] < front - 0.1 * mouth_width)
        & (points[:, 1] < top + 0.15 * mouth_width)
        & (points[:, 1] > top - 0.25 * mouth_width)
    )
    faces = head.parts["gums"].mesh.faces
    inside = _foremost_piece(faces, inside, points)
    if inside.sum() < 20:
        return None
    tongue = build_tongue(points[inside], lip_front)
    along = np.zeros(len(points))
    along[inside] = tongue.along * smooth_step(away[inside] / (0.05 * mouth_width) - 0.8)
    # The floor of the mouth gives way a little, so that the root does not tear off it.
    along = smooth(along, faces, 4)
    return Tongue(along / max(float(along.max()), 1e-9), tongue.reach, tongue.length)


def _foremost_piece(faces: IntArray, chosen: BoolArray, points: FloatArray) -> BoolArray:
    """Return the connected piece (n,) of the `chosen` vertices that lies furthest forward.

    Crumbs do not count: a piece needs a tenth of the chosen vertices.
    """
    labels = components(faces[chosen[faces].all(axis=1)], len(chosen)).of_vertex
    sizes = np.bincount(labels[labels >= 0], minlength=1)
    large = np.flatnonzero(sizes >= max(0.1 * chosen.sum(), 1))
    if not len(large):
        return np.zeros(len(chosen), bool)
    front = [float(np.quantile(points[labels == number, 2], 0.9)) for number in large]
    return labels == large[int(np.argmax(front))]
