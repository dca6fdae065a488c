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


def merge_muscles(muscles: tuple[FittedMuscle, ...], *, yielding: float) -> MuscleSet:
    """Link every fibre whose end lies inside an ellipsoid of another muscle.

    Bodies that merely cross are never linked, and neither are muscles of opposite sides, except to
    one on the midline. Sphincters have no end (Kaehler et al. 2001, section 4.3).

    Parameters
    ----------
    muscles : tuple of FittedMuscle
    yielding : float
        See `Links`.
    """
    plain = MuscleSet(muscles)
    fibres = np.flatnonzero(~plain.ring_muscles[plain.fibre_muscle])
    ends = plain.fibre_starts[1:][fibres] - 1
    own, other = plain.fibre_muscle[fibres], plain.segment_muscle
    sides = np.array([muscle.side for muscle in muscles], np.int32)
    hosts = np.array([muscle.action.host for muscle in muscles], bool)
    wanted = (own[:, None] != other) & hosts[other] & (sides[own][:, None] * sides[other] >= 0)
    # Only ellipsoids that reach as far as the end are asked.
    apart = np.linalg.norm(plain.points[ends][:, None] - plain.centres[None], axis=2)
    row, segment = np.nonzero(wanted & (apart <= plain.half_axes.max(axis=1)))
    inside = Ellipsoids.of(plain).inside(plain.points[ends[row]], segment.astype(np.int32))
    row, segment = row[inside], segment[inside].astype(np.int32)
    links = Links(
        np.stack([fibres[row], ends[row]], axis=1).astype(np.int32),
        np.stack([plain.segment_fibre[segment], segment], axis=1).astype(np.int32),
        _groups(ends[row] - fibres[row] - 1, segment, len(other)),
        yielding,
    )
    return MuscleSet(muscles, links)


def _groups(ends: IntArray, hosts: IntArray, count: int) -> tuple[IntArray, ...]:
    """Return which of `count` segments hang together through links, smallest number first."""
    if not len(ends):
        return ()
    graph = coo_matrix((np.ones(len(ends)), (ends, hosts)), shape=(count, count))
    _, label = connected_components(graph, directed=False)
    linked = np.unique(np.concatenate([ends, hosts]))
    groups = [linked[label[linked] == k] for k in np.unique(label[linked])]
    return tuple(group.astype(np.int32) for group in sorted(groups, key=lambda g: int(g[0])))
