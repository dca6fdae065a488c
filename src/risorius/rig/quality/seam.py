"""Vertices of the lip seam that move with the wrong lip, and how far the mouth opens."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from risorius._check import BoolArray, FloatArray, IntArray
from risorius.head.head import Head
from risorius.mesh.lips import LipSides
from risorius.mesh.slit import line_lengths

__all__ = ["Seam", "SeamTest"]

# The ends of the lines (share of their length) that belong to both lips and are not judged; the
# jaw rule leaves more of them out, there the lips still meet.
_END, _JAW_END = 0.06, 0.12
_MIDDLE = (0.35, 0.65)
_DEGREE = 3
_ROUNDS = 15
# The lips must part by this share of the largest motion for a vertex to be on the wrong side.
_PART = 0.3
# A dip of the gap below this share of the gap on both sides of it.
_DIP = 0.3
_NEAREST = 5
_LEAST_MOTION = 0.05
_LEAST_CHIN = 1.0
_WITH_CHIN = 0.8
_LOST, _INVENTED, _SHUT = 0.25, 0.75, 0.1


@dataclass(frozen=True)
class Seam:
    """The lip seam in one shape.

    Parameters
    ----------
    lost : tuple of int
        Vertices of the file that stay with the other lip while their own moves.
    invented : tuple of int
        Vertices of the file that move with the other lip while their own rests.
    gap : float
        Largest growth of the gap between opposite points of the two lips [mm].
    chin : float
        Travel of the chin (landmark 2.1) [mm].
    """

    lost: tuple[int, ...]
    invented: tuple[int, ...]
    gap: float
    chin: float

    @property
    def opening(self) -> float | None:
        """Gap over the chin's travel; None where the chin travels less than a millimetre."""
        return self.gap / self.chin if self.chin >= _LEAST_CHIN else None


class SeamTest:
    """The contact lines of the lips, ready to be judged in many shapes at once.

    Each line's motion is described by a cubic along the line that minimises the sum of distances
    (not of squares), so that wrong vertices, and runs of them up to a fifth of the line, do not
    bend it. A vertex is wrong if its motion is nearer to the other lip's cubic than to its own,
    the two differ by more than 30 % of the largest seam motion, and its own lip parts from the
    other again on both sides of it (a vertex at the foot of a short muscle's hump, with nothing
    but rest beyond, is sound). It is *invented* if its own lip moves less than the other there,
    else *lost*. The corners, 6 % of the lines at each end, belong to both lips and do not count.

    Where the jaw opens the mouth a second rule finds what the first cannot, a large part of a lip
    that stays: opposite vertices that part by less than 10 % of what the middles do are wrong;
    the lower one is lost if it follows less than 25 % of the way from the upper to the lower
    middle, the upper one invented if it follows more than 75 %. The jaw opens the mouth if the
    middles part by more than 30 % and the chin makes at least 80 % of the lower middle's motion:
    a lower lip that a muscle pulls down on one side leaves the chin behind.

    Parameters
    ----------
    head : Head
    lips : LipSides
        On the head's skin.
    """

    def __init__(self, head: Head, lips: LipSides) -> None:
        positions = head.skin.mesh.positions
        self._lines = (lips.slit.upper, lips.slit.lower)
        self._places = tuple(line_lengths(positions, line) for line in self._lines)
        self._judged = tuple(
            (place > _END) & (place < 1.0 - _END) & ~lips.corner[line]
            for line, place in zip(self._lines, self._places)
        )
        self._pairs = lips.pairs(positions)
        self._source = head.skin.first_source()
        self._chin = head.skin_vertex("2.1") if "2.1" in head.landmarks else -1
        self._rest_gap = _lengths(positions[self._pairs[:, 1]] - positions[self._pairs[:, 0]])
        self._rest = positions

    def seams(self, deltas: FloatArray) -> list[Seam]:
        """Judge all shapes.

        Parameters
        ----------
        deltas : (s, w, 3) float64
            Displacements of the welded skin [mm].
        """
        upper, lower = (deltas[:, line] for line in self._lines)
        inner = [moved[:, judged] for moved, judged in zip((upper, lower), self._judged)]
        largest = np.maximum(*(_lengths(moved).max(axis=1, initial=0.0) for moved in inner))
        wrong_upper, wrong_lower = self._by_side(upper, lower, largest)
        chin = _lengths(deltas[:, self._chin]) if self._chin >= 0 else np.zeros(len(deltas))
        self._by_jaw((upper, lower), largest, chin, (wrong_upper, wrong_lower))
        gap = self._rest[self._pairs[:, 1]] - self._rest[self._pairs[:, 0]]
        posed = gap + deltas[:, self._pairs[:, 1]] - deltas[:, self._pairs[:, 0]]
        growth = (_lengths(posed) - self._rest_gap).max(axis=1, initial=0.0)
        return [
            Seam(
                self._vertices(wrong_upper[s] == 1, wrong_lower[s] == 1),
                self._vertices(wrong_upper[s] == 2, wrong_lower[s] == 2),
                float(growth[s]),
                float(chin[s]),
            )
            for s in range(len(deltas))
        ]

    def _vertices(self, upper: BoolArray, lower: BoolArray) -> tuple[int, ...]:
        found = np.concatenate([self._lines[0][upper], self._lines[1][lower]])
        return tuple(sorted(self._source[found].tolist()))

    def _by_side(
        self, upper: FloatArray, lower: FloatArray, largest: FloatArray
    ) -> tuple[IntArray, IntArray]:
        """Return (s, k) per line: 0 right, 1 lost, 2 invented, by the two cubics."""
        fewest = min(int(judged.sum()) for judged in self._judged)
        if fewest < 2:
            return np.zeros(upper.shape[:2], np.int32), np.zeros(lower.shape[:2], np.int32)
        bases = [_basis(place, fewest) for place in self._places]
        fits = [
            _least_distances(basis[judged], moved[:, judged], largest)
            for basis, moved, judged in zip(bases, (upper, lower), self._judged)
        ]
        wrong: list[IntArray] = []
        for side, moved in enumerate((upper, lower)):
            own, other = (bases[side] @ fits[side], bases[side] @ fits[1 - side])
            apart = _lengths(own - other) > _PART * largest[:, None]
            nearer = _lengths(moved - other) < _lengths(moved - own)
            bad = apart & nearer & self._judged[side] & (largest > _LEAST_MOTION)[:, None]
            bad &= self._between_parted(side, moved, (upper, lower)[1 - side], largest)
            rests = _lengths(own) < _lengths(other)
            wrong.append(np.where(bad, np.where(rests, 2, 1), 0).astype(np.int32))
        return wrong[0], wrong[1]

    def _between_parted(
        self, side: int, moved: FloatArray, other: FloatArray, largest: FloatArray
    ) -> BoolArray:
        """Return (s, k): vertices that go with the other lip between parts of a line that do not.

        The other lip's motion at a place is the median of its five nearest vertices.
        """
        gaps = np.abs(self._places[side][:, None] - self._places[1 - side][None])
        nearest = np.argsort(gaps, axis=1, kind="stable")[:, :_NEAREST]
        parted = _lengths(moved - np.median(other[:, nearest], axis=2)) * self._judged[side]
        before = np.maximum.accumulate(parted, axis=1)
        after = np.maximum.accumulate(parted[:, ::-1], axis=1)[:, ::-1]
        around = np.minimum(before, after)
        return (parted < _DIP * around) & (around > _PART * largest[:, None])

    def _by_jaw(
        self,
        moved: tuple[FloatArray, FloatArray],
        largest: FloatArray,
        chin: FloatArray,
        wrong: tuple[IntArray, IntArray],
    ) -> None:
        """Add what the jaw rule finds to `wrong`."""
        middles = [
            np.median(motion[:, (place >= _MIDDLE[0]) & (place <= _MIDDLE[1])], axis=1)
            for motion, place in zip(moved, self._places)
        ]
        apart = middles[1] - middles[0]
        length = _lengths(apart)
        opens = (
            (length > _PART * largest)
            & (largest > _LEAST_MOTION)
            & (chin > _WITH_CHIN * _lengths(middles[1]))
            & (_lengths(middles[1]) > _lengths(middles[0]))
        )
        direction = apart / np.maximum(length, 1e-9)[:, None] ** 2
        follow = [
            np.einsum("skc,sc->sk", motion - middles[0][:, None], direction) for motion in moved
        ]
        for side, place in enumerate(self._places):
            other = 1 - side
            nearest = np.abs(place[:, None] - self._places[other][None]).argmin(axis=1)
            parted = np.abs(follow[side] - follow[other][:, nearest])
            inner = (place > _JAW_END) & (place < 1.0 - _JAW_END)
            shut = opens[:, None] & inner & self._judged[side] & (parted < _SHUT)
            if side == 0:
                wrong[0][shut & (follow[0] > _INVENTED)] = 2
            else:
                wrong[1][shut & (follow[1] < _LOST)] = 1


def _lengths(vectors: FloatArray) -> FloatArray:
    return np.sqrt((vectors * vectors).sum(axis=-1))


def _basis(place: FloatArray, count: int) -> FloatArray:
    degree = max(min(_DEGREE, count // 3 - 1), 1)
    return np.asarray(np.polynomial.legendre.legvander(2.0 * place - 1.0, degree), np.float64)


def _least_distances(basis: FloatArray, moved: FloatArray, largest: FloatArray) -> FloatArray:
    """Return coefficients (s, d, 3) that minimise the sum of distances, by reweighting."""
    weights = np.ones(moved.shape[:2])
    floor = np.maximum(0.01 * largest, 1e-9)[:, None]
    ridge = 1e-9 * np.eye(basis.shape[1])
    solution = np.zeros((len(moved), basis.shape[1], 3))
    for _ in range(_ROUNDS):
        scaled = weights / weights.sum(axis=1, keepdims=True)
        normal = np.einsum("ki,sk,kj->sij", basis, scaled, basis) + ridge
        right = np.einsum("ki,sk,skc->sic", basis, scaled, moved)
        solution = np.linalg.solve(normal, right)
        weights = 1.0 / np.maximum(_lengths(moved - basis @ solution), floor)
    return solution
