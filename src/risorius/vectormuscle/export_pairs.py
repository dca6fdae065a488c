"""Corresponding points of two heads, each once."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from risorius._check import FloatArray, IntArray

__all__ = ["Pairs"]


@dataclass(frozen=True, eq=False)
class Pairs:
    """Correspondences that grow while muscles are fixed.

    Parameters
    ----------
    names : tuple of str
    source, target : (n, 3) float64
        Corresponding points [mm].
    exact : (k,) int32
        Rows that a warp must meet: ends of muscles that are fixed.
    merged : tuple of str
        Points that another one at the same place stands for.
    """

    names: tuple[str, ...]
    source: FloatArray
    target: FloatArray
    exact: IntArray
    merged: tuple[str, ...] = ()

    @staticmethod
    def empty() -> Pairs:
        """Return no pairs."""
        return Pairs((), np.zeros((0, 3)), np.zeros((0, 3)), np.zeros(0, np.int32))

    def __len__(self) -> int:
        return len(self.names)

    def with_pair(
        self, name: str, source: FloatArray, target: FloatArray, *, near: float, exact: bool = False
    ) -> Pairs:
        """Return the pairs and one more, each place once.

        A second centre at one place would make the network singular (spec vector-muscles 2.5):
        where another one lies within `near`, the end of a fixed muscle takes the place of a
        feature point or landmark, and anything else is left out.

        Parameters
        ----------
        name : str
        source, target : (3,) float64
            [mm]
        near : float
            Places closer than this are one [mm].
        exact : bool
            Whether a warp must meet it.
        """
        row = len(self)
        if row:
            distance = np.linalg.norm(self.source - source, axis=1)
            closest = int(np.argmin(distance))
            if distance[closest] <= near:
                if not exact or closest in self.exact:
                    return replace(self, merged=(*self.merged, name))
                return self._with_row(closest, name, source, target)
        longer = Pairs(
            (*self.names, name),
            np.vstack([self.source, source]),
            np.vstack([self.target, target]),
            self.exact,
            self.merged,
        )
        return longer._with_row(row, name, source, target) if exact else longer

    def _with_row(self, row: int, name: str, source: FloatArray, target: FloatArray) -> Pairs:
        """Return the pairs with an exact one in place of `row`."""
        names, here, there = list(self.names), self.source.copy(), self.target.copy()
        given_up = () if names[row] == name else (names[row],)
        names[row], here[row], there[row] = name, source, target
        exact = np.append(self.exact, row).astype(np.int32)
        return Pairs(tuple(names), here, there, exact, (*self.merged, *given_up))
