"""Join vertices that lie at one place, and take values back to the vertices as given."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from risorius._check import FloatArray, IntArray, as_number, as_points
from risorius.errors import MeshError, ShapeError

__all__ = ["Weld", "weld"]

# More close pairs than this per vertex mean that the tolerance swallows the mesh.
_MOST_PAIRS = 64


@dataclass(frozen=True, eq=False)
class Weld:
    """How the n vertices of a mesh map to w welded ones.

    Parameters
    ----------
    representative : (n,) int32
        Welded vertex of each given vertex; welded vertices keep the order of their first member.
    first : (w,) int32
        First given vertex of each welded one; its position is the welded position.
    """

    representative: IntArray
    first: IntArray

    @property
    def is_identity(self) -> bool:
        """Whether nothing was joined."""
        return len(self.first) == len(self.representative)

    def compress(self, values: npt.NDArray[np.generic]) -> npt.NDArray[np.generic]:
        """Return `values` (n, ...) of the first members, as (w, ...)."""
        return values[self.first]

    def expand(self, values: npt.NDArray[np.generic]) -> npt.NDArray[np.generic]:
        """Return `values` (w, ...) at every given vertex, as (n, ...)."""
        return values[self.representative]

    def faces(self, faces: IntArray) -> IntArray:
        """Return `faces` (m, 3) over welded vertices; faces may collapse, none is dropped."""
        return self.representative[faces]


def weld(
    positions: npt.ArrayLike, *, tolerance: float = 1e-6, keep_apart: IntArray | None = None
) -> Weld:
    """Join vertices closer than a tolerance.

    Parameters
    ----------
    positions : (n, 3) array_like
        Vertices [any unit].
    tolerance : float
        Largest distance joined, as a share of the bounding box diagonal; 0 joins equal
        positions only. Chains are joined as a whole.
    keep_apart : (k, 2) int, optional
        Pairs of vertices that must stay different: lips that touch at rest. A third vertex at
        their place joins the nearer one, on a tie the one with the smaller index.

    Raises
    ------
    MeshError
        If so many vertices lie within the tolerance that it would swallow the shape, for example
        because a stray vertex far away inflates the bounding box.

    Notes
    -----
    Distances are compared as they are, never rounded to a grid, so no pair is missed at a cell
    border. O(n log n).
    """
    points = as_points("positions", positions)
    tolerance = as_number("tolerance", tolerance, low=0.0)
    n = len(points)
    if not n:
        return Weld(np.zeros(0, np.int32), np.zeros(0, np.int32))
    distinct, place = np.unique(points, axis=0, return_inverse=True)
    pairs = _close_pairs(distinct, tolerance * float(np.linalg.norm(np.ptp(distinct, axis=0))))
    graph = coo_matrix(
        (np.ones(len(pairs), np.int8), (pairs[:, 0], pairs[:, 1])), shape=(len(distinct),) * 2
    )
    labels: IntArray = connected_components(graph, directed=False)[1][place.ravel()]
    if keep_apart is not None and len(keep_apart):
        labels = _separate(points, labels, _as_pairs(keep_apart, n))
    return _in_order(labels)


def _close_pairs(distinct: FloatArray, distance: float) -> npt.NDArray[np.intp]:
    none = np.zeros((0, 2), np.intp)
    if distance == 0.0:
        return none
    tree = cKDTree(distinct)
    count = (int(tree.count_neighbors(tree, distance)) - len(distinct)) // 2
    if count > _MOST_PAIRS * len(distinct):
        raise MeshError(
            f"positions: {count} pairs of {len(distinct)} vertices lie within the welding "
            f"tolerance of {distance:g}; remove stray vertices that inflate the bounding box, "
            "or lower the tolerance"
        )
    return tree.query_pairs(distance, output_type="ndarray") if count else none


def _as_pairs(keep_apart: IntArray, vertex_count: int) -> IntArray:
    pairs = np.asarray(keep_apart)
    if pairs.ndim != 2 or pairs.shape[1] != 2:
        raise ShapeError(f"keep_apart: expected shape (k, 2), got {pairs.shape}")
    if pairs.min() < 0 or pairs.max() >= vertex_count:
        raise ShapeError(f"keep_apart: indices must lie in 0..{vertex_count - 1}")
    bad = pairs[:, 0] == pairs[:, 1]
    if bad.any():
        row = int(np.argmax(bad))
        raise ShapeError(f"keep_apart: row {row} pairs vertex {int(pairs[row, 0])} with itself")
    return pairs


def _separate(points: FloatArray, labels: IntArray, apart: IntArray) -> IntArray:
    """Split every class that holds a pair of `apart`."""
    labels = labels.copy()
    torn = labels[apart[:, 0]] == labels[apart[:, 1]]
    affected = np.unique(labels[apart[torn, 0]])
    members = np.flatnonzero(np.isin(labels, affected))
    enemies: dict[int, set[int]] = {}
    for first, second in apart[torn].tolist():
        enemies.setdefault(first, set()).add(second)
        enemies.setdefault(second, set()).add(first)
    fresh = int(labels.max()) + 1
    for label in affected.tolist():
        group = members[labels[members] == label]
        for part in _split(points, group, enemies)[1:]:
            labels[part] = fresh
            fresh += 1
    return labels


def _split(
    points: FloatArray, group: npt.NDArray[np.intp], enemies: dict[int, set[int]]
) -> list[list[int]]:
    """Divide one class greedily: vertices with enemies first, then the others to the nearest."""
    order = sorted(group.tolist(), key=lambda vertex: (vertex not in enemies, vertex))
    parts: list[list[int]] = []
    for vertex in order:
        foes = enemies.get(vertex, set())
        allowed = [part for part in parts if foes.isdisjoint(part)]
        if not allowed:
            parts.append([vertex])
            continue
        distance = [np.linalg.norm(points[part] - points[vertex], axis=1).min() for part in allowed]
        allowed[int(np.argmin(distance))].append(vertex)
    return parts


def _in_order(labels: IntArray) -> Weld:
    _, first, inverse = np.unique(labels, return_index=True, return_inverse=True)
    order = np.argsort(first)
    rank = np.empty(len(order), np.int32)
    rank[order] = np.arange(len(order))
    return Weld(rank[inverse], first[order].astype(np.int32))
