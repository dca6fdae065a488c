"""Merge the ends of muscles into the muscles that they lie in."""

from __future__ import annotations

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from risorius._check import IntArray
from risorius.springmuscle.ellipsoid import Ellipsoids
from risorius.springmuscle.muscle import FittedMuscle
from risorius.springmuscle.muscle_set import Links, MuscleSet

__all__ = ["merge_muscles"]


def merge_muscles(
    muscles: tuple[FittedMuscle, ...], *, hosts: tuple[bool, ...] | None = None, yielding: float
) -> MuscleSet:
    """Link every fibre whose end lies inside an ellipsoid of another muscle.

    Bodies that merely cross are never linked, and neither are muscles of opposite sides, except to
    one on the midline. Sphincters have no end (Kaehler et al. 2001, section 4.3).

    Parameters
    ----------
    muscles : tuple of FittedMuscle
    hosts : tuple of bool, optional
        Which of them ends may merge with; all, if left out.
    yielding : float
        See `Links`.
    """
    plain = MuscleSet(muscles)
    may_host = np.array([True] * len(muscles) if hosts is None else hosts)
    ends = plain.fibre_starts[1:] - 1
    sides = np.array([muscle.side for muscle in muscles])
    solids = Ellipsoids.of(plain)
    found: list[tuple[int, int, int, int]] = []
    for fibre, muscle in enumerate(plain.fibre_muscle):
        if plain.ring_muscles[muscle]:
            continue
        other = plain.segment_muscle
        wanted = (other != muscle) & may_host[other] & (sides[other] * sides[muscle] >= 0)
        segments = np.flatnonzero(wanted).astype(np.int32)
        end = plain.points[ends[fibre]]
        inside = solids.inside(np.tile(end, (len(segments), 1)), segments)
        found.extend(
            (fibre, int(ends[fibre]), int(plain.segment_fibre[s]), int(s)) for s in segments[inside]
        )
    table = np.array(found, np.int32).reshape(-1, 4)
    links = Links(
        np.ascontiguousarray(table[:, :2]),
        np.ascontiguousarray(table[:, 2:]),
        _groups(table, plain),
        yielding,
    )
    return MuscleSet(muscles, links)


def _groups(table: IntArray, muscles: MuscleSet) -> tuple[IntArray, ...]:
    """Return the segments that hang together through links, smallest number first."""
    if not len(table):
        return ()
    last = table[:, 1] - table[:, 0] - 1
    count = len(muscles.segment_fibre)
    graph = coo_matrix((np.ones(len(table)), (last, table[:, 3])), shape=(count, count))
    _, label = connected_components(graph, directed=False)
    linked = np.unique(np.concatenate([last, table[:, 3]]))
    groups = [linked[label[linked] == k] for k in np.unique(label[linked])]
    return tuple(group.astype(np.int32) for group in sorted(groups, key=lambda g: int(g[0])))
