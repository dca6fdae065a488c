"""How springs lie in the tables of the kernels."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import reverse_cuthill_mckee

from risorius._check import BoolArray, FloatArray, IntArray
from risorius.solvers.kernels.simd import PACK
from risorius.solvers.kernels.tables import aligned_zeros

__all__ = ["PackLayout", "PackTables", "SpringTables", "pack_layout"]

Table = npt.NDArray[Any]
# Neighbours stay this near to each other in memory, so that the fast cache holds them.
_WINDOW = 2048


class SpringTables(NamedTuple):
    """What the scalar reference reads: the arrays of network and control as they are."""

    edges: Table
    rest_lengths: Table
    knee_lengths: Table
    stiffness: Table
    stiffening: float
    anchored: Table
    anchors: Table
    anchor_lengths: Table
    anchor_stiffness: Table
    hold_targets: Table
    hold_stiffness: Table
    load: Table
    inv_mass: Table


class PackTables(NamedTuple):
    """What the packed kernel reads, flat and in float32.

    Particles stand in blocks of `PACK`; `*_start` gives the first slot of each block, and the
    end. A slot holds one spring of each particle of the block: first `PACK` numbers of one kind,
    then the next field: stiffness, stiffness times rest length, knee length of an edge; place,
    stiffness, stiffness times rest length of an anchor. What fills up a slot has stiffness 0.
    """

    edge_start: Table
    neighbours: Table
    edge_rows: Table
    stiffening: Table
    anchor_start: Table
    anchor_rows: Table
    hold_targets: Table
    hold_stiffness: Table
    load: Table
    inv_mass: Table
    own: Table


@dataclass(frozen=True, eq=False)
class PackLayout:
    """Where particles and springs lie in the packed tables.

    Parameters
    ----------
    order : (f,) int32
        Particles that move in the order of the blocks: neighbours near each other, and among those
        the ones with the most edges first, so that the particles of a block have about as many.
    fixed : (m,) int32
        Particles that never move; their rows lie behind the blocks, nothing is computed for them.
    rank : (n,) int64
        Row of each particle.
    block_count : int
    edge_start : (b + 1,) int64
        First slot of each block.
    neighbours : (s,) uint32
        Row of the other end of each edge.
    edge_place : (h,) int64
        Entry of each edge, seen from its first ends and then from its second ends, those that
        move: slot * PACK + lane.
    edge_number : (h,) int64
        Which edge that is.
    """

    order: IntArray
    fixed: IntArray
    rank: npt.NDArray[np.int64]
    block_count: int
    edge_start: npt.NDArray[np.int64]
    neighbours: npt.NDArray[np.uint32]
    edge_place: npt.NDArray[np.int64]
    edge_number: npt.NDArray[np.int64]

    @property
    def padded_count(self) -> int:
        """Number of particles that move, with those that fill up the last block."""
        return self.block_count * PACK

    def vectors(self, values: FloatArray) -> Table:
        """Return vectors (n, 3) of the particles as the kernel keeps them (3 padded,)."""
        result = aligned_zeros(3 * self.padded_count, np.float32)
        padded = np.zeros((self.padded_count, 3), np.float32)
        padded[: len(self.order)] = values[self.order]
        result[:] = padded.reshape(-1, PACK, 3).swapaxes(1, 2).ravel()
        return result

    def vectors_back(self, table: Table) -> FloatArray:
        """Return vectors (n, 3) of the particles from what the kernel keeps, 0 of fixed ones."""
        rows = table.reshape(-1, 3, PACK).swapaxes(1, 2).reshape(-1, 3)
        result = np.zeros((len(self.rank), 3))
        result[self.order] = rows[: len(self.order)]
        return result

    def scalars(self, values: FloatArray) -> Table:
        """Return numbers (n,) of the particles as the kernel keeps them (padded,)."""
        result = aligned_zeros(self.padded_count, np.float32)
        result[: len(self.order)] = values[self.order]
        return result

    def rows(self, vectors: Table, fixed: FloatArray) -> Table:
        """Return the rows x, y, z, 0 (4r,) of vectors (3 padded,) and of fixed particles (m, 3)."""
        result = aligned_zeros(4 * (self.padded_count + len(self.fixed)), np.float32)
        rows = result.reshape(-1, 4)
        moving = vectors.reshape(-1, 3, PACK).swapaxes(1, 2).reshape(-1, 3)
        rows[: self.padded_count, :3] = moving
        rows[self.padded_count :, :3] = fixed
        return result

    def edge_fields(self, *fields: FloatArray) -> Table:
        """Return numbers (e,) of the edges side by side as the kernel keeps them."""
        spread = [field[self.edge_number] for field in fields]
        return _fields(spread, self.edge_place, self.edge_start)

    def anchor_fields(
        self, anchored: IntArray, *fields: FloatArray
    ) -> tuple[npt.NDArray[np.int64], Table]:
        """Return first slots (b + 1,) and numbers (a,) of anchor springs as the kernel keeps them.

        `anchored` (a,) are their particles; laid out anew each time, since most of the springs of
        a network may be slack.
        """
        ranks = self.rank[anchored]
        moving = ranks < self.padded_count
        place, start = _slots(ranks[moving], self.block_count)
        return start, _fields([field[moving] for field in fields], place, start)

    def own_rows(self) -> Table:
        """Return the row (padded,) of each particle that moves, in entries."""
        return (4 * np.arange(self.padded_count)).astype(np.uint32)


def pack_layout(edges: IntArray, fixed: BoolArray) -> PackLayout:
    """Lay out `edges` (e, 2) between particles of which some are `fixed` (n,)."""
    count = len(fixed)
    ends, others = edges.T.ravel(), edges[:, ::-1].T.ravel()
    degree = np.bincount(ends, minlength=count)
    near = _near_order(edges, count)
    near = near[~fixed[near]]
    order = near[np.lexsort((-degree[near], np.arange(len(near)) // _WINDOW))]
    blocks = max(1, -(-len(order) // PACK))
    still = np.flatnonzero(fixed).astype(np.int32)
    rank = np.empty(count, np.int64)
    rank[order] = np.arange(len(order))
    rank[still] = blocks * PACK + np.arange(len(still))
    moving = np.flatnonzero(~fixed[ends])
    edge_place, edge_start = _slots(rank[ends[moving]], blocks)
    # What fills up a slot is an edge from a particle to itself.
    own = np.arange(blocks * PACK).reshape(blocks, PACK)
    neighbours = np.repeat(own, np.diff(edge_start), axis=0).ravel()
    neighbours[edge_place] = rank[others[moving]]
    return PackLayout(
        order, still, rank, blocks, edge_start, (4 * neighbours).astype(np.uint32), edge_place,
        moving % max(len(edges), 1),
    )  # fmt: skip


def _near_order(edges: IntArray, particle_count: int) -> IntArray:
    """Return the particles (n,) so that neighbours are near each other."""
    both = np.concatenate([edges, edges[:, ::-1]])
    shape = (particle_count, particle_count)
    graph = csr_matrix((np.ones(len(both)), (both[:, 0], both[:, 1])), shape=shape)
    return np.asarray(reverse_cuthill_mckee(graph, symmetric_mode=True), np.int32)


def _slots(
    ranks: npt.NDArray[np.int64], blocks: int
) -> tuple[npt.NDArray[np.int64], npt.NDArray[np.int64]]:
    """Return the entry (s,) of each spring of the particles `ranks` (s,), and the slots' starts."""
    counts = np.bincount(ranks, minlength=blocks * PACK)
    start = np.concatenate([[0], np.cumsum(counts.reshape(blocks, PACK).max(axis=1))])
    sequence = np.argsort(ranks, kind="stable")
    first = np.concatenate([[0], np.cumsum(counts)])[ranks[sequence]]
    number = np.empty(len(ranks), np.int64)
    number[sequence] = np.arange(len(ranks)) - first
    return (start[ranks // PACK] + number) * PACK + ranks % PACK, start


def _fields(
    fields: list[FloatArray], place: npt.NDArray[np.int64], start: npt.NDArray[np.int64]
) -> Table:
    count = len(fields)
    result = aligned_zeros(int(start[-1]) * count * PACK, np.float32)
    slot, lane = np.divmod(place, PACK)
    for number, field in enumerate(fields):
        result[(slot * count + number) * PACK + lane] = field
    return result
