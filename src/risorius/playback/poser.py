"""Pose a rig many times: blocks of frames as one matrix product."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import numpy as np
import numpy.typing as npt

from risorius._check import FloatArray
from risorius.errors import ShapeError
from risorius.rig.rig import Rig

__all__ = ["Poser"]

_BLOCK = 32
_MOST = 0.6  # share of vertices that move from which on it is quicker to pose all of them


class Poser:
    """Neutral and targets of a rig as dense tables, in float32.

    The tables hold the vertices that ever move (`vertices`), or all where most do.

    Parameters
    ----------
    rig : Rig

    Notes
    -----
    A frame alone reads all targets from memory; a block of frames reads them once. Targets that
    rest in the whole block are left out.
    """

    def __init__(self, rig: Rig) -> None:
        used = [target.vertices for target in rig.targets]
        self.vertices = np.unique(np.concatenate(used)) if used else np.zeros(0, np.int32)
        if len(self.vertices) > _MOST * rig.mesh.vertex_count:
            self.vertices = np.arange(rig.mesh.vertex_count, dtype=np.int32)
        self.neutral = rig.mesh.positions.astype(np.float32)
        self._table = np.zeros((len(rig.targets), 3 * len(self.vertices)), np.float32)
        for row, target in enumerate(rig.targets):
            places = np.searchsorted(self.vertices, target.vertices)
            self._table[row].reshape(-1, 3)[places] = target.deltas
        self._rest = self.neutral[self.vertices].ravel()

    def block(self, weights: npt.ArrayLike) -> npt.NDArray[np.float32]:
        """Return the positions (b, m, 3) of `vertices` for weights (b, t)."""
        rows = np.asarray(weights, np.float32)
        if rows.ndim != 2 or rows.shape[1] != len(self._table):
            raise ShapeError(f"weights: expected shape (b, {len(self._table)}), got {rows.shape}")
        active = rows.any(axis=0)
        moved = rows @ self._table if active.all() else rows[:, active] @ self._table[active]
        moved += self._rest
        return moved.reshape(len(rows), -1, 3)

    def frames(self, weights: Iterable[FloatArray]) -> Iterator[npt.NDArray[np.float32]]:
        """Go through frames of weights (t,) and give the positions (n, 3) of all vertices.

        Holds one block of frames at a time.
        """
        waiting: list[FloatArray] = []
        for row in weights:
            waiting.append(row)
            if len(waiting) == _BLOCK:
                yield from self._whole(waiting)
                waiting = []
        if waiting:
            yield from self._whole(waiting)

    def _whole(self, rows: list[FloatArray]) -> Iterator[npt.NDArray[np.float32]]:
        block = self.block(np.stack(rows))
        if len(self.vertices) == len(self.neutral):
            yield from block
            return
        for moved in block:
            positions = self.neutral.copy()
            positions[self.vertices] = moved
            yield positions
