"""How far the skin takes part: fully over muscles and jaw, not at all far away from them."""

from __future__ import annotations

import numpy as np

from risorius._check import FloatArray
from risorius.anatomy.mechanics import Mechanics
from risorius.anatomy.smooth_step import smooth_step
from risorius.layered.faithful.binding import Anchors
from risorius.mesh.geodesic import dijkstra_distance

__all__ = ["influence_map"]


def influence_map(
    mechanics: Mechanics, anchors: Anchors, *, reach: float, jaw_reach: float
) -> FloatArray:
    """Return the influence (n,) of every skin vertex, 1 where it hangs on a muscle or the jaw.

    A blend with the head at rest, not a factor in every frame, which would only slow the motion
    (erratum E23).

    Parameters
    ----------
    mechanics : Mechanics
        Of the head.
    anchors : Anchors
    reach, jaw_reach : float
        Distance along the skin from muscle and from jaw at which the influence ends [mm].
    """
    mesh = mechanics.head.skin.mesh
    on_jaw = anchors.on("mandible")
    on_muscle = ~anchors.on("cranium", "mandible")
    result = np.zeros(mesh.vertex_count)
    # Behind the hinge the neck stays.
    ahead = smooth_step(1.0 + (mesh.positions[:, 2] - mechanics.jaw.hinge[2]) / reach)
    for chosen, limit, share in ((on_muscle, reach, 1.0), (on_jaw, jaw_reach, ahead)):
        sources = anchors.vertices[chosen]
        if not len(sources):
            continue
        distance = dijkstra_distance(mesh.positions, mesh.faces, sources, limit=limit)
        fade = smooth_step(np.nan_to_num(1.0 - distance / limit, neginf=0.0))
        result = np.maximum(result, share * fade)
        result[sources] = 1.0
    for lids in mechanics.lids.values():
        result[lids.vertices] = np.maximum(result[lids.vertices], lids.weight)
    return result
