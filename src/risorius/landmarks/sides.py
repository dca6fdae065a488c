"""Check that landmarks carry the right side and that none is missing."""

from __future__ import annotations

import warnings
from collections.abc import Iterable

import numpy as np

from risorius._check import FloatArray
from risorius.errors import LandmarkError, RisoriusWarning
from risorius.landmarks.feature_points import feature_points
from risorius.landmarks.landmark_set import LandmarkSet

__all__ = ["require", "require_sides", "sagittal_axis"]

# A pair closer to the sagittal plane than this share of the eye distance has no clear side.
_CLEAR = 0.02


def require(landmarks: LandmarkSet, names: Iterable[str], *, purpose: str) -> None:
    """Raise `LandmarkError` naming and describing those of `names` that are missing."""
    missing = landmarks.missing(names)
    if missing:
        table = feature_points()
        listed = "; ".join(
            f"{name} ({table[name].description})" if name in table else name for name in missing
        )
        raise LandmarkError(f"landmarks: {purpose} needs {listed}; add them to the landmark file")


def _pairs(landmarks: LandmarkSet) -> list[tuple[str, str]]:
    return [
        (point.name, point.mirror)
        for point in feature_points().values()
        if point.side == "left" and point.name in landmarks and point.mirror in landmarks
    ]


def sagittal_axis(landmarks: LandmarkSet) -> FloatArray:
    """Return the unit vector (3,) from the character's right to the left, by the eye corners."""
    names = ("3.7", "3.11", "3.8", "3.12")
    require(landmarks, names, purpose="the frame of the head")
    left = landmarks.positions(names[:2]).mean(axis=0)
    right = landmarks.positions(names[2:]).mean(axis=0)
    axis = left - right
    length = float(np.linalg.norm(axis))
    if length == 0.0:
        raise LandmarkError("landmarks: left and right eye corners (3.7 3.11 3.8 3.12) coincide")
    return axis / length


def require_sides(landmarks: LandmarkSet) -> LandmarkSet:
    """Return the set with stray swapped pairs exchanged; refuse a set that is swapped as a whole.

    Sides are judged against the facing of the head itself: left is to the left of somebody
    who looks where the nose points.

    Raises
    ------
    LandmarkError
        If more than half of the clear pairs are on the wrong side, or inner and outer corners of
        an eye are exchanged.
    """
    pairs = _pairs(landmarks)
    facing = _facing(landmarks)
    if facing is None or not pairs:
        return landmarks
    up, forward = facing
    left = np.cross(up, forward)
    left /= np.linalg.norm(left)
    _require_outer_corners(landmarks, left)
    eyes = abs(float((landmarks.position("3.7") - landmarks.position("3.12")) @ left))
    gaps = {
        pair: float((landmarks.position(pair[0]) - landmarks.position(pair[1])) @ left)
        for pair in pairs
    }
    clear = {pair: gap for pair, gap in gaps.items() if abs(gap) > _CLEAR * eyes}
    wrong = [pair for pair, gap in clear.items() if gap < 0.0]
    if 2 * len(wrong) > len(clear):
        shown = ", ".join(f"{a!r} and {b!r}" for a, b in wrong[:3])
        raise LandmarkError(
            f"landmarks: left and right are swapped ({len(wrong)} of {len(clear)} pairs, e.g. "
            f"{shown}; left is the character's left); run with --flip-landmarks or correct the file"
        )
    if not wrong:
        return landmarks
    names = "; ".join(f"{a} and {b}" for a, b in wrong)
    warnings.warn(
        f"landmarks: exchanged pairs that lie on each other's side: {names}",
        RisoriusWarning,
        stacklevel=2,
    )
    exchange = dict(wrong) | {b: a for a, b in wrong}
    return landmarks.renamed(exchange)


def _require_outer_corners(landmarks: LandmarkSet, left: FloatArray) -> None:
    """Refuse inner corners of the eyes that lie outside the outer ones, along `left` (3,)."""
    names = ("3.7", "3.12", "3.11", "3.8")
    if landmarks.missing(names):
        return
    across = landmarks.positions(names) @ left
    outer, inner = abs(across[0] - across[1]), abs(across[2] - across[3])
    if inner > outer:
        raise LandmarkError(
            "landmarks: the inner corners of the eyes ('3.11' and '3.8') lie farther apart than "
            "the outer ones ('3.7' and '3.12'); exchange them in the landmark file"
        )


def _facing(landmarks: LandmarkSet) -> tuple[FloatArray, FloatArray] | None:
    """Return rough up and forward vectors (not unit), or None if the points do not tell."""
    ups = [("2.1", ("3.7", "3.12")), ("8.2", ("3.7", "3.12"))]
    up: FloatArray | None = None
    for low, high in ups:
        if low in landmarks and not landmarks.missing(high):
            up = landmarks.positions(high).mean(axis=0) - landmarks.position(low)
            break
    if up is None or "9.3" not in landmarks or landmarks.missing(("3.7", "3.12")):
        return None
    # The nose tip stands before the plane of outer eye corners and chin.
    corners = landmarks.positions(("3.7", "3.12"))
    across = corners[0] - corners[1]
    normal = np.cross(across, up)
    norm = float(np.linalg.norm(normal))
    if norm == 0.0:
        return None
    normal /= norm
    height = float((landmarks.position("9.3") - corners.mean(axis=0)) @ normal)
    return up, normal * np.sign(height) if height else normal
