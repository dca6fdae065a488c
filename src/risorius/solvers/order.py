"""The order in which constraints are projected.

A Gauss-Seidel sweep gives a result that depends on its order, so the order is part of the method:
kinds one after the other (holds, distances, areas, bends, volumes, contacts; open point O3), and
within a kind groups of constraints that share no particle, filled in the order in which a walk
over the net of particles meets them. All ways to run a model use this one order.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import reverse_cuthill_mckee

from risorius._check import IntArray
from risorius.errors import MeshError
from risorius.solvers.constraints import Constraints
from risorius.solvers.kernels.grouping import group_disjoint
from risorius.solvers.kernels.simd import PACK

__all__ = ["Order", "order_of", "sequence"]

# So many groups in a row share no particle either: the processor works on them side by side.
_APART = 2


@dataclass(frozen=True, eq=False)
class Order:
    """Groups of rows of each table; a group's constraints share no particle.

    Parameters
    ----------
    particles : (n,) int32
        Particles in the order in which they lie in memory.
    distances, areas, bends : (g, 16) int32
        Row numbers, -1 where a group is not full.
    holds : (k,) int32
        Row numbers.
    """

    particles: IntArray
    distances: IntArray
    areas: IntArray
    bends: IntArray
    holds: IntArray


def sequence(groups: IntArray) -> IntArray:
    """Return the row numbers (k,) of `groups` (g, 16) one after the other."""
    flat = groups.ravel()
    return flat[flat >= 0]


def order_of(
    constraints: Constraints, particle_count: int, *, mirror: IntArray | None = None
) -> Order:
    """Return the order of `constraints`; those of stiffness 0 are left out.

    Parameters
    ----------
    constraints : Constraints
    particle_count : int
    mirror : (n,) int32, optional
        The particle opposite to each. Mirrored constraints then go into the same group, so that
        a symmetric problem keeps a symmetric solution but for the constraints that share a
        particle with their own mirror image, next to the midline.
    """
    particles = _walk(constraints, particle_count)
    rank = np.empty(particle_count, np.int64)
    rank[particles] = np.arange(particle_count)
    groups: list[IntArray] = []
    for table in (constraints.distances, constraints.areas, constraints.bends):
        used = np.flatnonzero(table.stiffness > 0.0)
        ranks = np.sort(rank[table.particles[used]], axis=1)
        keys = [ranks[:, column] for column in range(ranks.shape[1] - 1, -1, -1)]
        used = used[np.lexsort(keys)]
        rows = table.particles[used]
        partners = _partners(rows, mirror)
        found = group_disjoint(rows, partners, particle_count, _APART * PACK).reshape(-1, PACK)
        found = found[(found >= 0).any(axis=1)]
        groups.append(np.where(found >= 0, used[found], -1).astype(np.int32))
    holds = np.flatnonzero(constraints.holds.stiffness > 0.0)
    holds = holds[np.argsort(rank[constraints.holds.particles[holds]], kind="stable")]
    distances, areas, bends = groups
    return Order(particles, distances, areas, bends, holds.astype(np.int32))


def _walk(constraints: Constraints, particle_count: int) -> IntArray:
    """Return the particles in reverse Cuthill-McKee order: neighbours lie close in memory."""
    pairs = [constraints.distances.particles]
    for triangles in (constraints.areas.particles, *(v.faces for v in constraints.volumes)):
        pairs += [triangles[:, [0, 1]], triangles[:, [1, 2]]]
    first, second = np.concatenate(pairs).T
    rows, columns = np.concatenate([first, second]), np.concatenate([second, first])
    entries = np.ones(len(rows), np.int8)
    graph = csr_matrix((entries, (rows, columns)), shape=(particle_count, particle_count))
    return reverse_cuthill_mckee(graph, symmetric_mode=True).astype(np.int32)


def _partners(rows: IntArray, mirror: IntArray | None) -> IntArray:
    """Return the row that is the mirror image of each and shares no particle with it, else -1."""
    none = np.full(len(rows), -1, np.int32)
    if mirror is None or not len(rows):
        return none
    own = np.sort(rows, axis=1)
    other = np.sort(mirror[rows], axis=1)
    _, inverse = np.unique(np.concatenate([own, other]), axis=0, return_inverse=True)
    inverse = inverse.ravel()
    place = np.full(int(inverse.max()) + 1, -1, np.int32)
    # Of rows that name the same particles the last one counts.
    place[inverse[: len(rows)]] = np.arange(len(rows))
    found = place[inverse[len(rows) :]]
    mutual = (found >= 0) & (found[found] == np.arange(len(rows)))
    apart = np.ones(len(rows), bool)
    for column in range(rows.shape[1]):
        apart &= (own != other[:, column : column + 1]).all(axis=1)
    return np.where(mutual & apart, found, none).astype(np.int32)


def require_mirror(mirror: IntArray, particle_count: int) -> None:
    """Raise `MeshError` unless `mirror` (n,) leads from every particle to another and back."""
    if mirror.shape != (particle_count,) or (mirror[mirror] != np.arange(particle_count)).any():
        raise MeshError(
            f"mirror: must name for each of {particle_count} particles the one opposite to it, "
            "and that one must name it in turn"
        )
