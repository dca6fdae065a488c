"""Doubtful places are evened out: what stretches far more than skin does has lost its sheet.

Neighbours on the target have places on the source; the way between those along the source's skin
should be about as long as the edge between the neighbours. Where it is much longer, at least one
place lies on another sheet of folded skin. The motion of such vertices is replaced by the
smoothest one that agrees with their trustworthy neighbours.
"""

from __future__ import annotations

import numpy as np
from scipy.sparse import csc_matrix, csr_matrix, diags, eye
from scipy.sparse.csgraph import dijkstra

from risorius._check import BoolArray, FloatArray, IntArray
from risorius.cloning.seam_zones import SeamZone
from risorius.mesh.connectivity import edges
from risorius.mesh.core import TriMesh
from risorius.mesh.factorisation import factorise
from risorius.mesh.laplacian import uniform_laplacian
from risorius.mesh.slit import edge_graph

__all__ = ["evening", "place_stretch"]

# Edges are taken as this much longer, so that the tiniest ones do not ask for exactness [mm].
_SLACK = 0.05
# Ways are looked for up to this length [mm].
_LONGEST = 20.0
# Excess of stretch that halves the trust in a place; trust in a place without excess.
_DOUBT, _TRUST = 0.3, 1e4
# Rings around doubtful vertices that take part, and weights that are dropped.
_RINGS, _ROUNDING = 3, 1e-6


def place_stretch(
    zone: SeamZone, rest: TriMesh, mesh: TriMesh, corners: IntArray, bary: FloatArray
) -> FloatArray:
    """Return how much more than usual (n,) the places around each target vertex are apart [1].

    Root mean square over the vertex's edges of the way over the edge, less what is ordinary; 0
    outside the zone.

    Parameters
    ----------
    zone : SeamZone
    rest : TriMesh
        The source's skin at rest [mm].
    mesh : TriMesh
        The target's skin [mm].
    corners : (n, 3) int32
        Source vertices around the place of each target vertex.
    bary : (n, 3) float64
    """
    n = mesh.vertex_count
    pairs = edges(mesh.faces)
    pairs = pairs[zone.target[pairs].all(axis=1)]
    if not len(pairs):
        return np.zeros(n)
    length = np.linalg.norm(mesh.positions[pairs[:, 0]] - mesh.positions[pairs[:, 1]], axis=1)
    way = _ways(zone.source, rest, corners[pairs], bary[pairs])
    excess = np.maximum(way / (length + _SLACK) - zone.ordinary, 0.0)
    total = np.bincount(pairs.ravel(), np.repeat(excess**2, 2), n)
    count = np.bincount(pairs.ravel(), minlength=n)
    return np.sqrt(total / np.maximum(count, 1))


def _ways(near: BoolArray, rest: TriMesh, corners: IntArray, bary: FloatArray) -> FloatArray:
    """Return the way (k,) along the skin between pairs of places, `corners` (k, 2, 3) [mm].

    Straight where the two faces share a corner, else along edges.
    """
    starts = np.unique(corners[:, 0])
    near = near.copy()
    near[np.unique(corners)] = True
    used = np.flatnonzero(near)
    row, column = np.full((2, rest.vertex_count), -1)
    row[starts], column[used] = np.arange(len(starts)), np.arange(len(used))
    graph = edge_graph(rest)[used][:, used]
    apart = dijkstra(graph, indices=column[starts], limit=_LONGEST)
    places = np.einsum("kec,kecj->kej", bary, rest.positions[corners])
    ends = np.linalg.norm(places[:, :, None] - rest.positions[corners], axis=3)
    first, second = corners[:, 0], corners[:, 1]
    between = apart[row[first][:, :, None], column[second][:, None, :]]
    way = (ends[:, 0, :, None] + between + ends[:, 1, None, :]).min(axis=(1, 2))
    straight = np.linalg.norm(places[:, 0] - places[:, 1], axis=1)
    touching = (first[:, :, None] == second[:, None, :]).any(axis=(1, 2))
    return np.minimum(np.where(touching, straight, way), _LONGEST)


def evening(
    zones: list[SeamZone], rest: TriMesh, mesh: TriMesh, corners: IntArray, bary: FloatArray
) -> csr_matrix:
    """Return the (n, n) matrix that evens out motion at doubtful places; else the identity.

    Minimises sum_i k_i |u_i - t_i|^2 + b |U u|^2 over a few rings around the doubtful vertices,
    with trust k falling with the stretch and U the umbrella operator; b = (bend / edge)^4.

    Parameters
    ----------
    zones : list of SeamZone
    rest, mesh, corners, bary
        As in `place_stretch`.
    """
    n = mesh.vertex_count
    result = csr_matrix(eye(n))
    graph = uniform_laplacian(mesh.faces, n)
    for zone in zones:
        excess = place_stretch(zone, rest, mesh, corners, bary)
        if excess.any():
            result = _evened(graph, excess, _stiffness(mesh, excess, zone.bend)) @ result
    return csr_matrix(result)


def _stiffness(mesh: TriMesh, excess: FloatArray, bend: float) -> float:
    pairs = edges(mesh.faces)
    ends = mesh.positions[pairs[(excess[pairs] > 0.0).any(axis=1)]]
    length = float(np.median(np.linalg.norm(ends[:, 0] - ends[:, 1], axis=1)))
    return max((bend / max(length, 1e-9)) ** 4, 1.0)


def _evened(graph: csr_matrix, excess: FloatArray, stiffness: float) -> csr_matrix:
    n = graph.shape[0]
    inner = _grown(graph, excess > 0.0, _RINGS)
    ring = _grown(graph, inner, 1)
    rim = np.flatnonzero(_grown(graph, ring, 1) & ~inner)
    free, rows = np.flatnonzero(inner), np.flatnonzero(ring)
    degree = np.maximum(np.asarray(graph.diagonal())[rows], 1.0)
    umbrella = csr_matrix(diags(1.0 / degree) @ graph[rows])
    bent = csc_matrix(umbrella[:, free])
    trust = 1.0 / (1.0 / _TRUST + (excess[free] / _DOUBT) ** 2)
    solve = factorise(csc_matrix(diags(trust) + stiffness * (bent.T @ bent)))
    held = -stiffness * np.asarray((bent.T @ umbrella[:, rim]).todense(), np.float64)
    share = solve(np.concatenate([np.diag(trust), held], axis=1))
    columns = np.concatenate([free, rim])
    row, column = np.nonzero(np.abs(share) > _ROUNDING)
    spread = csr_matrix((share[row, column], (free[row], columns[column])), shape=(n, n))
    return csr_matrix(diags((~inner).astype(np.float64)) + spread)


def _grown(graph: csr_matrix, chosen: BoolArray, rings: int) -> BoolArray:
    for _ in range(rings):
        chosen = np.asarray((abs(graph) @ chosen.astype(np.float64)) > 0.0)
    return chosen
