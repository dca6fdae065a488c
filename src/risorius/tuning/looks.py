"""What a person sees of candidates, in numbers; no face is made twice."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Mapping

import numpy as np
import numpy.typing as npt

from risorius._check import FloatArray
from risorius.errors import ParameterError, ShapeError
from risorius.tuning.candidates import Candidates, Gallery
from risorius.tuning.genome import Genome

__all__ = ["Looks"]

# Strategies see at most so many vertices; faces are smooth.
_MOST_VERTICES = 3000
# Whole faces that are remembered; those of two generations.
_FACES = 24
# Differences are taken over this share of a range: far beyond rounding, near enough to be a slope.
_REACH = 0.08


class Looks:
    """Candidates that remember their faces, and how faces change with values.

    Parameters
    ----------
    candidates : Candidates
    weights : (n,) array_like, optional
        What counts of each vertex; default everything that is seen to move, alike.
    """

    def __init__(self, candidates: Candidates, *, weights: npt.ArrayLike | None = None) -> None:
        self._candidates = candidates
        self._faces: OrderedDict[bytes, FloatArray] = OrderedDict()
        self._seen: dict[bytes, FloatArray] = {}
        self._slopes: dict[bytes, FloatArray] = {}
        rest = self.positions(self.genome.named(self.genome.start))
        count = len(rest)
        share = np.ones(count) if weights is None else np.asarray(weights, np.float64)
        if share.shape != (count,):
            raise ShapeError(f"weights: expected shape ({count},), got {share.shape}")
        counted = np.flatnonzero(share > 0.0)
        # Every so manieth vertex stands for its neighbours.
        self._rows = counted[:: max(1, -(-len(counted) // _MOST_VERTICES))]
        self._root = np.sqrt(share[self._rows] / max(share[self._rows].sum(), 1e-300))[:, None]
        self._rest = rest[self._rows]

    @property
    def genome(self) -> Genome:
        """What may be tuned."""
        return self._candidates.genome

    def positions(self, values: Mapping[str, float]) -> FloatArray:
        """Return the vertices (n, 3) of the candidate with these values [mm]."""
        key = self.genome.values(values).tobytes()
        made = self._faces.get(key)
        if made is None:
            made = self._candidates.positions(values)
            self._faces[key] = made
            while len(self._faces) > _FACES:
                self._faces.popitem(last=False)
        return made

    def face(self, values: FloatArray) -> FloatArray:
        """Return what is seen (k,) of the candidate with values (p,), from the start [mm]."""
        key = values.tobytes()
        if key not in self._seen:
            self._seen[key] = self._reduced(self.positions(self.genome.named(values)))
        return self._seen[key]

    def slopes(self, values: FloatArray) -> FloatArray:
        """Return how what is seen changes (k, p) with values over their ranges, at values (p,).

        Notes
        -----
        Costs one face per parameter, made side by side, the first time.
        """
        key = values.tobytes()
        if key not in self._slopes:
            genome = self.genome
            reach = _REACH * (genome.high - genome.low)
            reach = np.where(values + reach <= genome.high, reach, -reach)
            gallery = Gallery(self._candidates)
            here = self.face(values)
            moved = gallery.faces(values + np.diag(reach))
            change = np.stack([self._reduced(each) - here for each in moved], axis=1)
            slopes = change * np.sign(reach) / _REACH
            if not np.isfinite(slopes).all():
                raise ParameterError("looks: a candidate has vertices that are not finite")
            self._slopes = {key: slopes}
        return self._slopes[key]

    def _reduced(self, positions: FloatArray) -> FloatArray:
        return (self._root * (positions[self._rows] - self._rest)).ravel()
