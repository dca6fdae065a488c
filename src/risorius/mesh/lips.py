"""Tell the upper lip from the lower one: the one detector that every method uses."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from scipy.sparse.csgraph import dijkstra

from risorius._check import BoolArray, FloatArray, IntArray
from risorius.mesh.core import TriMesh
from risorius.mesh.slit import Slit, edge_graph, find_slit, line_lengths

__all__ = ["LipLabel", "LipSides", "find_lips"]

LipLabel = Literal["upper", "lower", "corner", "none"]

# A vertex within this share of the mouth's width around a commissure belongs to neither lip.
_CORNER = 0.05
# The ends of the contact lines, as shares of their length, that do not vote on sides.
_END = 0.06


@dataclass(frozen=True, eq=False)
class LipSides:
    """Sides of the mouth on the skin.

    Parameters
    ----------
    slit : Slit
        Contact lines from the left to the right mouth corner, and what lies inside the mouth.
    to_upper, to_lower : (n,) float64
        Distance along the skin to the contact line of the upper and of the lower lip [mm];
        infinite on pieces of skin that are not connected to the mouth.
    width : float
        Distance of the mouth corners [mm].
    to_corner : (n,) float64
        Distance in space to the nearer commissure [mm].
    """

    slit: Slit
    to_upper: FloatArray
    to_lower: FloatArray
    width: float
    to_corner: FloatArray

    @property
    def upper(self) -> BoolArray:
        """(n,) mask of the upper side: upper lip, cheek above the corner, roof of the mouth bag."""
        return self.to_upper < self.to_lower

    @property
    def lower(self) -> BoolArray:
        """(n,) mask of the lower side."""
        return self.to_lower < self.to_upper

    @property
    def corner(self) -> BoolArray:
        """(n,) mask of the commissures, which belong to both lips."""
        return self.to_corner < _CORNER * self.width

    @property
    def inside(self) -> BoolArray:
        """(n,) mask of the skin behind the contact lines."""
        return self.slit.inside

    @property
    def distance(self) -> FloatArray:
        """Distance (n,) along the skin to the nearer contact line [mm]."""
        return np.minimum(self.to_upper, self.to_lower)

    def share(self) -> FloatArray:
        """Return how far towards the lower side (n,) a vertex lies, 0 upper to 1 lower.

        Half at the commissures and on the border between the sides, steep at the lips.
        """
        total = self.to_upper + self.to_lower
        share = np.full(len(total), 0.5)
        known = np.isfinite(total) & (total > 0.0)
        share[known] = self.to_upper[known] / total[known]
        return share

    def pairs(self, positions: FloatArray) -> IntArray:
        """Return seam pairs (k, 2): for each upper line vertex the lower one opposite to it.

        Matched by normalised arc length; the ends near the commissures are left out.
        """
        upper, lower = self.slit.upper, self.slit.lower
        place_upper = line_lengths(positions, upper)
        place_lower = line_lengths(positions, lower)
        nearest = np.abs(place_upper[:, None] - place_lower[None, :]).argmin(axis=1)
        pairs = np.stack([upper, lower[nearest]], axis=1)
        inner = (place_upper > _END) & (place_upper < 1.0 - _END)
        return pairs[inner & ~(self.corner[pairs].any(axis=1))]


def find_lips(
    mesh: TriMesh, *, corners: tuple[int, int], upper: int, lower: int, outer: tuple[int, int]
) -> LipSides:
    """Label the sides of the mouth.

    Works with a mouth that is a boundary loop, with lips that turn inwards and with a mouth bag.

    Parameters
    ----------
    mesh : TriMesh
        Skin in the canonical frame.
    corners : (int, int)
        Vertices at the left and right mouth corner (2.4, 2.5).
    upper, lower : int
        Vertices at the middle of the inner contours (2.2, 2.3).
    outer : (int, int)
        Vertices at the middle of the outer contours (8.1, 8.2); they keep the sides apart where
        the inner landmarks are poor.

    Raises
    ------
    MeshError
        If the lips are welded or the landmarks lie on different pieces of skin.
    """
    slit = find_slit(mesh, corners=corners, upper=[upper], lower=[lower])
    graph = edge_graph(mesh)
    sources: list[IntArray] = []
    for line, middle in ((slit.upper, outer[0]), (slit.lower, outer[1])):
        place = line_lengths(mesh.positions, line)
        inner = line[(place > _END) & (place < 1.0 - _END)]
        sources.append(np.append(inner, middle).astype(np.int32))
    to_upper, to_lower = (
        np.asarray(dijkstra(graph, indices=vertices, min_only=True)) for vertices in sources
    )
    ends = mesh.positions[list(slit.corners)]
    to_corner = np.linalg.norm(mesh.positions[:, None] - ends[None], axis=2).min(axis=1)
    width = float(np.linalg.norm(ends[0] - ends[1]))
    return LipSides(slit, to_upper, to_lower, width, to_corner)
