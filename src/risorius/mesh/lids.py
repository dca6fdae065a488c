"""Find the margins of an eye's lids: the one detector that every method uses."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse.csgraph import dijkstra

from risorius._check import BoolArray, FloatArray
from risorius.mesh.core import TriMesh
from risorius.mesh.slit import Slit, edge_graph, find_slit

__all__ = ["LidMargins", "find_lids"]


@dataclass(frozen=True, eq=False)
class LidMargins:
    """Lid margins of one eye on the skin.

    Parameters
    ----------
    slit : Slit
        Margins from the inner to the outer corner, and the skin that continues inwards.
    to_upper, to_lower : (n,) float64
        Distance along the skin to the upper and lower margin [mm], infinite beyond `reach`.
    width : float
        Distance of the eye corners [mm].
    height : float
        Largest opening between the margins, square to the line of the corners [mm].
    """

    slit: Slit
    to_upper: FloatArray
    to_lower: FloatArray
    width: float
    height: float

    @property
    def upper(self) -> BoolArray:
        """(n,) mask of vertices within reach that are nearer to the upper margin."""
        return self.to_upper <= np.minimum(self.to_lower, 1e300)

    @property
    def lower(self) -> BoolArray:
        """(n,) mask of vertices within reach that are nearer to the lower margin."""
        return self.to_lower < self.to_upper

    @property
    def distance(self) -> FloatArray:
        """Distance (n,) along the skin to the nearer margin [mm]."""
        return np.minimum(self.to_upper, self.to_lower)


def find_lids(
    mesh: TriMesh, *, inner: int, outer: int, upper: int, lower: int, reach: float = 2.0
) -> LidMargins:
    """Trace the margins of an eye and measure the skin around them.

    Works with an eye hole that is a boundary loop, with lids that turn inwards and with an eye
    socket behind them.

    Parameters
    ----------
    mesh : TriMesh
        Skin in the canonical frame.
    inner, outer : int
        Vertices at the eye corners (left eye 3.11, 3.7; right eye 3.8, 3.12).
    upper, lower : int
        Vertices at the middle of the margins (left 3.1, 3.3; right 3.2, 3.4).
    reach : float
        How far distances are measured, in eye widths.

    Raises
    ------
    MeshError
        If the margins cannot be traced or are welded together.
    """
    slit = find_slit(mesh, corners=(inner, outer), upper=[upper], lower=[lower], exact_corners=True)
    first, second = mesh.positions[list(slit.corners)]
    width = float(np.linalg.norm(second - first))
    graph = edge_graph(mesh)
    limit = reach * width
    to_upper, to_lower = (
        np.asarray(dijkstra(graph, indices=line, min_only=True, limit=limit))
        for line in (slit.upper, slit.lower)
    )
    axis = (second - first) / width
    across = np.cross([0.0, 0.0, 1.0], axis)
    across /= np.linalg.norm(across)
    if across[1] < 0.0:
        across = -across
    top = float(((mesh.positions[slit.upper] - first) @ across).max())
    bottom = float(((mesh.positions[slit.lower] - first) @ across).min())
    return LidMargins(slit, to_upper, to_lower, width, top - bottom)
