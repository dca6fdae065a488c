"""Corresponding landmarks of two heads, and the similarity between the heads."""

from __future__ import annotations

import warnings
from dataclasses import dataclass

import numpy as np

from risorius._check import FloatArray
from risorius.cloning.subject import Subject
from risorius.errors import LandmarkError, RisoriusWarning
from risorius.warp.similarity import Similarity, fit_similarity

__all__ = ["REQUIRED", "LandmarkPairs", "pair_landmarks"]

REQUIRED = (
    "2.2", "2.3", "2.4", "2.5", "3.1", "3.2", "3.3", "3.4", "3.7", "3.8", "3.11", "3.12",
)  # fmt: skip
"""Landmarks that cloning cannot do without: inner lips and eyes (spec 2.1)."""

_FEWEST, _FEW = 8, 20
# Landmarks that miss the best similarity by more than this share of their spread belong to
# another face, or their names are mixed up.
_BAD = 0.35


@dataclass(frozen=True, eq=False)
class LandmarkPairs:
    """Landmarks that both heads have.

    Parameters
    ----------
    names : tuple of str
    source, target : (k, 3) float64
        Places in the heads' canonical frames [mm].
    similarity : Similarity
        From the source's frame to the target's.
    miss : float
        Root mean square distance that the similarity leaves [mm].
    """

    names: tuple[str, ...]
    source: FloatArray
    target: FloatArray
    similarity: Similarity
    miss: float

    def reversed(self) -> LandmarkPairs:
        """Return the pairs seen from the target."""
        back = self.similarity.inverse()
        return LandmarkPairs(self.names, self.target, self.source, back, self.miss * back.scale)


def pair_landmarks(source: Subject, target: Subject) -> LandmarkPairs:
    """Match the landmarks of two heads by name.

    Raises
    ------
    LandmarkError
        If required ones are missing, fewer than 8 are common, or they do not fit each other.

    Warns
    -----
    RisoriusWarning
        If fewer than 20 are common, or required ones are filled in from the others.
    """
    theirs = set(target.skin_landmarks())
    names = [name for name in source.skin_landmarks() if name in theirs]
    if len(names) < _FEWEST:
        only = sorted(set(source.skin_landmarks()) ^ theirs)
        raise LandmarkError(
            f"landmarks: the two heads share {len(names)} names on the skin, cloning needs at "
            f"least {_FEWEST}; {len(only)} stand in one file only: {', '.join(only[:12])}"
        )
    absent = [name for name in REQUIRED if name not in names]
    if absent:
        warnings.warn(
            f"landmarks: {', '.join(absent)} are not in both files; their places follow from the "
            "others, add them for exact lips and lids",
            RisoriusWarning,
            stacklevel=2,
        )
    if len(names) < _FEW:
        warnings.warn(
            f"landmarks: only {len(names)} are common to both heads; {_FEW} or more fit better",
            RisoriusWarning,
            stacklevel=2,
        )
    p = source.head.landmarks.positions(names)
    q = target.head.landmarks.positions(names)
    similarity, miss = _shrunk(p, q)
    spread = float(np.sqrt(((q - q.mean(axis=0)) ** 2).sum(axis=1).mean()))
    if miss > _BAD * spread or not similarity.scale > 0.0:
        off = np.linalg.norm(similarity.apply(p) - q, axis=1)
        worst = [names[i] for i in np.argsort(-off)[:4].tolist()]
        raise LandmarkError(
            f"landmarks: the heads' landmarks do not fit each other ({miss:.3g} mm left of a face "
            f"of {spread:.3g} mm; worst {', '.join(worst)}); check that both files use the same "
            "names, or run with --flip-landmarks"
        )
    return LandmarkPairs(tuple(names), p, q, similarity, miss)


def _shrunk(p: FloatArray, q: FloatArray) -> tuple[Similarity, float]:
    """Return the similarity, with turn and scale no larger than the points can prove.

    Two faces in the canonical frame differ in shape; that alone makes the best similarity turn
    and scale a little. With r the miss and L the spread, an angle a or a log scale s is kept to
    the share a^2 / (a^2 + (r / L)^2): all of it where the points fit exactly.
    """
    best = fit_similarity(p, q)
    miss = float(np.sqrt(((best.apply(p) - q) ** 2).sum(axis=1).mean()))
    spread = float(np.sqrt(((q - q.mean(axis=0)) ** 2).sum(axis=1).mean()))
    doubt = (miss / max(spread, 1e-12)) ** 2
    vector = _rotation_vector(best.rotation)
    angle2 = float(vector @ vector)
    log_scale = float(np.log(max(best.scale, 1e-12)))
    vector = vector * _share(angle2, doubt)
    scale = float(np.exp(log_scale * _share(log_scale**2, doubt)))
    rotation = _rotation_matrix(vector)
    shift = q.mean(axis=0) - scale * rotation @ p.mean(axis=0)
    return Similarity(scale, rotation, shift), miss


def _share(square: float, doubt: float) -> float:
    return square / (square + doubt) if square > 0.0 and doubt > 1e-16 else 1.0


def _rotation_vector(rotation: FloatArray) -> FloatArray:
    from scipy.spatial.transform import Rotation

    return np.asarray(Rotation.from_matrix(rotation).as_rotvec(), np.float64)


def _rotation_matrix(vector: FloatArray) -> FloatArray:
    from scipy.spatial.transform import Rotation

    return np.asarray(Rotation.from_rotvec(vector).as_matrix(), np.float64)
