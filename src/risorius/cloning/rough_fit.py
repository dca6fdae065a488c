"""The rough fit: a smooth warp by landmarks and contact lines, as stiff as the landmarks need."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree
from scipy.spatial.distance import cdist

from risorius._check import FloatArray, IntArray
from risorius.cloning.landmark_pairs import LandmarkPairs
from risorius.cloning.polyline import at_shares, nearest_on_line
from risorius.cloning.subject import Subject
from risorius.warp.rbf import RbfWarp

__all__ = ["RoughFit", "rough_fit"]

# Smoothing of the landmarks that is tried; the largest that predicts a left-out landmark within
# a few per cent of the best is taken.
_SMOOTHING = (0.005, 0.02, 0.05, 0.1, 0.2, 0.4, 0.8, 1.6, 3.0)
_LIKE_BEST = 1.05
_LINE_SMOOTHING = 0.02
_SAMPLES = np.linspace(0.0, 1.0, 13)
# Lid lines farther than this from where the other landmarks expect them, in eye widths, hang on
# landmarks that are off; they do not count.
_LID_MISS = 0.033
# Centres nearer together than this are one [mm].
_NEAREST = 0.5


@dataclass(frozen=True, eq=False)
class RoughFit:
    """The warp by landmarks and lines.

    Parameters
    ----------
    positions : (n, 3) float64
        The source's skin, moved by the similarity [mm].
    warp : RbfWarp
        From there to the target.
    lines : tuple of str
        Contact lines that correspond.
    smoothing : float
        What the landmarks needed: how little they agree with each other.
    """

    positions: FloatArray
    warp: RbfWarp
    lines: tuple[str, ...]
    smoothing: float


def rough_fit(source: Subject, target: Subject, pairs: LandmarkPairs) -> RoughFit:
    """Warp the source's skin towards the target's.

    Notes
    -----
    Lines are matched by their shares of arc length; a lid line counts only if the warp without
    it comes near it, so that misplaced eye landmarks do not spoil the rest.
    """
    positions = pairs.similarity.apply(source.mesh.positions)
    p, q = pairs.similarity.apply(pairs.source), pairs.target
    smoothing = _best_smoothing(p, q)
    ours, theirs = source.lines(), target.lines()
    common = [name for name in ours if name in theirs]
    lines = [name for name in common if name.startswith("lip")]

    def fit() -> RbfWarp:
        from_parts, to_parts, weights = [p], [q], [np.full(len(p), smoothing)]
        for name in lines:
            # The corners belong to both lines; they are given once.
            samples = _SAMPLES if "upper" in name else _SAMPLES[1:-1]
            from_parts.append(at_shares(positions[ours[name]], samples))
            to_parts.append(at_shares(target.mesh.positions[theirs[name]], samples))
            weights.append(np.full(len(samples), _LINE_SMOOTHING))
        a, b, w = (np.concatenate(part) for part in (from_parts, to_parts, weights))
        kept = _thinned(a)
        return RbfWarp.fit(a[kept], b[kept], regularisation=w[kept])

    warp = fit()
    for side, margins in target.lids.items():
        names = [name for name in common if name.startswith("lid") and name.endswith(f"_{side}")]
        if not names:
            continue
        miss = [_line_miss(warp(positions[ours[n]]), target, theirs[n]) for n in names]
        if np.mean(miss) < _LID_MISS * margins.width:
            lines.extend(names)
    return RoughFit(positions, fit(), tuple(lines), smoothing)


def _line_miss(points: FloatArray, target: Subject, line: IntArray) -> float:
    there = nearest_on_line(points, target.mesh.positions[line])
    return float(np.linalg.norm(there - points, axis=1).mean())


def _thinned(points: FloatArray) -> IntArray:
    """Return rows of `points` with no two closer than half a millimetre; later ones win."""
    kept: list[int] = []
    for row in range(len(points) - 1, -1, -1):
        if not kept or np.linalg.norm(points[kept] - points[row], axis=1).min() > _NEAREST:
            kept.append(row)
    return np.asarray(kept[::-1], np.int32)


def _best_smoothing(p: FloatArray, q: FloatArray) -> float:
    """Return the smoothing under which landmarks predict one another best (leave one out).

    With A the system's matrix, the miss at a left-out centre is h_i / (A^-1)_ii: one inverse
    answers for all centres.
    """
    kept = _thinned(p)
    p, q = p[kept], q[kept]
    n = len(p)
    middle = p.mean(axis=0)
    x = (p - middle) / np.sqrt(((p - middle) ** 2).sum(axis=1).mean())
    radius = cKDTree(x).query(x, k=2)[0][:, 1]
    system = np.zeros((n + 4, n + 4))
    system[:n, n : n + 3], system[:n, n + 3] = x, 1.0
    system[n:, :n] = system[:n, n:].T
    misses: list[float] = []
    for smoothing in _SMOOTHING:
        system[:n, :n] = -np.sqrt(cdist(x, x, "sqeuclidean") + radius**2)
        system[:n, :n] += smoothing * np.eye(n)
        inverse = np.linalg.pinv(system)
        left_out = (inverse[:n, :n] @ q) / np.diag(inverse)[:n, None]
        misses.append(float(np.sqrt((left_out**2).sum(axis=1).mean())))
    limit = _LIKE_BEST * min(misses) + 1e-9
    return max(s for s, miss in zip(_SMOOTHING, misses) if miss <= limit)
