"""From the contour of a sheet to the vertices of its muscle mesh."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_matrix, csc_matrix
from scipy.sparse.linalg import splu

from risorius._check import FloatArray, IntArray
from risorius.errors import ShapeError
from risorius.layered.faithful.action_line import ActionLine
from risorius.warp.rbf import RbfWarp

__all__ = ["Contour", "contour_vertices", "fill_grid", "harmonic_fill", "require_apart"]

# Largest gap between lines that should meet, as share of the contour's length (spec 6).
_OPEN = 0.02


@dataclass(frozen=True, eq=False)
class Contour:
    """Four action lines head to tail.

    Parameters
    ----------
    lines : tuple of ActionLine
        A0 from origin to insertion, A1 across the insertion, A2 back to the origin, A3 across it.
    """

    lines: tuple[ActionLine, ActionLine, ActionLine, ActionLine]

    def require_closed(self, positions: FloatArray, faces: IntArray) -> None:
        """Raise `ShapeError` if lines do not meet."""
        places = [line.places(positions, faces) for line in self.lines]
        steps = [np.linalg.norm(np.diff(row, axis=0), axis=1).sum() for row in places]
        for number, row in enumerate(places):
            following = places[(number + 1) % 4]
            gap = float(np.linalg.norm(following[0] - row[-1]))
            if gap > _OPEN * float(np.sum(steps)):
                raise ShapeError(
                    f"contour: line {number} ends {gap:.3g} mm from the start of line "
                    f"{(number + 1) % 4}; the four lines must meet head to tail"
                )


def require_apart(sides: Sequence[FloatArray]) -> None:
    """Raise `ShapeError` if opposite sides cross, seen across their best plane (spec 6).

    Parameters
    ----------
    sides : sequence of (k, 3) float64
        The four sides of a contour as drawn, head to tail [mm].
    """
    middle = np.concatenate(sides).mean(axis=0)
    across = np.linalg.svd(np.concatenate(sides) - middle, full_matrices=False)[2][:2]
    flat = [(row - middle) @ across.T for row in sides]
    for one, other in ((0, 2), (1, 3)):
        found = _first_crossing(flat[one], flat[other])
        if found is not None:
            raise ShapeError(
                f"contour: segment {found[0]} of line {one} crosses segment {found[1]} of line "
                f"{other}; opposite sides of a muscle must not meet, draw it wider there or with "
                "a gentler bend"
            )


def _first_crossing(first: FloatArray, second: FloatArray) -> tuple[int, int] | None:
    """Return the segments of two flat polylines (k, 2), (l, 2) that cross, None if none do."""
    a, b = first[:-1, None], first[1:, None]
    c, d = second[None, :-1], second[None, 1:]

    def side(p: FloatArray, q: FloatArray, r: FloatArray) -> FloatArray:
        u, v = q - p, r - p
        return u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0]

    crossing = (side(a, b, c) * side(a, b, d) < 0.0) & (side(c, d, a) * side(c, d, b) < 0.0)
    if not crossing.any():
        return None
    i, j = np.argwhere(crossing)[0]
    return int(i), int(j)


def contour_vertices(rows: int, columns: int) -> tuple[IntArray, IntArray, IntArray, IntArray]:
    """Return the bottom vertices of the samples of A0 (h,), A1 (w,), A2 (h,) and A3 (w,).

    Vertex ``r w + c`` stands in row r along the fibres and column c (thesis 4.8, erratum E10).
    """
    h, w = rows, columns
    i, j = np.arange(h, dtype=np.int32), np.arange(w, dtype=np.int32)
    return i * w, (h - 1) * w + j, (h - i) * w - 1, w - 1 - j


def fill_grid(known: IntArray, places: FloatArray, *, rows: int, columns: int) -> FloatArray:
    """Return all bottom vertices (h*w, 3) of a sheet from some of them.

    Radial basis functions from the flat grid, with a polynomial in its plane: the flat contour
    lies in one plane and the system in space is singular (erratum E11).

    Parameters
    ----------
    known : (k,) int32
        Vertices whose places are given, the contour among them.
    places : (k, 3) float64
        Where they are [mm].
    rows, columns : int
        h and w.
    """
    if len(known) == rows * columns:
        result = np.empty((rows * columns, 3))
        result[known] = places
        return result
    size = float(np.linalg.norm(np.ptp(places, axis=0))) / max(rows, columns)
    r, c = np.divmod(np.arange(rows * columns), columns)
    flat = size * np.stack([c, r, np.zeros(rows * columns)], axis=1).astype(np.float64)
    warp = RbfWarp.fit(flat[known], places, polynomial="in_plane")
    result = warp(flat)
    result[known] = places
    return result


def harmonic_fill(known: IntArray, values: FloatArray, *, rows: int, columns: int) -> FloatArray:
    """Return values (h*w, d) on the grid that are the mean of their neighbours where not known.

    Parameters
    ----------
    known : (k,) int32
    values : (k, d) float64
    rows, columns : int
    """
    index = np.arange(rows * columns).reshape(rows, columns)
    pairs = np.concatenate(
        [
            np.stack([index[:, :-1].ravel(), index[:, 1:].ravel()], axis=1),
            np.stack([index[:-1].ravel(), index[1:].ravel()], axis=1),
        ]
    )
    both = np.concatenate([pairs, pairs[:, ::-1]])
    n = rows * columns
    graph = csc_matrix(coo_matrix((np.ones(len(both)), (both[:, 0], both[:, 1])), shape=(n, n)))
    result = np.zeros((n, values.shape[1]))
    result[known] = values
    free = np.setdiff1d(np.arange(n), known)
    if not len(free):
        return result
    degree = np.asarray(graph.sum(axis=1)).ravel()
    right = np.asarray(graph[free] @ result)
    inner = -graph[free][:, free]
    inner.setdiag(degree[free])
    result[free] = splu(csc_matrix(inner)).solve(right)
    return result
