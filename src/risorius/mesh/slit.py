"""Find the two contact lines of a slit in the face: the mouth between the lips, the eye.

The lines are where each lip turns inwards. Seen from the front, the whole star of such a vertex
lies on its own side: a vertex of the lower lip's line has no incident triangle above it, one of
the upper lip's line none below it (Bui et al. 2003 call them upper-opened and lower-opened; only
the frontal projection gives the definition a meaning, spec vector-muscles E9). This needs no
boundary loop: it also works where a mouth bag or an eye socket continues the skin inwards.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.sparse import coo_matrix, csr_matrix
from scipy.sparse.csgraph import connected_components, dijkstra

from risorius._check import BoolArray, FloatArray, IntArray
from risorius.errors import MeshError
from risorius.mesh.core import TriMesh

__all__ = ["Slit", "edge_graph", "find_slit", "line_lengths", "opened_vertices"]

# Edges along opened vertices are this much cheaper than others when a line is traced.
_PREFERENCE = 0.4
# The ends of a slit are looked for within this share of its width around their landmarks.
_REACH = 0.3
# Skin between the middles of the lines that is shorter than this share of the width joins them;
# round a bag, a socket or the corners of a hole it is about as long as the slit is wide.
_WELDED = 0.25
# How much a millimetre away from its landmark counts when an end is looked for.
_PULL = 0.25


@dataclass(frozen=True, eq=False)
class Slit:
    """The two lines of a slit.

    Parameters
    ----------
    upper, lower : (k,) int32
        Vertices from the first corner to the second, both corners included.
    inside : (n,) bool
        Vertices behind the lines: mouth bag, inner lips, eye socket. Lines are not inside.
    opened_share : float
        Share of the lines' vertices that the frontal test confirms; near 1 on clean lips.
    """

    upper: IntArray
    lower: IntArray
    inside: BoolArray
    opened_share: float

    @property
    def corners(self) -> tuple[int, int]:
        """First and second corner."""
        return int(self.upper[0]), int(self.upper[-1])


def opened_vertices(mesh: TriMesh) -> tuple[BoolArray, BoolArray]:
    """Return (n,) masks: vertices with nothing above them, and with nothing below them.

    A vertex is upper-opened if no incident triangle contains the direction +y at the vertex in
    the frontal projection, lower-opened likewise for -y. Unused vertices are neither.
    """
    blocked = np.zeros((2, mesh.vertex_count), bool)
    plane = mesh.positions[:, :2]
    for corner in range(3):
        vertex = mesh.faces[:, corner]
        first = plane[mesh.faces[:, (corner + 1) % 3]] - plane[vertex]
        second = plane[mesh.faces[:, (corner + 2) % 3]] - plane[vertex]
        crosses = (first[:, 0] * second[:, 0] <= 0.0) & (first[:, 0] != second[:, 0])
        span = np.where(crosses, first[:, 0] - second[:, 0], 1.0)
        height = first[:, 1] + first[:, 0] / span * (second[:, 1] - first[:, 1])
        blocked[0, vertex[crosses & (height > 0.0)]] = True
        blocked[1, vertex[crosses & (height < 0.0)]] = True
    used = np.zeros(mesh.vertex_count, bool)
    used[mesh.faces] = True
    return used & ~blocked[0], used & ~blocked[1]


def find_slit(
    mesh: TriMesh,
    *,
    corners: tuple[int, int],
    upper: Sequence[int],
    lower: Sequence[int],
    exact_corners: bool = False,
) -> Slit:
    """Trace the contact lines of the slit between two `corners`.

    Parameters
    ----------
    mesh : TriMesh
        Skin in the canonical frame (the slit is seen from +z).
    corners : (int, int)
        Vertices at or near the ends of the slit.
    upper, lower : sequence of int
        Vertices at or near the upper and the lower line, from the first corner to the second;
        at least the middle one.
    exact_corners : bool
        Take `corners` as they are, and the shortest lines between the given vertices. Otherwise
        the ends are looked for where the two sides meet, which needs sides of like length.

    Raises
    ------
    MeshError
        If the corners are not connected, or the slit is closed: both lines run through the same
        vertices, or skin joins them (welded lips).
    """
    graph = edge_graph(mesh)
    up, down = opened_vertices(mesh)
    width = float(np.linalg.norm(mesh.positions[corners[0]] - mesh.positions[corners[1]]))
    if width == 0.0:
        raise MeshError("slit: its two corners are one point; check the landmarks of the corners")
    above = dijkstra(graph, indices=list(upper), min_only=True)
    below = dijkstra(graph, indices=list(lower), min_only=True)
    _require_gap(float(above[lower[len(lower) // 2]]), width)
    on_upper = above < below
    ends = corners
    if exact_corners:
        up[:] = down[:] = False
    else:
        ends = _commissures(mesh, graph, above, below, corners)
    upper_line = _trace(graph, [ends[0], *upper, ends[1]], prefer=down, allowed=on_upper)
    taken = np.zeros(mesh.vertex_count, bool)
    taken[upper_line[1:-1]] = True
    lower_line = _trace(
        graph, [ends[0], *lower, ends[1]], prefer=up, allowed=~on_upper, taken=taken
    )
    shared = np.intersect1d(upper_line[1:-1], lower_line[1:-1])
    if len(shared):
        raise MeshError(
            f"slit: upper and lower line share vertex {int(shared[0])}; they are welded, "
            "cut the mesh open between them"
        )
    if exact_corners:
        up, down = opened_vertices(mesh)
    confirmed = np.concatenate([down[upper_line], up[lower_line]])
    loop = np.zeros(mesh.vertex_count, bool)
    loop[upper_line] = True
    loop[lower_line] = True
    return Slit(upper_line, lower_line, _inside(mesh, loop), float(confirmed.mean()))


def _require_gap(across: float, width: float) -> None:
    """Refuse a slit that skin closes: between its middles there is no way round a bag or a hole."""
    if across < _WELDED * width:
        raise MeshError(
            f"slit: {across:.3g} mm of skin join the upper and the lower line (the slit is "
            f"{width:.3g} mm wide); they are welded, cut the mesh open between them"
        )


def edge_graph(mesh: TriMesh) -> csr_matrix:
    """Return the edges as a symmetric sparse matrix of their lengths [mm]."""
    ends = np.concatenate([mesh.faces[:, [0, 1]], mesh.faces[:, [1, 2]], mesh.faces[:, [2, 0]]])
    length = np.linalg.norm(mesh.positions[ends[:, 0]] - mesh.positions[ends[:, 1]], axis=1)
    both = np.concatenate([ends, ends[:, ::-1]])
    n = mesh.vertex_count
    order = coo_matrix((np.ones(len(both)), (both[:, 0], both[:, 1])), shape=(n, n)).tocsr()
    order.sum_duplicates()
    total = coo_matrix((np.tile(length, 2), (both[:, 0], both[:, 1])), shape=(n, n)).tocsr()
    total.sum_duplicates()
    # An edge of two triangles was counted twice; zero-length edges must stay edges.
    total.data = np.maximum(total.data / order.data, 1e-12)
    return total


def _commissures(
    mesh: TriMesh, graph: csr_matrix, above: FloatArray, below: FloatArray, corners: tuple[int, int]
) -> tuple[int, int]:
    """Return the vertices where upper and lower side meet at the two ends of the slit.

    The border between the sides runs from each commissure outwards over the face and inwards
    over the bag; the commissure is its waist, the place nearest to both middles. `above` and
    `below` (n,) are the distances to them [mm]; the landmark decides between like places.
    """
    on_upper = above < below
    rows = np.repeat(np.arange(mesh.vertex_count), np.diff(graph.indptr))
    border = np.zeros(mesh.vertex_count, bool)
    border[rows[on_upper[rows] != on_upper[graph.indices]]] = True
    first, second = mesh.positions[list(corners)]
    reach = _REACH * float(np.linalg.norm(second - first))
    result: list[int] = []
    for corner in corners:
        off = np.linalg.norm(mesh.positions - mesh.positions[corner], axis=1)
        near = np.flatnonzero(border & (off < reach))
        cost = np.maximum(above, below)[near] + _PULL * off[near]
        result.append(int(near[np.argmin(cost)]) if len(near) else corner)
    return result[0], result[1]


def _trace(
    graph: csr_matrix,
    stops: Sequence[int],
    *,
    prefer: BoolArray,
    allowed: BoolArray,
    taken: BoolArray | None = None,
) -> IntArray:
    """Return the cheapest line (k,) through `stops`, on `allowed` vertices where possible.

    Vertices that are `taken` by the other line are used last of all.
    """
    rows = np.repeat(np.arange(graph.shape[0]), np.diff(graph.indptr))
    cost = graph.data * np.where(prefer[rows] & prefer[graph.indices], _PREFERENCE, 1.0)
    closed = ~allowed
    closed[np.asarray(stops)] = False
    cost = np.where(closed[rows] | closed[graph.indices], cost * 1e4, cost)
    if taken is not None:
        # At a corner the sides may be labelled askew; the other line is worse than that.
        cost = np.where(taken[rows] | taken[graph.indices], cost * 1e4, cost)
    weighted = csr_matrix((cost, graph.indices, graph.indptr), shape=graph.shape)
    line: list[int] = [stops[0]]
    for start, goal in pairwise(stops):
        _, before = dijkstra(weighted, indices=start, return_predecessors=True)
        if start != goal and before[goal] < 0:
            raise MeshError(
                f"slit: vertices {start} and {goal} are not connected on the skin; "
                "check the landmarks of lips and lids"
            )
        piece = [goal]
        while piece[-1] != start:
            piece.append(int(before[piece[-1]]))
        line.extend(piece[-2::-1])
    return np.asarray(list(dict.fromkeys(_without_spikes(line))), np.int32)


def _without_spikes(line: list[int]) -> list[int]:
    """Drop what a line runs out and back again to a stop that lies beside it."""
    result: list[int] = []
    for vertex in line:
        if len(result) > 1 and result[-2] == vertex:
            result.pop()
        else:
            result.append(vertex)
    return result


def _inside(mesh: TriMesh, loop: BoolArray) -> BoolArray:
    """Return what the closed line cuts off from the largest remaining piece."""
    free = ~loop[mesh.faces]
    pairs = [(0, 1), (1, 2), (2, 0)]
    ends = np.concatenate([mesh.faces[free[:, a] & free[:, b]][:, [a, b]] for a, b in pairs])
    n = mesh.vertex_count
    graph = coo_matrix((np.ones(len(ends), np.int8), (ends[:, 0], ends[:, 1])), shape=(n, n))
    labels = connected_components(graph, directed=False)[1]
    candidates = np.flatnonzero(~loop)
    largest = np.bincount(labels[candidates]).argmax()
    inside = labels != largest
    inside[loop] = False
    return inside


def line_lengths(positions: FloatArray, line: IntArray) -> FloatArray:
    """Return the normalised arc length (k,) in [0, 1] along a `line` of vertices."""
    steps = np.linalg.norm(np.diff(positions[line], axis=0), axis=1)
    total = np.concatenate([[0.0], np.cumsum(steps)])
    return total / total[-1] if total[-1] > 0.0 else np.linspace(0.0, 1.0, len(line))
