"""Rows around the eye: lid margin, lid, crease, and two rows turned in to the eyeball."""

from __future__ import annotations

import numpy as np

from .loops import Loops
from .projecting import gradient, lift
from .table import EYE_CENTRE, EYE_RADIUS, LID_INNER, LID_LOWER, LID_OUTER, LID_UPPER

__all__ = ["CREASE_ROW", "EYE_COLUMNS", "eye_loops"]

EYE_COLUMNS = 30
_OFFSETS = (1.2, 2.9, 5.2, 8.0, 11.2)
CREASE_ROW = 3
_CARUNCLE = 3.0


def _margin_arc(t, height, lean, roundness):
    """Return an arc (n, 2) from the inner to the outer corner of the eye."""
    chord = np.subtract(LID_OUTER, LID_INNER)
    arc = np.asarray(LID_INNER) + t[:, None] * chord
    arc[:, 1] += height * np.sin(np.pi * t**lean) ** roundness
    return arc


def _margin():
    """Return the lid margin (c, 2), inner corner, upper lid, outer corner, lower lid."""
    t = np.linspace(0.0, 1.0, 400)
    upper = _margin_arc(t, LID_UPPER + 0.7, 0.86, 0.75)
    lower = _margin_arc(t, LID_LOWER + 0.7, 1.15, 0.85)
    ring = np.vstack([upper, lower[-2::-1]])
    at = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(ring, axis=0), axis=1))])
    even = np.arange(EYE_COLUMNS) / EYE_COLUMNS * at[-1]
    return np.column_stack([np.interp(even, at, ring[:, k]) for k in (0, 1)])


def _unit(vectors):
    return vectors / np.linalg.norm(vectors, axis=1)[:, None]


def _outward(margin):
    """Return unit normals (c, 2) of the margin in the front view, smoothed at the corners."""
    along = np.roll(margin, -1, axis=0) - np.roll(margin, 1, axis=0)
    normal = _unit(np.column_stack([-along[:, 1], along[:, 0]]))
    for _ in range(2):
        normal = _unit(np.roll(normal, 1, axis=0) + 2 * normal + np.roll(normal, -1, axis=0))
    return normal


def _tucked(margin, outward):
    """Return the rows from the lid margin (c, 3) to the eyeball and behind the lid."""
    offset = margin - EYE_CENTRE
    distance = np.linalg.norm(offset, axis=1)
    touching = np.maximum(EYE_RADIUS + 0.25, distance - 1.5)
    edge = EYE_CENTRE + offset / distance[:, None] * touching[:, None]
    # at the inner corner the skin runs on to the eyeball as the caruncle
    column = np.arange(len(margin))
    from_corner = np.minimum(column, len(margin) - column)
    shift = _CARUNCLE * np.exp(-((from_corner / 1.6) ** 2))
    lid = edge + shift[:, None] * np.array([1.0, 0.0, 0.3])
    edge = EYE_CENTRE + _unit(lid - EYE_CENTRE) * touching[:, None]
    behind = edge - EYE_CENTRE
    behind[:, :2] += 1.8 * outward
    behind[:, 2] -= 1.2
    return [edge, EYE_CENTRE + _unit(behind) * (EYE_RADIUS + 0.2)]


def eye_loops():
    """Return the rows around the left eye."""
    margin = _margin()
    outward = _outward(margin)
    along = (margin[:, 0] - LID_INNER[0]) / (LID_OUTER[0] - LID_INNER[0])
    scale = 0.6 + 0.4 * np.clip(along / 0.35, 0.0, 1.0)
    outer = [lift(margin)]
    outer += [lift(margin + outward * (offset * scale)[:, None]) for offset in _OFFSETS]
    # the crease of the upper lid runs along one row, the lid bulges below it
    upward = np.clip(outward[:, 1], 0.0, 1.0) * np.sin(np.pi * np.clip(along, 0.0, 1.0)) ** 0.5
    for row, depth in ((CREASE_ROW, 1.0), (2, -0.2)):
        outer[row] = outer[row] - gradient(outer[row]) * (depth * upward)[:, None]
    return Loops(outer, _tucked(outer[0], outward), closed=True)
