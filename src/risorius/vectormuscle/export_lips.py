"""Tell the lips apart in the frontal projection, as published, and compare with the detector."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import dijkstra

from risorius._check import BoolArray, FloatArray, IntArray, as_points
from risorius.head.head import Head
from risorius.landmarks.landmark_set import LandmarkSet
from risorius.landmarks.sides import require
from risorius.mesh.connectivity import edges as edges_of
from risorius.mesh.lips import LipSides

__all__ = [
    "LipComparison",
    "OpenedLips",
    "compare_lips",
    "detected_lips",
    "opened_lips",
    "opened_vertices",
]

# The search window is this much wider than the mouth.
_BESIDE = 0.05
# How far behind the lips contact vertices are looked for, share of the mouth's width.
_BEHIND = 0.2
# How far from the contact line the detector speaks of a lip, share of the mouth's width.
_REACH = 0.35
# The same behind the contact line.
_LINING = 0.12


@dataclass(frozen=True, eq=False)
class OpenedLips:
    """Lips by opened vertices (spec vector-muscles 2.7 step 3).

    Parameters
    ----------
    upper_contact, lower_contact : (k,) int32
        Contact line of the upper lip (lower-opened vertices) and of the lower lip.
    upper, lower : (n,) bool
        Vertices between the contact line and the nose, and between it and the chin.
    """

    upper_contact: IntArray
    lower_contact: IntArray
    upper: BoolArray
    lower: BoolArray


@dataclass(frozen=True)
class LipComparison:
    """How far opened vertices and the shared detector agree.

    Parameters
    ----------
    vertex_count : int
        Vertices in front of the mouth that opened vertices decide on.
    agreement : float
        Share of them with the side that the detector gives.
    """

    vertex_count: int
    agreement: float


def opened_vertices(positions: npt.ArrayLike, faces: IntArray) -> tuple[BoolArray, BoolArray]:
    """Return the masks (n,) of vertices that are open upwards, and downwards.

    In the frontal projection a vertex is open upwards if no triangle at it holds the direction
    +y in its angle there: all of its star lies below (erratum E9).

    Parameters
    ----------
    positions : (n, 3) array_like
        [mm]
    faces : (m, 3) int32
    """
    points = as_points("positions", positions)[:, :2]
    closed = np.zeros((2, len(points)), bool)
    used = np.zeros(len(points), bool)
    used[faces.ravel()] = True
    for corner in range(3):
        here = faces[:, corner]
        first = points[faces[:, (corner + 1) % 3]] - points[here]
        second = points[faces[:, (corner + 2) % 3]] - points[here]
        area = first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]
        turn = np.sign(area)
        for row, sign in enumerate((1.0, -1.0)):
            # (0, sign) = s first + t second with s, t >= 0.
            s = -sign * second[:, 0] * turn
            t = sign * first[:, 0] * turn
            closed[row, here[(turn != 0.0) & (s >= 0.0) & (t >= 0.0)]] = True
    return used & ~closed[0], used & ~closed[1]


def opened_lips(head: Head) -> OpenedLips:
    """Find the contact lines of a head's lips and what belongs to each lip.

    Looked for between the base of the nose and the chin, between the mouth corners and not far
    behind the lips: nostrils, the chin and a mouth bag fold over as well.

    Raises
    ------
    LandmarkError
        If landmarks of mouth, nose or chin are missing.
    """
    needed = ("2.1", "2.2", "2.3", "2.4", "2.5", "9.3")
    require(head.landmarks, needed, purpose="the lips")
    mesh, marks = head.skin.mesh, head.landmarks
    points = mesh.positions
    window = _window(points, marks)
    up, down = opened_vertices(points, mesh.faces)
    edge_of_mouth = window & _near_lips(points, marks)
    lower_contact = np.flatnonzero(up & edge_of_mouth).astype(np.int32)
    upper_contact = np.flatnonzero(down & edge_of_mouth).astype(np.int32)
    edges = edges_of(mesh.faces)
    ends = np.concatenate([edges, edges[:, ::-1]])
    ends = ends[window[ends].all(axis=1)]
    tip, chin = float(marks.position("9.3")[1]), float(marks.position("2.1")[1])
    rising = ends[points[ends[:, 1], 1] >= points[ends[:, 0], 1]]
    falling = ends[points[ends[:, 1], 1] <= points[ends[:, 0], 1]]
    to_upper = _steps(rising, upper_contact, lower_contact, len(points))
    to_lower = _steps(falling, lower_contact, upper_contact, len(points))
    upper = (to_upper < to_lower) & (points[:, 1] <= tip)
    lower = (to_lower < to_upper) & (points[:, 1] >= chin)
    return OpenedLips(upper_contact, lower_contact, upper, lower)


def compare_lips(head: Head, opened: OpenedLips, lips: LipSides) -> LipComparison:
    """Compare opened vertices with the shared detector on the skin before the mouth."""
    decided = (opened.upper | opened.lower) & ~lips.inside & ~lips.corner
    count = int(decided.sum())
    same = (opened.upper & lips.upper) | (opened.lower & lips.lower)
    return LipComparison(count, float(same[decided].mean()) if count else 0.0)


def detected_lips(lips: LipSides) -> tuple[BoolArray, BoolArray]:
    """Return the masks (n,) of the upper and the lower lip by the shared detector.

    The surer way: it also knows the lining and lips that hang over each other.
    """
    near = lips.distance < np.where(lips.inside, _LINING, _REACH) * lips.width
    return lips.upper & near, lips.lower & near


def _window(points: FloatArray, marks: LandmarkSet) -> BoolArray:
    top = marks.position("9.3")[1]
    bottom = marks.position("2.1")[1]
    ends = marks.positions(("2.4", "2.5"))[:, 0]
    beside = _BESIDE * float(np.ptp(ends))
    inside = (points[:, 0] >= ends.min() - beside) & (points[:, 0] <= ends.max() + beside)
    return inside & (points[:, 1] >= bottom) & (points[:, 1] <= top)


def _near_lips(points: FloatArray, marks: LandmarkSet) -> BoolArray:
    """Return the mask (n,) of what may be a contact line: below the nose and not far inside."""
    lips = marks.positions(("2.2", "2.3", "2.4", "2.5"))
    width = float(np.linalg.norm(lips[2] - lips[3]))
    # The mouth is curved: how far back a lip lies depends on how far it lies aside.
    middle, half = lips[2:, 0].mean(), 0.5 * width
    aside = np.clip(np.abs(points[:, 0] - middle) / half, 0.0, 1.0)
    front, corner = lips[:2, 2].mean(), lips[2:, 2].mean()
    depth = front + (corner - front) * aside**2
    low, high = 0.6, 0.4
    tall = np.abs(marks.position("9.3")[1] - marks.position("2.1")[1])
    base = lips[:, 1].mean()
    level = (points[:, 1] > base - low * 0.5 * tall) & (points[:, 1] < base + high * 0.5 * tall)
    return level & (points[:, 2] > depth - _BEHIND * width)


def _steps(ends: IntArray, sources: IntArray, barred: IntArray, vertex_count: int) -> FloatArray:
    """Return the least number of edges (n,) from `sources` that does not cross `barred`."""
    if not len(sources):
        return np.full(vertex_count, np.inf)
    blocked = np.zeros(vertex_count, bool)
    blocked[barred] = True
    free = ends[~blocked[ends].any(axis=1)]
    ones = np.ones(len(free))
    graph = csr_matrix((ones, (free[:, 0], free[:, 1])), shape=(vertex_count, vertex_count))
    return np.asarray(dijkstra(graph, indices=sources, min_only=True, unweighted=True))
