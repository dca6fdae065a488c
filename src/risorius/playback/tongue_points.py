"""Tip and body of the tongue by its shape, for the many heads without landmarks in the mouth."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import numpy.typing as npt

from risorius._check import FloatArray
from risorius.landmarks.landmark_set import LandmarkSet

__all__ = ["TONGUE_PARTS", "tongue_points"]

Rows = npt.NDArray[np.intp]

TONGUE_PARTS = ("tongue", "gums", "teeth_lower")
"""Parts that tell where the tongue lies."""

_TIP, _BODY = "6.1", "6.2"
# Shares of the width of the mouth.
_MIDDLE = 0.06  # how far from the midline a point of it may lie
_BEHIND_TEETH = 0.1  # how far the tip of a resting tongue lies behind the front of the teeth
_BELOW_EDGE = 0.15  # how far below the edge of the lower teeth it may lie
_BODY_NEAR, _BODY_FAR = 0.35, 0.8  # how far behind the tip the body is highest
_BODY_ABOVE = 0.4  # above the tip; the palate lies higher


def tongue_points(
    positions: FloatArray, parts: Mapping[str, Rows], landmarks: LandmarkSet
) -> dict[str, int]:
    """Return the vertices of 6.1 (tip) and 6.2 (middle of the body), as far as they are found.

    Parameters
    ----------
    positions : (n, 3) float64
        Neutral head, canonical frame [mm].
    parts : mapping of str to (p,) int
        Vertices of those of `TONGUE_PARTS` that the head has.
    landmarks : LandmarkSet
        The corners of the mouth, 8.3 and 8.4.
    """
    if landmarks.missing(("8.3", "8.4")):
        return {}
    corners = landmarks.positions(("8.3", "8.4"))
    width = float(np.linalg.norm(corners[0] - corners[1]))
    across = float(corners[:, 0].mean())
    rows = parts.get("tongue", parts.get("gums"))
    if rows is None or not len(rows):
        return {}
    rows = rows[np.abs(positions[rows, 0] - across) < _MIDDLE * width]
    tip = _tip(positions, rows, parts, width)
    if tip is None:
        return {}
    behind = (positions[tip, 2] - positions[rows, 2]) / width
    near = rows[(behind > _BODY_NEAR) & (behind < _BODY_FAR)]
    body = _surface(positions, near, positions[tip, 1], width)
    return {_TIP: tip} if body is None else {_TIP: tip, _BODY: body}


def _tip(positions: FloatArray, rows: Rows, parts: Mapping[str, Rows], width: float) -> int | None:
    """Return the foremost vertex; in one piece with the gums, that behind the teeth' edge."""
    if "tongue" not in parts:
        if "teeth_lower" not in parts:
            return None
        teeth = positions[parts["teeth_lower"]]
        edge, front = float(teeth[:, 1].max()), float(teeth[:, 2].max())
        height, place = positions[rows, 1], positions[rows, 2]
        rows = rows[
            (height < edge)
            & (height > edge - _BELOW_EDGE * width)
            & (place < front - _BEHIND_TEETH * width)
        ]
    return int(rows[positions[rows, 2].argmax()]) if len(rows) else None


def _surface(positions: FloatArray, rows: Rows, tip: float, width: float) -> int | None:
    """Return the highest vertex of the tongue's back, below the gap to the palate."""
    heights = positions[rows, 1]
    rows = rows[(heights > tip - 0.2 * width) & (heights < tip + _BODY_ABOVE * width)]
    return int(rows[positions[rows, 1].argmax()]) if len(rows) else None
