"""How far the skin takes part: fully over muscles and jaw, not at all far away from them."""

from __future__ import annotations

import numpy as np

from risorius._check import FloatArray
from risorius.anatomy.mechanics import Mechanics
from risorius.anatomy.smooth_step import smooth_step
from risorius.layered.faithful.binding import Anchors
from risorius.mesh.geodesic import dijkstra_distance

__all__ = ["influence_map"]


def influence_map(mechanics: Mechanics, anchors: Anchors, reach: float) -> FloatArray:
    """Return the influence (n,) of every skin vertex, 1 where it hangs on a muscle or the jaw.

    A blend with the head at rest, not a factor in every frame, which would only slow the motion
    (erratum E23).

    Parameters
    ----------
    mechanics : Mechanics
        Of the head.
    anchors : Anchors
    reach : float
        Distance along the skin at which the influence ends [mm].
    """
    mesh = mechanics.head.skin.mesh
    sources = anchors.vertices[~anchors.on("cranium")]
    result = np.zeros(mesh.vertex_count)
    if len(sources):
        distance = dijkstra_distance(mesh.positions, mesh.faces, sources)
        result = smooth_step(np.nan_to_num(1.0 - distance / reach, neginf=0.0))
        result[sources] = 1.0
    for lids in mechanics.lids.values():
        result[lids.vertices] = np.maximum(result[lids.vertices], lids.weight)
    return result
